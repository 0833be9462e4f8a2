//! Gives the linker the memory of the board, which the target decides.

use std::path::Path;
use std::{env, fs};

fn main() {
    let target = env::var("TARGET").expect("cargo says the target");
    let board = if target.starts_with("thumbv6m") { "microbit" } else { "mps2-an386" };
    let out = env::var("OUT_DIR").expect("cargo says where");
    let memory = format!("memory/{board}.x");
    fs::copy(&memory, Path::new(&out).join("memory.x")).expect("the board's memory");
    println!("cargo:rerun-if-changed={memory}");
    println!("cargo:rustc-link-search={out}");
    println!("cargo:rustc-link-arg-bins=-Tlink.x");
    println!("cargo:rustc-link-arg-bins=--nmagic");
}
