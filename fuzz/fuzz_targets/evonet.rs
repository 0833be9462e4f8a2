//! The original's networks: `.net` and `.phe`.
#![no_main]

use farsa_fuzz::bounded;
use farsa_nn::block::{Evonet, EvonetRanges};
use libfuzzer_sys::fuzz_target;

farsa_fuzz::text!();

fuzz_target!(|input: &[u8]| {
    let Ok(text) = std::str::from_utf8(input) else { return };
    bounded(input.len(), || {
        let Ok(network) = text.parse::<Evonet>() else { return };
        let layout = network.layout.layout();
        if let Ok(parameters) = network.parameters(EvonetRanges::default()) {
            assert_eq!(parameters.len(), layout.parameter_count());
        }
    });
});
