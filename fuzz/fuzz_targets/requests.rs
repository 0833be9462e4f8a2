//! Lines of an optimiser, which `farsa evaluate --stdin` answers. The first byte selects whether there are several populations.
#![no_main]

use farsa_fuzz::{bounded, selected};
use farsa_lab::fuzzing::RequestReader;
use libfuzzer_sys::fuzz_target;

/// The most bytes of an answer that refuses a line.
const LONGEST_REFUSAL: usize = 4096;

thread_local! {
    static READER: RequestReader = RequestReader::default();
}

farsa_fuzz::text!();

fuzz_target!(|input: &[u8]| {
    let Some(([which], line)) = selected(input) else { return };
    READER.with(|reader| {
        let read = |line: &[u8]| reader.read(which % 2 == 1, line);
        match bounded(input.len(), || read(line)) {
            Ok(written) => assert_eq!(read(written.as_bytes()).expect("what was written is read"), written),
            Err(said) => assert!(said.len() <= LONGEST_REFUSAL && !said.contains('\n'), "{said}"),
        }
    });
});
