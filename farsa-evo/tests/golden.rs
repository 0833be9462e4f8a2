//! The bits themselves. A change here is a change of every recorded run: CHANGELOG.md lists it under *Values*.
#![allow(missing_docs, clippy::unwrap_used)]

use farsa_evo::coevolution::Populations;
use farsa_evo::words::{
    GaConfig, GeneRange, Mutation, OnePlusOne, OnePlusOneConfig, RandomSearch, TruncationGa, decode,
};
use farsa_evo::{Fitness, Record, Strategy};
use farsa_num::Digest;

/// A rugged toy: it rewards a pattern within genes and its repetition between them.
fn rugged(genes: &[u16]) -> Fitness {
    let within: u32 = genes.iter().map(|gene| (gene ^ gene >> 3).count_ones()).sum();
    let between: u32 = genes.windows(2).map(|pair| (pair[0] ^ pair[1]).leading_zeros()).sum();
    Fitness::nan_as_failed(f64::from(within) + 0.25 * f64::from(between))
}

fn evolve(strategy: &mut impl Strategy, generations: u32) -> Record {
    let mut record = Record::new(strategy).unwrap();
    for _ in 0..generations {
        let told: Vec<_> = strategy.ask().iter().map(rugged).collect();
        record.tell(strategy, &told).unwrap();
    }
    record
}

/// The genomes at first, after fifty generations, and of three generations between as they are rebuilt.
fn digests<S: Strategy>(fresh: impl Fn() -> S) -> ([u64; 3], Record, S) {
    let mut strategy = fresh();
    let initial = strategy.ask().digest();
    let record = evolve(&mut strategy, 50);
    let mut rebuilt = Digest::new();
    for generation in [1, 17, 49] {
        let genomes = record.genomes(&mut fresh(), generation).unwrap();
        rebuilt.add_u64(genomes.digest());
        for gene in genomes.get(13).unwrap() {
            rebuilt.add_u64((*gene).into());
        }
    }
    ([initial, strategy.ask().digest(), rebuilt.finish()], record, strategy)
}

#[test]
fn evolution_keeps_its_bits() {
    let got = [Mutation::Resample, Mutation::Flip].map(|mutation| {
        let config = GaConfig { mutation, ..GaConfig::new(33) };
        let (digests, record, _) = digests(|| TruncationGa::new(config, 2010).unwrap());
        let mut selected = Digest::new();
        for parent in (0..50).flat_map(|generation| record.order(generation).unwrap().into_iter().take(20)) {
            selected.add_u64(parent as u64);
        }
        (digests, selected.finish())
    });
    let want = [
        ([0xbbb0_2d05_cf69_826c, 0xe52b_20a0_2886_1b12, 0x8bfa_a6d1_4128_1149], 0x4a8c_b775_f6a2_0feb),
        ([0xbbb0_2d05_cf69_826c, 0x180a_9454_cc35_1fc1, 0xd096_885a_c7bc_b587], 0x8355_a462_922a_9395),
    ];
    assert_eq!(got, want, "{got:#018x?}");
}

#[test]
fn one_plus_one_keeps_its_bits() {
    let fresh = || OnePlusOne::new(OnePlusOneConfig::new(14), 2010).unwrap();
    let mut search = fresh();
    let initial = search.ask().digest();
    let record = evolve(&mut search, 50);
    let replaced = (0..50).filter(|&generation| record.champion(0, generation) == Some(1)).count();
    let got = ([initial, search.ask().digest(), record.genomes(&mut fresh(), 17).unwrap().digest()], replaced);
    let want = ([0xac22_87e6_5b0c_8a05, 0x0c87_188c_2de1_9b05, 0x08e5_4d5e_4327_1e57], 7);
    assert_eq!(got, want, "{got:#018x?}");
}

#[test]
fn coevolution_keeps_its_bits() {
    let narrow = GaConfig { gene_bits: 8, ..GaConfig::new(20) };
    let (got, ..) = digests(|| Populations::truncation(&[GaConfig::new(33), narrow], 2010).unwrap());
    assert_eq!(got, [0xe7ae_3b09_c1ca_3298, 0xaaaf_3e62_d775_210e, 0x5a48_e5e8_d5b3_4951], "{got:#018x?}");
}

#[test]
fn random_search_keeps_its_bits() {
    let (got, _, search) = digests(|| RandomSearch::new(33, 100, 2010).unwrap());
    assert_eq!(got, [0xbbb0_2d05_cf69_826c, 0x12e2_c2b5_c82c_44ea, 0x6222_12a1_7067_076b], "{got:#018x?}");
    let best = search.best().unwrap();
    assert_eq!((best.generation, best.individual, best.fitness.get()), (1, 31, 313.0));
}

#[test]
fn decoding_keeps_its_bits() {
    let ranges = [(-6.0, 6.0), (0.0, 1.0), (-0.1, 1e-3)].map(|(low, high)| GeneRange::new(1 << 16, low, high).unwrap());
    let genes: Vec<u16> = (0..3).flat_map(|_| 0..=u16::MAX).collect();
    let mut values = vec![0.0; genes.len()];
    decode(&genes, &ranges, &mut values).unwrap();
    let mut digest = Digest::new();
    digest.add_f32s(&values);
    assert_eq!(digest.finish(), 0xa447_0827_53bb_a676, "{:#018x}", digest.finish());
}
