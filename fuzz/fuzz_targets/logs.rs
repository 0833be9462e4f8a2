//! Logs of a resumed run: `fitness.csv`, `lineage.csv` and `failures.csv`. The first byte selects one of them for the rest. The
//! others are missing.
#![no_main]

use std::fs;
use std::sync::LazyLock;

use farsa_fuzz::{Scratch, bounded, selected, with_run};
use libfuzzer_sys::fuzz_target;

static SCRATCH: LazyLock<Scratch> = LazyLock::new(Scratch::new);
const FILES: [&str; 3] = ["fitness.csv", "lineage.csv", "failures.csv"];

fuzz_target!(|input: &[u8]| {
    let Some(([which], content)) = selected(input) else { return };
    for name in FILES {
        let _ = fs::remove_file(SCRATCH.path().join(name));
    }
    let which = usize::from(which) % FILES.len();
    SCRATCH.put(FILES[which], content);
    let take_up = || with_run(0, |reader| reader.logs(SCRATCH.path()));
    let kept = bounded(input.len(), take_up).expect("no log keeps a run from going on");
    assert!(!kept || which == 0);
    // Logs are resumed twice with the same result.
    assert!(!take_up().expect("what was written is read"));
    if which == 2 && !content.is_empty() {
        assert!(SCRATCH.get(FILES[2]).starts_with(content) || content.starts_with(b"generation,"), "a failure is lost");
    }
});
