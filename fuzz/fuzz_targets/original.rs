//! Configurations of the original FARSA (INI).
#![no_main]

use farsa_compose::ComposedExperiment;
use farsa_fuzz::{bounded, limits};
use farsa_original::from_original_within;
use libfuzzer_sys::fuzz_target;

farsa_fuzz::text!();

// The schema is made once, and is no part of what an input takes.
fuzz_target!(init: drop(ComposedExperiment::from_text("warm.toml", "", farsa_lab::strategy::strategies())), |input: &[u8]| {
    let Ok(text) = std::str::from_utf8(input) else { return };
    let found = bounded(input.len(), || from_original_within(limits(), "original.ini", "original.toml", text));
    if let Ok(imported) = found {
        let remarks = imported.left.iter().chain(&imported.idle).map(ToString::to_string);
        assert!(remarks.into_iter().all(|remark| !remark.contains('\n')));
    }
});
