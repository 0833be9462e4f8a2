//! Genotypes: the original's `.gen` files, and lists of genes, words and reals.
#![no_main]

use farsa_fuzz::bounded;
use farsa_lab::fuzzing::read_genotypes;
use libfuzzer_sys::fuzz_target;

farsa_fuzz::text!();

fuzz_target!(|input: &[u8]| {
    let Ok(text) = std::str::from_utf8(input) else { return };
    let Ok(written) = bounded(input.len(), || read_genotypes(text)) else { return };
    assert_eq!(read_genotypes(&written).expect("what was written is read"), written);
});
