//! Passes the linker the memory of the chip.

use std::path::Path;
use std::{env, fs};

fn main() {
    let out = env::var("OUT_DIR").expect("cargo says where");
    fs::copy("memory.x", Path::new(&out).join("memory.x")).expect("the chip's memory");
    println!("cargo:rerun-if-changed=memory.x");
    println!("cargo:rustc-link-search={out}");
    println!("cargo:rustc-link-arg-bins=-Tlink.x");
}
