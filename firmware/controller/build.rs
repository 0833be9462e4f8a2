//! Quantizes the champion: converts its bytes to those of the same network in integers.

use std::path::Path;
use std::{env, fs};

use farsa_nn::bytes::{LeakyNetworkBytes, QuantizedNetworkBytes};
use farsa_nn::quantized::QuantizedScale;

/// Fraction bits of sensor values: 9 cover [-64, 64).
const INPUT_BITS: u32 = 9;

fn main() {
    println!("cargo:rerun-if-changed=champion.farsa");
    println!("cargo:rerun-if-changed=build.rs");
    let flash = fs::read("champion.farsa").expect("the champion");
    let champion = LeakyNetworkBytes::read(&flash).expect("a network");
    let layout = champion.layout();
    let mut parameters = vec![0.0; layout.parameter_count()];
    champion.copy_parameters(&mut parameters).expect("the length");

    let mut fixed = vec![0; parameters.len()];
    let scale = QuantizedScale::quantize(&layout, INPUT_BITS, &parameters, &mut fixed).expect("weights that fit");
    let mut bytes = vec![0; QuantizedNetworkBytes::byte_count(layout)];
    QuantizedNetworkBytes::write(layout, champion.leak(), scale, champion.channels(), &fixed, &mut bytes)
        .expect("valid");
    let out = env::var("OUT_DIR").expect("cargo says where");
    fs::write(Path::new(&out).join("champion-fixed.farsa"), bytes).expect("written");
}
