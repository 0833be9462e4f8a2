//! Saved and restored strategies continue with the same bits, and altered states are refused.

use farsa_evo::coevolution::Populations;
use farsa_evo::words::{GaConfig, GeneRange, Mutation, OnePlusOne, OnePlusOneConfig, RandomSearch, TruncationGa};
use farsa_evo::{Champion, Fitness, Record, RecordEntry, RecordKind, Snapshot, Statistics, Strategy};
use postcard::{from_bytes, to_allocvec};
use serde::{Serialize, de::DeserializeOwned};

fn advance<S: Strategy>(strategy: &mut S, generations: u32) {
    for _ in 0..generations {
        let fitness: Vec<_> = strategy.ask().iter().map(|genes| Fitness::nan_as_failed(f64::from(genes[0]))).collect();
        strategy.tell(&fitness).unwrap();
    }
}

fn interrupted_is_uninterrupted<S: Strategy + Serialize + DeserializeOwned + PartialEq + std::fmt::Debug>(
    fresh: impl Fn() -> S,
) {
    let mut uninterrupted = fresh();
    advance(&mut uninterrupted, 30);
    let mut part = fresh();
    for _ in 0..3 {
        part = from_bytes(&to_allocvec(&part).unwrap()).unwrap();
        advance(&mut part, 10);
    }
    assert_eq!(part, uninterrupted);
    assert_eq!(to_allocvec(&part).unwrap(), to_allocvec(&uninterrupted).unwrap());
}

#[test]
fn interrupted_evolution_gives_the_same_bits() {
    interrupted_is_uninterrupted(|| TruncationGa::new(GaConfig::new(12), 6).unwrap());
    interrupted_is_uninterrupted(|| RandomSearch::new(12, 20, 6).unwrap());
    interrupted_is_uninterrupted(|| OnePlusOne::new(OnePlusOneConfig::new(12), 6).unwrap());
    let narrow = GaConfig { gene_bits: 8, ..GaConfig::new(12) };
    interrupted_is_uninterrupted(|| TruncationGa::new(narrow, 6).unwrap());
    interrupted_is_uninterrupted(|| Populations::truncation(&[GaConfig::new(12), narrow], 6).unwrap());
}

/// The saved form of a configuration whose genes have no number of bits.
#[derive(Serialize)]
struct Old {
    genes: usize,
    population: usize,
    parents: usize,
    mutation_rate: f64,
    mutation: Mutation,
}

