//! Novelty search over several strategies, compared with a transcription, on deceptive fitness and by digests.

use core::fmt::Debug;

use crate::errors;
use farsa_evo::archives::{ArchiveRule, NoveltyConfig, NoveltySearch};
use farsa_evo::covariance::{CmaEs, CmaEsConfig};
use farsa_evo::real::{EvolutionStrategy, EvolutionStrategyConfig, RealGa, RealGaConfig};
use farsa_evo::words::{GaConfig, TruncationGa};
use farsa_evo::{EvoError, Fitness, Gene, Record, ScoreShape, Scores, Snapshot, Strategy, check_strategy};
use farsa_num::{Domain, Stream};

const THRESHOLD: ArchiveRule = ArchiveRule::Threshold { first: 0.4, most: 2, patience: 3 };

fn config(archive: ArchiveRule) -> NoveltyConfig {
    NoveltyConfig { neighbors: 4, archive, ..NoveltyConfig::new(2) }
}

fn words() -> Result<TruncationGa, EvoError> {
    TruncationGa::new(GaConfig { population: 12, parents: 4, mutation_rate: 0.1, ..GaConfig::new(3) }, 5)
}

fn reals() -> Result<RealGa, EvoError> {
    RealGa::new(RealGaConfig { population: 12, ..RealGaConfig::new(vec![[-1.0, 1.0]; 3]) }, 5)
}

fn normal() -> Result<CmaEs, EvoError> {
    CmaEs::new(CmaEsConfig { population: 12, ..CmaEsConfig::new(vec![0.0; 3], 0.3) }, 5)
}

#[test]
fn diagnostics_are_its_archive_and_those_of_the_inner_strategy() {
    let mut search = NoveltySearch::new(config(ArchiveRule::Random { rate: 1.0 }), normal().unwrap(), 7).unwrap();
    for _ in 0..3 {
        let values: Vec<f64> = search.ask().iter().flat_map(|genes| [0.0, genes[0], genes[1]]).collect();
        search.tell_scores(&Scores::new(search.score_shape(), values).unwrap()).unwrap();
    }
    let [archived, largest, sigma, ratio] = search.diagnostics()[..] else { panic!("says four numbers") };
    assert_eq!(archived, 36.0, "twelve individuals of each generation");
    assert_eq!(Some(largest), search.novelty().iter().map(|novelty| novelty.get()).reduce(f64::max));
    assert_eq!([sigma, ratio], [search.inner().sigma(), search.inner().axis_ratio()]);
}

#[test]
fn the_oldest_behaviors_leave_a_full_archive() {
    let every = config(ArchiveRule::Random { rate: 1.0 });
    let mut free = NoveltySearch::new(every, words().unwrap(), 7).unwrap();
    let mut full = NoveltySearch::new(NoveltyConfig { capacity: 30, ..every }, words().unwrap(), 7).unwrap();
    for _ in 0..3 {
        let scores = scores(&free, f64::from);
        free.tell_scores(&scores).unwrap();
        full.tell_scores(&scores).unwrap();
    }
    // Behaviors of two numbers, without those of failed evaluations.
    let oldest = free.archive().len() - 2 * 30;
    assert!(oldest > 0 && full.archive() == &free.archive()[oldest..]);
    let mut small = NoveltySearch::new(NoveltyConfig { capacity: 29, ..every }, words().unwrap(), 7).unwrap();
    assert!(small.restore(&full.save()).is_err());
}

#[test]
fn it_conforms() {
    for rule in [ArchiveRule::Random { rate: 0.3 }, THRESHOLD] {
        check_strategy(|| NoveltySearch::new(config(rule), words()?, 7), 40).unwrap();
        check_strategy(|| NoveltySearch::new(config(rule), reals()?, 7), 40).unwrap();
        check_strategy(|| NoveltySearch::new(config(rule), normal()?, 7), 40).unwrap();
    }
}

/// A behavior of two numbers. One evaluation in eleven fails.
fn judge(genes: &[f64], row: &mut [f64]) {
    let failed = genes[0].to_bits().is_multiple_of(11);
    row.copy_from_slice(&[if failed { f64::NAN } else { genes[2] }, genes[0] + genes[1], genes[1] * genes[2]]);
}

fn scores<G: Gene>(search: &impl Strategy<G>, real: impl Fn(G) -> f64) -> Scores {
    let mut values = vec![0.0; 3 * search.ask().len()];
    for (genes, row) in search.ask().iter().zip(values.chunks_mut(3)) {
        judge(&genes.iter().map(|gene| real(*gene)).collect::<Vec<_>>(), row);
    }
    Scores::nan_as_failed(search.score_shape(), values).unwrap()
}

