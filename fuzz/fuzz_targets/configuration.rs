//! Configurations of runs, and files of sweeps (TOML).
#![no_main]

use farsa_compose::ComposedExperiment;
use farsa_fuzz::{bounded_toml, laboratory};
use farsa_lab::fuzzing::{read_configuration, read_sweep};
use libfuzzer_sys::fuzz_target;

farsa_fuzz::text!();

// The schema is made once, and is no part of what an input takes.
fuzz_target!(init: drop(ComposedExperiment::from_text("warm.toml", "", farsa_lab::strategy::strategies())), |input: &[u8]| {
    let Ok(text) = std::str::from_utf8(input) else { return };
    let _ = bounded_toml(text, || read_sweep(text));
    let laboratory = laboratory();
    if let Ok(written) = bounded_toml(text, || read_configuration(&laboratory, text)) {
        let again = read_configuration(&laboratory, &written).expect("what was written is read");
        assert_eq!(again, written);
    }
});
