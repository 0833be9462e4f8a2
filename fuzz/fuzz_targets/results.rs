//! Results of tests in a run's directory: tables, records, states, and the manifest. The first byte selects one of them.
#![no_main]

use farsa_fuzz::{bounded, selected};
use farsa_lab::fuzzing::{read_cases, read_manifest, read_states, read_test_record, read_trials};
use libfuzzer_sys::fuzz_target;

fn read(which: u8, text: &str) -> Option<Vec<u8>> {
    let terms = ["near".to_owned()];
    match which % 5 {
        0 => read_trials(text, &terms).ok(),
        1 => read_cases(text, &terms).ok(),
        2 => read_states(text).ok(),
        3 => read_test_record(text).ok().map(String::into_bytes),
        _ => read_manifest(text).ok().map(String::into_bytes),
    }
}

farsa_fuzz::text!();

fuzz_target!(|input: &[u8]| {
    let Some(([which], content)) = selected(input) else { return };
    let Ok(text) = std::str::from_utf8(content) else { return };
    let Some(written) = bounded(input.len(), || read(which, text)) else { return };
    let text = String::from_utf8(written).expect("text");
    assert_eq!(read(which, &text).expect("what was written is read"), text.as_bytes());
});