/// Computes novelty as the source defines it, passes it to a second inner strategy, and compares the two.
fn check_against_the_source<G: Gene, S: Strategy<G> + Snapshot + Debug + PartialEq>(
    fresh: impl Fn() -> Result<S, EvoError>,
    rule: ArchiveRule,
    real: impl Fn(G) -> f64,
) {
    let mut search = NoveltySearch::new(config(rule), fresh().unwrap(), 7).unwrap();
    let mut alone = fresh().unwrap();
    let (mut archive, mut threshold, mut idle): (Vec<[f64; 2]>, f64, u32) = (Vec::new(), 0.4, 0);
    for generation in 0..30 {
        let scores = scores(&search, &real);
        let place = |i: usize| [scores.measures(i)[0], scores.measures(i)[1]];
        let valid: Vec<usize> = (0..12).filter(|i| !scores.is_failed(*i)).collect();
        let novelty = |index: usize| {
            let far = |other: [f64; 2]| {
                let [x, y] = [0, 1].map(|axis| other[axis] - place(index)[axis]);
                (x * x + y * y).sqrt()
            };
            let others = valid.iter().filter(|i| **i != index).map(|i| far(place(*i)));
            let mut distances: Vec<f64> = others.chain(archive.iter().map(|behaviour| far(*behaviour))).collect();
            distances.sort_by(f64::total_cmp);
            distances.iter().take(4).sum::<f64>() / 4.0
        };
        let values: Vec<f64> = (0..12).map(|i| if scores.is_failed(i) { f64::NAN } else { novelty(i) }).collect();
        let mut added = Vec::new();
        for &i in &valid {
            let chance = Stream::new(7, Domain::General, 1, i as u32, generation).uniform_f64();
            let enters = match rule {
                ArchiveRule::Random { rate } => chance < rate,
                ArchiveRule::Threshold { .. } => values[i] > threshold,
            };
            if enters {
                added.push(place(i));
            }
        }
        idle = if added.is_empty() { idle + 1 } else { 0 };
        if added.len() > 2 {
            threshold *= 1.2;
        } else if idle == 3 {
            (threshold, idle) = (0.95 * threshold, 0);
        }
        archive.extend(added);
        search.tell_scores(&scores).unwrap();
        alone.tell_values(&values).unwrap();
        assert_eq!(search.inner(), &alone, "{generation}");
        assert_eq!(search.archive(), archive.as_flattened());
        assert!(
            search.novelty().iter().map(|novelty| novelty.get()).eq(values.iter().map(|x| x.max(f64::NEG_INFINITY)))
        );
        let wanted = matches!(rule, ArchiveRule::Threshold { .. }).then_some(threshold);
        assert!(search.threshold().zip(wanted).is_none_or(|(got, want)| (got - want).abs() < 1e-12));
        assert_eq!(search.threshold().is_some(), wanted.is_some());
    }
    assert!(archive.len() > 10, "{}", archive.len());
}

#[test]
fn novelty_is_that_of_the_source() {
    for rule in [ArchiveRule::Random { rate: 0.3 }, THRESHOLD] {
        check_against_the_source(words, rule, |gene| f64::from(gene) / 16_384.0);
        check_against_the_source(reals, rule, |gene| gene);
        check_against_the_source(normal, rule, |gene| gene);
    }
}

/// Fitness rises from 0 to a trap at 0.3, then falls, and is largest from 3.
#[test]
fn it_leaves_a_trap_of_deceptive_fitness() {
    let fitness = |x: f64| if x >= 3.0 { 10.0 } else { 1.0 - (x - 0.3).abs() };
    for seed in 0..5 {
        let inner = || EvolutionStrategy::new(EvolutionStrategyConfig::new(vec![0.0; 2], 0.05), seed).unwrap();
        let trapped = inner().maximize(60, |genes| fitness(genes[0])).unwrap();
        assert!((trapped.genome[0] - 0.3).abs() < 1e-3, "{seed}: {trapped:?}");
        let mut search = NoveltySearch::new(NoveltyConfig::new(1), inner(), seed).unwrap();
        let champion = search.evolve(60, |genes, row| row.copy_from_slice(&[fitness(genes[0]), genes[0]])).unwrap();
        assert_eq!(champion.fitness.get(), 10.0, "{seed}");
    }
}

#[test]
fn a_thousand_generations_are_rebuilt() {
    let inner = || TruncationGa::new(GaConfig { population: 100, ..GaConfig::new(3) }, 5);
    let fresh = || NoveltySearch::new(NoveltyConfig::new(2), inner().unwrap(), 7).unwrap();
    let mut search = fresh();
    let mut record = Record::new(&mut search).unwrap();
    let mut asked = Vec::new();
    for generation in 0..1000 {
        if generation % 333 == 0 {
            asked.push((generation, search.ask().clone()));
        }
        let scores = scores(&search, |gene: u16| f64::from(gene) / 16_384.0);
        record.tell_scores(&mut search, &scores).unwrap();
    }
    for (generation, genomes) in asked {
        assert_eq!(record.genomes(&mut fresh(), generation).unwrap(), genomes);
    }
    let mut again = fresh();
    record.rebuild(&mut again, 1000).unwrap();
    assert_eq!(again.save(), search.save());
}

#[test]
fn it_keeps_its_bits() {
    let digest = |rule| {
        let mut search = NoveltySearch::new(config(rule), reals().unwrap(), 2011).unwrap();
        search.evolve(50, judge).unwrap();
        search.ask().digest()
    };
    let got = [digest(ArchiveRule::Random { rate: 0.1 }), digest(THRESHOLD)];
    let want = [0x7f31_d65f_e48f_6866, 0x38ed_88ca_3ae0_da61];
    assert_eq!(got, want, "{got:#018x?}");
}

