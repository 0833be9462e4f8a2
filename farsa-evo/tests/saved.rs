//! Saving and reading: the same bits go on, and an altered state is refused.

#![cfg(feature = "serde")]
#![allow(clippy::unwrap_used)]

use farsa_evo::{Fitness, GaConfig, Lineage, Mutation, RandomSearch, Strategy, TruncationGa};
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
