//! Genotypes: the original's `.gen` files, and lists of genes.
#![no_main]

use std::fmt::Write as _;
use std::sync::LazyLock;

use farsa_fuzz::{Scratch, bounded};
use farsa_lab::read_genotypes;
use libfuzzer_sys::fuzz_target;

static SCRATCH: LazyLock<Scratch> = LazyLock::new(Scratch::new);

/// The file that the original writes.
fn written(genotypes: &[Vec<u16>]) -> String {
    let mut text = String::new();
    for (number, genes) in genotypes.iter().enumerate() {
        let genes: String = genes.iter().map(|gene| format!("{gene}\n")).collect();
        let _ = write!(text, "**NET : s{number}_0.wts\nDYNAMICAL NN\n{genes}END\n");
    }
    text
}

farsa_fuzz::text!();

fuzz_target!(|input: &[u8]| {
    let (genes, bits) = (3, 8);
    let path = SCRATCH.put("genotypes.gen", input);
    let found = bounded(input.len(), || read_genotypes(&path, genes, bits));
    if let Ok(genotypes) = found {
        let again = SCRATCH.put("again.gen", written(&genotypes).as_bytes());
        assert_eq!(read_genotypes(&again, genes, bits).expect("what was written is read"), genotypes);
    }
});
