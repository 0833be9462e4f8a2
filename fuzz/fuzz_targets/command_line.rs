//! Command lines: each line of the input is a word.
#![no_main]

use std::cell::RefCell;
use std::ffi::OsString;

use farsa_fuzz::{bounded, laboratory};
use farsa_lab::fuzzing::CommandLineReader;
use libfuzzer_sys::fuzz_target;

farsa_fuzz::text!();

thread_local! {
    static READER: RefCell<CommandLineReader> = RefCell::new(CommandLineReader::new(&laboratory()));
}

fuzz_target!(|input: &[u8]| {
    let Ok(text) = std::str::from_utf8(input) else { return };
    let words: Vec<&str> = std::iter::once("farsa").chain(text.lines()).collect();
    // The system passes each word as a separate text.
    let given = input.len() + words.len() * size_of::<OsString>();
    READER.with_borrow_mut(|reader| {
        if let Err(said) = bounded(given, || reader.read(&words)) {
            assert!(!said.is_empty());
        }
    });
});