#[test]
fn impossible_configurations_are_refused() {
    let refused = |config: NoveltyConfig| match NoveltySearch::new(config, words().unwrap(), 0).unwrap_err() {
        EvoError::OutOfRange { field, value, .. } => (field, value),
        other => panic!("{other}"),
    };
    let base = NoveltyConfig::new(2);
    assert_eq!(refused(NoveltyConfig::new(0)), ("the number of descriptor values", 0.0));
    assert_eq!(refused(NoveltyConfig { neighbors: 0, ..base }), ("the number of neighbours", 0.0));
    assert_eq!(refused(NoveltyConfig { capacity: 0, ..base }), ("the capacity of the archive", 0.0));
    let rule = |archive| NoveltyConfig { archive, ..base };
    assert_eq!(refused(rule(ArchiveRule::Random { rate: 1.5 })), ("the rate of the archive", 1.5));
    let threshold = |first, patience| ArchiveRule::Threshold { first, most: 4, patience };
    assert_eq!(refused(rule(threshold(0.0, 5))), ("the first threshold", 0.0));
    assert_eq!(refused(rule(threshold(1.0, 0))), ("the patience of the archive", 0.0));
    let mut advanced = words().unwrap();
    advanced.tell(&[Fitness::WORST; 12]).unwrap();
    assert_eq!(NoveltySearch::new(base, advanced, 0).unwrap_err(), errors::not_at_start(1));
    let nested = NoveltySearch::new(base, words().unwrap(), 0).unwrap();
    let (expected, found) = (ScoreShape::FITNESS, ScoreShape::new(1, 2));
    assert_eq!(NoveltySearch::new(base, nested, 0).unwrap_err(), errors::score_shape(expected, found));
    let mut search = NoveltySearch::new(base, words().unwrap(), 0).unwrap();
    let (expected, found) = (found, expected);
    assert_eq!(search.tell(&[Fitness::WORST; 12]), Err(errors::score_shape(expected, found)));
}

#[test]
fn a_damaged_state_is_refused() {
    let mut search = NoveltySearch::new(config(THRESHOLD), reals().unwrap(), 3).unwrap();
    (0..5).for_each(|_| search.tell_scores(&scores(&search, |gene: f64| gene)).unwrap());
    let (before, state) = (search.save(), search.save());
    let inner = 8 + u64::from_le_bytes(state[..8].try_into().unwrap()) as usize;
    assert!(search.archive().len() >= 4);
    // The length of the inner state, that state, the threshold, the number of behaviors, a behavior.
    let changes: [(usize, [u8; 8]); 6] = [
        (0, u64::MAX.to_le_bytes()),
        (inner - 8, 7.0_f64.to_le_bytes()),
        (inner + 4, 0.0_f64.to_le_bytes()),
        (inner + 12, 1_u64.to_le_bytes()),
        (inner + 12, u64::MAX.to_le_bytes()),
        (inner + 20, [0xff; 8]),
    ];
    for (at, bytes) in changes {
        let mut damaged = state.clone();
        damaged[at..at + 8].copy_from_slice(&bytes);
        assert!(search.restore(&damaged).is_err(), "{at}");
        assert_eq!(search.save(), before);
    }
    for short in [0, 7, inner, state.len() - 16] {
        assert!(search.restore(&state[..short]).is_err(), "{short}");
    }
    search.restore(&state).unwrap();
    assert_eq!(search.save(), before);
}

#[test]
fn distances_are_taken_in_units() {
    // A value and its unit that are both a thousand times as large give the same search.
    let plain = NoveltySearch::new(config(THRESHOLD), words().unwrap(), 7).unwrap();
    let scaled = plain.clone().with_units::<u16>(&[1024.0, 0.5]).unwrap();
    let (mut plain, mut scaled) = (plain, scaled);
    for _ in 0..20 {
        let scores = scores(&plain, |gene: u16| f64::from(gene) / 65_536.0);
        let larger = |row: &[f64]| [row[0], 1024.0 * row[1], 0.5 * row[2]];
        let larger = scores.values().chunks(3).flat_map(larger).collect();
        plain.tell_scores(&scores).unwrap();
        scaled.tell_scores(&Scores::nan_as_failed(scores.shape(), larger).unwrap()).unwrap();
        assert_eq!((plain.ask(), plain.novelty(), plain.archive()), (scaled.ask(), scaled.novelty(), scaled.archive()));
    }
    let fresh = || NoveltySearch::new(config(THRESHOLD), words().unwrap(), 7).unwrap();
    for units in [&[1.0][..], &[1.0, 0.0], &[f64::NAN, 1.0], &[1.0, f64::INFINITY]] {
        assert!(matches!(fresh().with_units::<u16>(units), Err(EvoError::OutOfRange { .. })), "{units:?}");
    }
    let late = plain.with_units::<u16>(&[1.0, 1.0]).map(drop);
    assert_eq!(late, Err(errors::not_at_start(20)));
}
