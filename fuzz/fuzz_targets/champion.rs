//! Individuals of runs: `champion.bin` and `genotypes.bin`. The first byte selects the strategy, the second the kind of file. The
//! rest is the content, which gets a valid head and checksum.
#![no_main]

use std::fs;

use farsa_fuzz::{bounded, sealed_file, selected, with_directory};
use libfuzzer_sys::fuzz_target;

const KINDS: [&[u8; 8]; 6] = [b"farsachm", b"farsacmc", b"farsacmr", b"farsacmn", b"farsagen", b"farsagec"];

fuzz_target!(|input: &[u8]| {
    let Some(([which, kind], content)) = selected(input) else { return };
    let kind = KINDS[usize::from(kind) % KINDS.len()];
    let bytes = sealed_file(kind, content);
    let imported = kind.starts_with(b"farsage");
    with_directory(which, |run| {
        let path = run.path().join(if imported { "genotypes.bin" } else { "champion.bin" });
        fs::write(&path, &bytes).expect("a file");
        let read = || {
            if imported {
                run.record().and_then(|record| record.parameters(0))
            } else {
                run.champion().map(|champion| champion.parameters)
            }
        };
        if let Ok(parameters) = bounded(bytes.len(), read) {
            assert!(parameters.iter().all(|row| row.len() == 3), "an individual has other genes than the experiment");
        }
        fs::remove_file(&path).expect("the file");
    });
});
