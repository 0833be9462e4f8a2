//! Saving and reading: the same bits go on, and an altered state is refused.

#![cfg(feature = "serde")]
#![allow(clippy::unwrap_used)]

use farsa_evo::{
    Champion, Coevolution, Fitness, GaConfig, GeneRange, Lineage, Lineages, Mutation, OnePlusOne, OnePlusOneConfig,
    OnePlusOneHistory, RandomSearch, Statistics, Strategy, TruncationGa,
};
use postcard::{from_bytes, to_allocvec};
use serde::{Serialize, de::DeserializeOwned};

fn live<S: Strategy>(strategy: &mut S, generations: u32) {
    for _ in 0..generations {
        let told: Vec<_> = strategy.ask().iter().map(|genes| Fitness::nan_as_failed(f64::from(genes[0]))).collect();
        strategy.tell(&told).unwrap();
    }
}

fn interrupted_is_uninterrupted<S: Strategy + Serialize + DeserializeOwned + PartialEq + std::fmt::Debug>(
    fresh: impl Fn() -> S,
) {
    let mut whole = fresh();
    live(&mut whole, 30);
    let mut part = fresh();
    for _ in 0..3 {
        part = from_bytes(&to_allocvec(&part).unwrap()).unwrap();
        live(&mut part, 10);
    }
    assert_eq!(part, whole);
    assert_eq!(to_allocvec(&part).unwrap(), to_allocvec(&whole).unwrap());
}

#[test]
fn interrupted_evolution_gives_the_same_bits() {
    interrupted_is_uninterrupted(|| TruncationGa::new(GaConfig::new(12), 6).unwrap());
    interrupted_is_uninterrupted(|| RandomSearch::new(12, 20, 6).unwrap());
    interrupted_is_uninterrupted(|| OnePlusOne::new(OnePlusOneConfig::new(12), 6).unwrap());
    let narrow = GaConfig { gene_bits: 8, ..GaConfig::new(12) };
    interrupted_is_uninterrupted(|| TruncationGa::new(narrow, 6).unwrap());
    interrupted_is_uninterrupted(|| Coevolution::new(&[GaConfig::new(12), narrow], 6).unwrap());
}

/// A configuration as it was saved before genes had a number of bits.
#[derive(Serialize)]
struct Old {
    genes: usize,
    population: usize,
    parents: usize,
    mutation_rate: f64,
    mutation: Mutation,
}

#[test]
fn a_configuration_of_16_bits_is_saved_as_ever() {
    for mutation in [Mutation::Resample, Mutation::Flip] {
        let config = GaConfig { mutation, ..GaConfig::new(300) };
        let old = Old { genes: 300, population: 100, parents: 20, mutation_rate: 0.015, mutation };
        let bytes = to_allocvec(&old).unwrap();
        assert_eq!(to_allocvec(&config).unwrap(), bytes);
        assert_eq!(from_bytes::<GaConfig>(&bytes).unwrap(), config);
        let narrow = GaConfig { gene_bits: 8, ..config };
        assert_eq!(from_bytes::<GaConfig>(&to_allocvec(&narrow).unwrap()).unwrap(), narrow);
    }
}

#[test]
fn a_forged_history_is_refused() {
    let mut search = OnePlusOne::new(OnePlusOneConfig::new(5), 6).unwrap();
    live(&mut search, 11);
    assert_eq!(&from_bytes::<OnePlusOneHistory>(&to_allocvec(search.history()).unwrap()).unwrap(), search.history());
    let config = *search.config();
    let read = |config: OnePlusOneConfig, generations: u32, accepted: &[u8]| {
        from_bytes::<OnePlusOneHistory>(&to_allocvec(&(config, 6_u64, generations, accepted.to_vec())).unwrap())
    };
    assert_eq!(read(config, 11, &[3, 4]).unwrap().latest(), 11);
    assert!(read(config, 16, &[3, 255]).is_ok());
    for (generations, accepted) in [(11, &[3][..]), (11, &[3, 8]), (11, &[3, 4, 0]), (8, &[3, 0]), (0, &[0])] {
        assert!(read(config, generations, accepted).is_err(), "{generations} {accepted:?}");
    }
    assert!(read(OnePlusOneConfig { gene_bits: 0, ..config }, 3, &[3]).is_err());
    assert!(read(OnePlusOneConfig { last_rate: 0.9, ..config }, 3, &[3]).is_err());
    // Another seed or history, with the digest of these genomes.
    let bytes = |seed: u64, accepted: bool| {
        let mut history = OnePlusOneHistory::new(config, seed).unwrap();
        (0..11).for_each(|g| history.record(accepted ^ search.history().accepted(g).unwrap()).unwrap());
        to_allocvec(&((history, Fitness::WORST), search.ask().digest())).unwrap()
    };
    assert!(from_bytes::<OnePlusOne>(&bytes(6, false)).is_ok());
    assert!(from_bytes::<OnePlusOne>(&bytes(7, false)).is_err());
    assert!(from_bytes::<OnePlusOne>(&bytes(6, true)).is_err());
}

