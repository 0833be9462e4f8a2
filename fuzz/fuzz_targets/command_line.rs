//! Command lines: each line of the input is a word.
#![no_main]

use std::ffi::OsString;

use farsa_fuzz::{bounded, laboratory};
use farsa_lab::fuzzing::read_command_line;
use libfuzzer_sys::fuzz_target;

farsa_fuzz::text!();

fuzz_target!(|input: &[u8]| {
    let Ok(text) = std::str::from_utf8(input) else { return };
    let laboratory = laboratory();
    let words: Vec<&str> = std::iter::once("farsa").chain(text.lines()).collect();
    // What the system hands over: each word is a text of its own.
    let given = input.len() + words.len() * size_of::<OsString>();
    bounded(given, || {
        if let Err(said) = read_command_line(&laboratory, &words) {
            assert!(!said.is_empty());
        }
    });
});
