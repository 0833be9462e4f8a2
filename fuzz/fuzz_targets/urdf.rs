//! Robots as URDF, and back.
#![no_main]

use farsa_fuzz::{bounded, same_model};
use farsa_models::{Imported, ReadOptions, urdf};
use libfuzzer_sys::fuzz_target;

fn read(text: &str) -> Option<Imported> {
    Imported::from_text(text, &ReadOptions::default()).ok()
}

farsa_fuzz::text!();

fuzz_target!(|input: &[u8]| {
    let Ok(text) = std::str::from_utf8(input) else { return };
    let Some(found) = bounded(input.len(), || read(text)) else { return };
    // Names that the format cannot have, and numbers that it cannot hold, are errors of writing.
    let Ok(written) = urdf::write(&found.robot) else { return };
    let again = read(&written).expect("what was written is read");
    let twice = urdf::write(&again.robot).expect("what was read is written");
    assert!(same_model(&written, &twice), "{written}\nis read as\n{twice}");
});