#[test]
fn forged_lineages_are_refused() {
    let mut all = Coevolution::new(&[GaConfig::new(4), GaConfig::new(5)], 6).unwrap();
    live(&mut all, 3);
    assert_eq!(from_bytes::<Lineages>(&to_allocvec(&all.lineages()).unwrap()).unwrap(), all.lineages());
    let mut apart: Vec<Lineage> = all.lineages().into();
    let digest = all.ask().digest();
    assert_eq!(from_bytes::<Coevolution>(&to_allocvec(&(&apart, digest)).unwrap()).unwrap(), all);
    apart.swap(0, 1);
    assert!(from_bytes::<Coevolution>(&to_allocvec(&(&apart, digest)).unwrap()).is_err());
    apart.pop();
    assert!(from_bytes::<Lineages>(&to_allocvec(&apart).unwrap()).is_err());
}

#[test]
fn a_lineage_round_trips_in_few_bytes() {
    let mut ga = TruncationGa::new(GaConfig::new(12), 6).unwrap();
    live(&mut ga, 100);
    let bytes = to_allocvec(ga.lineage()).unwrap();
    assert!(bytes.len() < 100 * 20 + 40);
    assert_eq!(&from_bytes::<Lineage>(&bytes).unwrap(), ga.lineage());
}

#[test]
fn fitness_round_trips() {
    for value in [f64::NEG_INFINITY, -1.5, 0.0, f64::INFINITY] {
        let fitness = Fitness::new(value).unwrap();
        assert_eq!(from_bytes::<Fitness>(&to_allocvec(&fitness).unwrap()).unwrap(), fitness);
    }
    assert_eq!(to_allocvec(&Fitness::WORST).unwrap(), to_allocvec(&None::<f64>).unwrap());
    assert!(from_bytes::<Fitness>(&to_allocvec(&Some(f64::NAN)).unwrap()).is_err());
}

/// The serialised fields of a lineage, free of its checks.
#[derive(Serialize)]
struct Forged {
    config: GaConfig,
    seed: u64,
    selected: Vec<u32>,
}

#[test]
fn a_forged_lineage_is_refused() {
    let config = GaConfig { population: 4, parents: 2, ..GaConfig::new(3) };
    let read = |config, selected: &[u32]| {
        let forged = Forged { config, seed: 1, selected: selected.to_vec() };
        from_bytes::<Lineage>(&to_allocvec(&forged).unwrap())
    };
    assert_eq!(read(config, &[0, 3, 2, 1]).unwrap().latest(), 2);
    for selected in [&[0][..], &[0, 3, 1], &[0, 4], &[0, u32::MAX], &[3, 3]] {
        assert!(read(config, selected).is_err(), "{selected:?}");
    }
    for config in [
        GaConfig { genes: 0, ..config },
        GaConfig { genes: usize::MAX, ..config },
        GaConfig { population: 0, ..config },
        GaConfig { population: 5, ..config },
        GaConfig { parents: 0, ..config },
        GaConfig { parents: 8, ..config },
        GaConfig { mutation_rate: f64::NAN, ..config },
        GaConfig { mutation_rate: -0.1, ..config },
    ] {
        assert!(read(config, &[0, 1]).is_err(), "{config:?}");
    }
}

