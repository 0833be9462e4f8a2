//! Individuals of runs: `champion.bin` and `genotypes.bin`. The first byte selects the strategy, the second the kind of file; the
//! rest is the content, whose head and checksum are made here.
#![no_main]

use std::sync::LazyLock;

use farsa_fuzz::{Scratch, bounded, sealed_file, selected, with_run};
use libfuzzer_sys::fuzz_target;

static SCRATCH: LazyLock<Scratch> = LazyLock::new(Scratch::new);
const KINDS: [&[u8; 8]; 6] = [b"farsachm", b"farsacmc", b"farsacmr", b"farsacmn", b"farsagen", b"farsagec"];

fuzz_target!(|input: &[u8]| {
    let Some(([which, kind], content)) = selected(input) else { return };
    let kind = KINDS[usize::from(kind) % KINDS.len()];
    let bytes = sealed_file(kind, content);
    let imported = kind.starts_with(b"farsage");
    let name = if imported { "genotypes.bin" } else { "champion.bin" };
    let read = || {
        with_run(which, |reader| {
            let read = if imported { reader.genotypes(SCRATCH.path()) } else { reader.champions(SCRATCH.path()) };
            read.is_ok()
        })
    };
    SCRATCH.put(name, &bytes);
    if bounded(bytes.len(), read) {
        let written = SCRATCH.get(name);
        assert!(read(), "what was written is read");
        assert!(SCRATCH.get(name) == written, "what was written is read as something else");
    }
});