#[test]
fn a_configuration_of_16_bits_keeps_its_saved_form() {
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

/// The saved form of a strategy, without its checks.
#[derive(Serialize)]
struct Forged<C> {
    config: C,
    seed: u64,
    state: Vec<u8>,
}

/// Changes the state of a strategy after three generations and reads it back.
fn bent<S, C>(strategy: &S, config: C, change: impl Fn(&mut Vec<u8>)) -> Result<S, postcard::Error>
where
    S: Snapshot + DeserializeOwned,
    C: Serialize,
{
    let mut state = strategy.save();
    change(&mut state);
    from_bytes(&to_allocvec(&Forged { config, seed: 6, state }).unwrap())
}

#[test]
fn a_forged_state_is_refused() {
    let config = GaConfig { population: 4, parents: 2, gene_bits: 8, ..GaConfig::new(3) };
    let mut ga = TruncationGa::new(config, 6).unwrap();
    advance(&mut ga, 3);
    let read = |change: &dyn Fn(&mut Vec<u8>)| bent(&ga, config, change);
    assert_eq!(read(&|_| ()).unwrap(), ga);
    // Generation (4 bytes), two parents (4 each), then genes (2 each).
    assert!(read(&|state| state[4] = 4).is_err(), "a parent beyond the population");
    assert!(read(&|state| state.copy_within(4..8, 8)).is_err(), "a parent twice");
    assert!(read(&|state| state[13] = 1).is_err(), "a gene above 255");
    assert!(read(&|state| state[..4].fill(0)).is_err(), "parents in generation 0");
    assert!(
        read(&|state| state.push(0)).is_err() && read(&|state| state.truncate(state.len() - 1)).is_err(),
        "another length"
    );
    for config in [
        GaConfig { genes: 0, ..config },
        GaConfig { genes: usize::MAX, ..config },
        GaConfig { genes: 4, ..config },
        GaConfig { population: 0, ..config },
        GaConfig { population: 5, ..config },
        GaConfig { population: 6, ..config },
        GaConfig { parents: 0, ..config },
        GaConfig { parents: 1, ..config },
        GaConfig { mutation_rate: f64::NAN, ..config },
    ] {
        assert!(bent(&ga, config, |_| ()).is_err(), "{config:?}");
    }

    let config = OnePlusOneConfig::new(5);
    let mut search = OnePlusOne::new(config, 6).unwrap();
    advance(&mut search, 3);
    let read = |change: &dyn Fn(&mut Vec<u8>)| bent(&search, config, change);
    assert_eq!(read(&|_| ()).unwrap(), search);
    // Generation, survivor (4 bytes each), sum (8), evaluations (4), genes.
    assert!(read(&|state| state[4] = 2).is_err(), "a third survivor");
    assert!(read(&|state| state[8..16].fill(0xff)).is_err(), "a sum that is NaN");
    assert!(read(&|state| state[16] = 0).is_err() && read(&|state| state[16] = 4).is_err(), "evaluations");
    assert!(read(&|state| state[21] = 1).is_err(), "a gene above 255");
    assert!(read(&|state| state.truncate(state.len() - 1)).is_err(), "another length");
    assert!(bent(&search, OnePlusOneConfig { last_rate: 0.9, ..config }, |_| ()).is_err());

    let configs = vec![GaConfig::new(4), GaConfig::new(5)];
    let mut populations = Populations::truncation(&configs, 6).unwrap();
    advance(&mut populations, 3);
    let read = |change: &dyn Fn(&mut Vec<u8>)| bent(&populations, configs.clone(), change);
    assert_eq!(read(&|_| ()).unwrap(), populations);
    assert!(read(&|state| state[8] = 2).is_err(), "a population at another generation");
    assert!(read(&|state| state[0] ^= 4).is_err() && read(&|state| state[7] = 255).is_err(), "another length");
    assert!(
        read(&|state| state.push(0)).is_err() && read(&|state| state.truncate(state.len() - 1)).is_err(),
        "another length"
    );
    assert!(bent(&populations, configs[..1].to_vec(), |_| ()).is_err());

    let mut search = RandomSearch::new(5, 10, 6).unwrap();
    assert_eq!(bent(&search, (5_usize, 10_usize), |_| ()).unwrap(), search);
    advance(&mut search, 3);
    let read = |change: &dyn Fn(&mut Vec<u8>)| bent(&search, (5_usize, 10_usize), change);
    assert_eq!(read(&|_| ()).unwrap(), search);
    // Generation, generation of the best (4 bytes each), its index (8), its fitness (8).
    assert!(read(&|state| state[4] = 3).is_err(), "a best of the future");
    assert!(read(&|state| state[8] = 10).is_err(), "a best beyond the population");
    assert!(read(&|state| state[16..].fill(0xff)).is_err(), "a fitness that is NaN");
    assert!(read(&|state| state.truncate(4)).is_err(), "no best");
}

#[test]
fn a_refused_state_changes_nothing() {
    let mut populations = Populations::truncation(&[GaConfig::new(4), GaConfig::new(5)], 6).unwrap();
    advance(&mut populations, 3);
    let (before, state) =
        (populations.clone(), Populations::truncation(&[GaConfig::new(4), GaConfig::new(5)], 6).unwrap().save());
    for len in (0..state.len()).step_by(7) {
        assert!(populations.restore(&state[..len]).is_err());
        assert_eq!(populations, before);
    }
}

/// The saved form of a record, without its checks.
#[derive(Clone, Serialize)]
struct ForgedRecord {
    shape: (RecordKind, usize, usize, usize, usize),
    frames: Vec<u8>,
    keyframes: Vec<(u32, Vec<u8>)>,
}

#[test]
fn a_record_round_trips_and_a_forged_one_is_refused() {
    let config = GaConfig { population: 4, parents: 2, ..GaConfig::new(3) };
    let fresh = || TruncationGa::new(config, 6).unwrap();
    let mut ga = fresh();
    let mut record = Record::new(&mut ga).unwrap();
    for _ in 0..40 {
        let fitness: Vec<_> = ga.ask().iter().map(|genes| Fitness::nan_as_failed(f64::from(genes[0]))).collect();
        record.tell(&mut ga, &fitness).unwrap();
    }
    let read: Record = from_bytes(&to_allocvec(&record).unwrap()).unwrap();
    assert_eq!(read, record);
    // An interrupted search that replays single entries continues like an uninterrupted one.
    let mut again = Record::new(&mut fresh()).unwrap();
    for generation in 0..record.generations() {
        again.push(record.entry(generation).unwrap()).unwrap();
    }
    assert_eq!((&again, again.entry(40)), (&record, None));
    assert!((0..40).any(|generation| record.entry(generation).unwrap().state.is_some()), "states among them");
    let forged = |frame: &[u8]| again.clone().push(RecordEntry { frame, state: None });
    assert!(forged(&[3, 3, 1, 0, 2]).is_ok());
    for frame in [&[4, 3, 1, 0, 2][..], &[3, 3, 1, 0, 3], &[3, 3, 1, 0, 4], &[3, 3, 1, 0], &[3, 3, 1, 0, 2, 0], &[]] {
        assert!(forged(frame).is_err(), "{frame:?}");
    }
    let (frames, keyframes) = (vec![3, 3, 1, 0, 2, 0, 0, 1, 2, 3], vec![(1, ga.save())]);
    let good = ForgedRecord { shape: (RecordKind::Order, 1, 4, 3, 2), frames, keyframes };
    let read = |change: &dyn Fn(&mut ForgedRecord)| {
        let mut forged = good.clone();
        change(&mut forged);
        from_bytes::<Record>(&to_allocvec(&forged).unwrap())
    };
    assert_eq!(read(&|_| ()).unwrap().generations(), 2);
    assert_eq!(read(&|_| ()).unwrap().order(0), Some(vec![3, 1, 0, 2]));
    assert!(read(&|record| record.frames[0] = 4).is_err(), "a champion beyond the population");
    assert!(read(&|record| record.frames[2] = 3).is_err(), "an individual twice");
    assert!(read(&|record| record.frames[9] = 4).is_err(), "an individual beyond the population");
    assert!(read(&|record| record.frames.truncate(9)).is_err(), "half a generation");
    assert!(read(&|record| record.keyframes[0].0 = 3).is_err(), "a state of the future");
    assert!(read(&|record| record.keyframes.push((1, Vec::new()))).is_err(), "two states of a generation");
    for (populations, individuals, genes) in [(0, 4, 3), (3, 4, 3), (1, 0, 3), (1, 4, 0), (1, usize::MAX, usize::MAX)] {
        assert!(read(&|record| record.shape = (RecordKind::Order, populations, individuals, genes, 2)).is_err());
    }
    let values = |bytes: [u8; 8]| {
        let frames = [&[0][..], &bytes].concat();
        let forged = ForgedRecord { shape: (RecordKind::Values, 1, 1, 3, 2), frames, keyframes: Vec::new() };
        from_bytes::<Record>(&to_allocvec(&forged).unwrap())
    };
    assert!(values([0xff; 8]).is_err() && values([0; 8]).is_ok(), "a fitness that is NaN");
    // A state of another generation or another strategy is refused when it is needed.
    let shifted = read(&|record| record.keyframes[0].0 = 2).unwrap();
    assert!(shifted.rebuild(&mut fresh(), 2).is_err());
    let bent = read(&|record| record.keyframes[0].1.truncate(5)).unwrap();
    assert!(bent.rebuild(&mut fresh(), 2).is_err());
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

/// The saved form of a strategy, without its checks.
#[derive(Serialize)]
struct ForgedStrategy<C> {
    config: C,
    seed: u64,
    state: Vec<u8>,
}

#[test]
fn a_forged_size_takes_no_memory() {
    // About thirty bytes claim half a gigabyte of genes. Allocating a hundred thousand of them would take hours.
    let config = GaConfig { population: 1 << 27, parents: 1, ..GaConfig::new(2) };
    for _ in 0..100_000 {
        let state = Vec::from([0; 12]);
        let forged = to_allocvec(&ForgedStrategy { config, seed: 1, state: state.clone() }).unwrap();
        assert!(forged.len() < 60 && from_bytes::<TruncationGa>(&forged).is_err());
        let forged = to_allocvec(&ForgedStrategy { config: vec![config; 2], seed: 1, state: state.clone() }).unwrap();
        assert!(from_bytes::<Populations<TruncationGa, u16>>(&forged).is_err());
        let config = OnePlusOneConfig::new(1 << 27);
        assert!(from_bytes::<OnePlusOne>(&to_allocvec(&ForgedStrategy { config, seed: 1, state }).unwrap()).is_err());
    }
}

#[test]
fn torn_bytes_are_refused() {
    let mut ga = TruncationGa::new(GaConfig::new(12), 6).unwrap();
    advance(&mut ga, 3);
    let bytes = to_allocvec(&ga).unwrap();
    for len in 0..bytes.len() {
        assert!(from_bytes::<TruncationGa>(&bytes[..len]).is_err());
    }
    // A changed byte gives an error, or a state that can continue if the byte has no visible effect yet.
    for at in 0..bytes.len() {
        let mut bent = bytes.clone();
        bent[at] ^= 0x15;
        if let Ok(mut read) = from_bytes::<TruncationGa>(&bent) {
            advance(&mut read, 2);
        }
    }
}

#[test]
fn ranges_and_summaries_round_trip_and_are_checked() {
    let range = GeneRange::new(3, -6.0, 6.0).unwrap();
    for range in [range, range.with_gene_bits(8).unwrap()] {
        assert_eq!(from_bytes::<GeneRange>(&to_allocvec(&range).unwrap()).unwrap(), range);
    }
    // The fields with exchanged ends, and with too many bits.
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