#[test]
fn a_state_with_other_genomes_is_refused() {
    let mut ga = TruncationGa::new(GaConfig::new(12), 6).unwrap();
    live(&mut ga, 3);
    let forge = |config: GaConfig, seed, swap: bool| {
        let lineage = ga.lineage();
        let mut selected: Vec<u32> =
            (0..lineage.latest()).flat_map(|g| lineage.selected(g).unwrap().to_vec()).collect();
        if swap {
            selected.swap(40, 41);
        }
        from_bytes::<TruncationGa>(&to_allocvec(&(Forged { config, seed, selected }, ga.ask().digest())).unwrap())
    };
    let config = *ga.config();
    assert_eq!(forge(config, 6, false).unwrap(), ga);
    assert!(forge(config, 7, false).is_err());
    assert!(forge(config, 6, true).is_err());
    assert!(forge(GaConfig { mutation: Mutation::Flip, ..config }, 6, false).is_err());
    assert!(forge(GaConfig { mutation_rate: 0.016, ..config }, 6, false).is_err());
}

#[test]
fn a_forged_search_is_refused() {
    type Best = Option<(u32, usize, Option<f64>)>;
    let mut search = RandomSearch::new(5, 10, 6).unwrap();
    let read = |search: &RandomSearch, seed: u64, generation: u32, best: Best| {
        let state = (5_usize, 10_usize, seed, generation, best);
        from_bytes::<RandomSearch>(&to_allocvec(&(state, search.ask().digest())).unwrap())
    };
    assert_eq!(read(&search, 6, 0, None).unwrap(), search);
    assert!(read(&search, 6, 0, Some((0, 0, Some(1.0)))).is_err());
    live(&mut search, 2);
    let best = search.best().unwrap();
    let found = Some((best.generation, best.individual, Some(best.fitness.get())));
    assert_eq!(read(&search, 6, 2, found).unwrap(), search);
    for (seed, generation, best) in [
        (7, 2, found),
        (6, 3, found),
        (6, 2, None),
        (6, 2, Some((2, 0, Some(1.0)))),
        (6, 2, Some((1, 10, Some(1.0)))),
        (6, 2, Some((1, 9, Some(f64::NAN)))),
    ] {
        assert!(read(&search, seed, generation, best).is_err());
    }
}

#[test]
fn torn_bytes_are_refused() {
    let mut ga = TruncationGa::new(GaConfig::new(12), 6).unwrap();
    live(&mut ga, 3);
    let bytes = to_allocvec(&ga).unwrap();
    for len in 0..bytes.len() {
        assert!(from_bytes::<TruncationGa>(&bytes[..len]).is_err());
    }
    // Any single changed byte gives an error or, where it holds nothing that shows yet, a state that goes on.
    for at in 0..bytes.len() {
        let mut bent = bytes.clone();
        bent[at] ^= 0x15;
        if let Ok(mut read) = from_bytes::<TruncationGa>(&bent) {
            live(&mut read, 2);
        }
    }
}

#[test]
fn ranges_and_summaries_come_back_and_are_checked() {
    let range = GeneRange::new(3, -6.0, 6.0).unwrap();
    for range in [range, range.with_gene_bits(8).unwrap()] {
        assert_eq!(from_bytes::<GeneRange>(&to_allocvec(&range).unwrap()).unwrap(), range);
    }
    // Its fields, with the ends exchanged and with too many bits.
    for (low, high, bits) in [(6.0_f32, -6.0_f32, 16_u32), (-6.0, 6.0, 17), (-6.0, f32::NAN, 16)] {
        assert!(from_bytes::<GeneRange>(&to_allocvec(&(3_usize, low, high, bits)).unwrap()).is_err());
    }
    assert_eq!(to_allocvec(&(3_usize, -6.0_f32, 6.0_f32, 16_u32)).unwrap(), to_allocvec(&range).unwrap());
    let summary = Statistics::from_fitness(&[1.0, f64::NAN, 3.0].map(Fitness::nan_as_failed)).unwrap();
    assert_eq!(from_bytes::<Statistics>(&to_allocvec(&summary).unwrap()).unwrap(), summary);
    let failed = Statistics::from_fitness(&[Fitness::WORST]).unwrap();
    assert_eq!(from_bytes::<Statistics>(&to_allocvec(&failed).unwrap()).unwrap(), failed);
    let champion = Champion { generation: 3, individual: 2, fitness: Fitness::WORST, genome: vec![1, 2, 3] };
    assert_eq!(from_bytes::<Champion>(&to_allocvec(&champion).unwrap()).unwrap(), champion);
}
