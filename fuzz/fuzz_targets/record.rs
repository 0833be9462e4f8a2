//! Records of runs: `record.bin`, of any strategy. The first byte selects the strategy, the second the number of generations in
//! the checkpoint. With a third byte of 0 the head is that of the run. Otherwise the byte is the length of a head that gets a
//! valid checksum.
#![no_main]

use farsa_fuzz::{bounded, sealed_file, selected, with_run};
use libfuzzer_sys::fuzz_target;

fuzz_target!(|input: &[u8]| {
    let Some(([which, generations, head], rest)) = selected(input) else { return };
    with_run(which, |reader| {
        let content = if head == 0 {
            [&reader.record_head().expect("a head"), rest].concat()
        } else {
            let (head, entries) = rest.split_at(rest.len().min(usize::from(head)));
            [&sealed_file(b"farsatld", head), entries].concat()
        };
        let _ = bounded(content.len(), || reader.record(&content, u32::from(generations)));
    });
});
