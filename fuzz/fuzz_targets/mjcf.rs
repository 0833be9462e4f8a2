//! Robots as MJCF, and back.
#![no_main]

use farsa_fuzz::{bounded, same_model};
use farsa_models::mjcf::{self, MjcfOptions};
use farsa_models::{Imported, Limits, ReadOptions};
use libfuzzer_sys::fuzz_target;

/// The largest number of contacts. Pairs of geoms under the default limit take hundreds of megabytes.
const CONTACTS: usize = 64;

fn read(text: &str) -> Option<Imported> {
    let limits = Limits { contacts: CONTACTS, ..Limits::default() };
    Imported::from_text(text, &ReadOptions { limits, ..ReadOptions::default() }).ok()
}

farsa_fuzz::text!();

fuzz_target!(|input: &[u8]| {
    let Ok(text) = std::str::from_utf8(input) else { return };
    let Some(found) = bounded(input.len(), || read(text)) else { return };
    // Names that the format cannot have, and numbers that it cannot hold, are errors of writing.
    let Ok(written) = mjcf::write(&found.robot, &MjcfOptions::default()) else { return };
    let again = read(&written).expect("what was written is read");
    let twice = mjcf::write(&again.robot, &MjcfOptions::default()).expect("what was read is written");
    assert!(same_model(&written, &twice), "{written}\nis read as\n{twice}");
});
