//! Configurations of runs, and files of sweeps (TOML); and whether the tokens that are limited in number are those of `toml`.
#![no_main]

use farsa_compose::ComposedExperiment;
use farsa_fuzz::{bounded_toml, laboratory};
use farsa_lab::fuzzing::{count_toml_tokens, read_configuration, read_sweep};
use libfuzzer_sys::fuzz_target;
use toml_parser::Source;

farsa_fuzz::text!();

// The schema is made once, and is no part of what an input takes.
fuzz_target!(init: drop(ComposedExperiment::from_text("warm.toml", "", farsa_lab::strategies())), |input: &[u8]| {
    let Ok(text) = std::str::from_utf8(input) else { return };
    // Beside these there is the end.
    assert_eq!(count_toml_tokens(text) + 1, Source::new(text).lex().count());
    let _ = bounded_toml(text, || read_sweep(text));
    let laboratory = laboratory();
    if let Ok(written) = bounded_toml(text, || read_configuration(&laboratory, text)) {
        let again = read_configuration(&laboratory, &written).expect("what was written is read");
        assert_eq!(again, written);
    }
});
