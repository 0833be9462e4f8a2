//! Checkpoints of runs: `checkpoint.bin`, of any strategy. The first byte selects the strategy. The rest is the content, which
//! gets a valid head and checksum.
#![no_main]

use farsa_fuzz::{bounded, sealed_file, selected, with_run};
use libfuzzer_sys::fuzz_target;

fuzz_target!(|input: &[u8]| {
    let Some(([which], content)) = selected(input) else { return };
    let bytes = sealed_file(b"farsackp", content);
    with_run(which, |reader| {
        // As it is, nothing but the beginning and the checksum are looked at.
        let _ = reader.checkpoint(content);
        if let Ok(written) = bounded(bytes.len(), || reader.checkpoint(&bytes)) {
            assert!(reader.checkpoint(&written).expect("what was written is read") == written);
        }
    });
});
