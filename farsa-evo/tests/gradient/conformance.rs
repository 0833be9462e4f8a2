//! Conformance of the gradient strategies, for several configurations of each.

use farsa_evo::gradient::{
    Ars, ArsConfig, OpenAiEs, OpenAiEsConfig, Optimizer, Pgpe, PgpeConfig, PgpeFitness, Snes, SnesConfig, Xnes,
    XnesConfig,
};
use farsa_evo::{Fitness, RecordKind, Snapshot, Strategy, check_strategy};
use proptest::prelude::{Just, ProptestConfig, prop, prop_oneof, proptest};
use proptest::strategy::Strategy as Generator;

fn mean(genes: usize) -> Vec<f64> {
    (0..genes).map(|gene| gene as f64 - 1.5).collect()
}

#[test]
fn natural_evolution_strategies_conform() {
    for genes in [1, 2, 7, 300] {
        let config = SnesConfig::new(mean(genes), 0.5);
        check_strategy(|| Snes::new(config.clone(), 3), 16).unwrap();
        let config = SnesConfig { population: 2, sigma_learning_rate: 10.0, ..config };
        check_strategy(|| Snes::new(config.clone(), 4), 16).unwrap();
    }
    for genes in [1, 2, 7, 30] {
        let config = XnesConfig::new(mean(genes), 0.5);
        check_strategy(|| Xnes::new(config.clone(), 3), 16).unwrap();
        let config = XnesConfig { population: 2, shape_learning_rate: 10.0, ..config };
        check_strategy(|| Xnes::new(config.clone(), 4), 16).unwrap();
    }
}

#[test]
fn mirrored_strategies_conform() {
    for genes in [1, 2, 300] {
        for pairs in [1, 9] {
            let config = OpenAiEsConfig::new(mean(genes), pairs);
            check_strategy(|| OpenAiEs::new(config.clone(), 3), 16).unwrap();
            let config = OpenAiEsConfig { optimizer: Optimizer::MOMENTUM, ..config };
            check_strategy(|| OpenAiEs::new(config.clone(), 3), 16).unwrap();
            let config = PgpeConfig::new(mean(genes), 0.3, pairs);
            check_strategy(|| Pgpe::new(config.clone(), 3), 16).unwrap();
            let config = PgpeConfig { fitness: PgpeFitness::Raw, ..config };
            check_strategy(|| Pgpe::new(config.clone(), 3), 16).unwrap();
            for top_directions in [1, pairs] {
                let config = ArsConfig { top_directions, ..ArsConfig::new(mean(genes), pairs) };
                check_strategy(|| Ars::new(config.clone(), 3), 16).unwrap();
            }
        }
    }
}

#[test]
fn record_kinds_match_the_shaping() {
    let pgpe =
        |fitness| Pgpe::new(PgpeConfig { fitness, ..PgpeConfig::new(mean(2), 0.3, 2) }, 0).unwrap().record_kind();
    assert_eq!([PgpeFitness::CenteredRanks, PgpeFitness::Raw].map(pgpe), [RecordKind::Order, RecordKind::Values]);
    assert_eq!(Snes::new(SnesConfig::new(mean(2), 1.0), 0).unwrap().record_kind(), RecordKind::Order);
    assert_eq!(Xnes::new(XnesConfig::new(mean(2), 1.0), 0).unwrap().record_kind(), RecordKind::Order);
    assert_eq!(OpenAiEs::new(OpenAiEsConfig::new(mean(2), 1), 0).unwrap().record_kind(), RecordKind::Order);
    assert_eq!(Ars::new(ArsConfig::new(mean(2), 1), 0).unwrap().record_kind(), RecordKind::Values);
}

fn length(x: impl Iterator<Item = f64>) -> f64 {
    x.map(|x| x * x).sum::<f64>().sqrt()
}

/// Runs a few generations and returns the length of the last step and the final mean.
fn moved<S: Strategy<f64>>(strategy: &mut S, mean: impl Fn(&S) -> Vec<f64>) -> (f64, Vec<f64>) {
    let mut before = Vec::new();
    for _ in 0..5 {
        before = mean(strategy);
        let fitness: Vec<f64> =
            strategy.ask().iter().map(|x| -x.iter().map(|x| (x - 3.0) * (x - 3.0)).sum::<f64>()).collect();
        strategy.tell_values(&fitness).unwrap();
    }
    let after = mean(strategy);
    (length(after.iter().zip(&before).map(|(a, b)| a - b)), after)
}

#[track_caller]
fn check_diagnostics(strategy: &impl Strategy<f64>, expected: &[f64]) {
    let diagnostics = strategy.diagnostics();
    assert_eq!(diagnostics.len(), expected.len());
    let close = |(a, b): (&f64, &f64)| *b > 0.0 && (a - b).abs() <= 1e-9 * b;
    assert!(diagnostics.iter().zip(expected).all(close), "{diagnostics:?} {expected:?}");
}

#[test]
fn diagnostics_match_the_last_step() {
    let ends =
        |all: &[f64]| [all.iter().copied().fold(f64::INFINITY, f64::min), all.iter().copied().fold(0.0, f64::max)];
    let mut ars = Ars::new(ArsConfig::new(mean(4), 6), 3).unwrap();
    let (step, point) = moved(&mut ars, |ars| ars.mean().to_vec());
    check_diagnostics(&ars, &[step, length(point.into_iter())]);
    let mut es = OpenAiEs::new(OpenAiEsConfig::new(mean(4), 6), 3).unwrap();
    let (step, point) = moved(&mut es, |es| es.mean().to_vec());
    check_diagnostics(&es, &[step, length(point.into_iter())]);
    let mut pgpe = Pgpe::new(PgpeConfig::new(mean(4), 0.3, 6), 3).unwrap();
    let (speed, _) = moved(&mut pgpe, |pgpe| pgpe.mean().to_vec());
    let [low, high] = ends(pgpe.sigmas());
    assert!(low < high);
    check_diagnostics(&pgpe, &[speed, low, high]);
    let mut snes = Snes::new(SnesConfig::new(mean(4), 0.5), 3).unwrap();
    moved(&mut snes, |snes| snes.mean().to_vec());
    let [low, high] = ends(snes.sigmas());
    assert!(low < high);
    check_diagnostics(&snes, &[low, high]);
    let mut xnes = Xnes::new(XnesConfig::new(mean(4), 0.5), 3).unwrap();
    moved(&mut xnes, |xnes| xnes.mean().to_vec());
    check_diagnostics(&xnes, &[xnes.sigma()]);
}

#[test]
fn every_strategy_saves_its_state() {
    assert!(Ars::new(ArsConfig::new(mean(2), 1), 0).unwrap().snapshot().is_some());
    assert!(OpenAiEs::new(OpenAiEsConfig::new(mean(2), 1), 0).unwrap().snapshot().is_some());
    assert!(Pgpe::new(PgpeConfig::new(mean(2), 0.3, 1), 0).unwrap().snapshot().is_some());
    assert!(Snes::new(SnesConfig::new(mean(2), 0.3), 0).unwrap().snapshot().is_some());
    assert!(Xnes::new(XnesConfig::new(mean(2), 0.3), 0).unwrap().snapshot().is_some());
}

/// Feeds extreme fitness and checks that the state stays finite and can be saved.
fn survives<S>(mut strategy: S, mut restored: S, values: &[f64])
where
    S: Strategy<f64> + Snapshot + PartialEq + std::fmt::Debug,
{
    let mut values = values.iter().copied().cycle();
    for _ in 0..30 {
        let fitness: Vec<f64> = (0..strategy.ask().len()).map(|_| values.next().unwrap()).collect();
        strategy.tell_values(&fitness).unwrap();
        assert!(strategy.ask().as_slice().iter().all(|gene| gene.is_finite()), "{strategy:?}");
        assert!(strategy.diagnostics().iter().all(|number| number.is_finite()), "{strategy:?}");
        restored.restore(&strategy.save()).unwrap();
        assert_eq!(restored, strategy);
    }
}

/// Selection that always drives in one direction, up to the limits of `f64`.
fn driven<S>(mut strategy: S, mut restored: S, away: bool)
where
    S: Strategy<f64> + Snapshot + PartialEq + std::fmt::Debug,
{
    for _ in 0..60 {
        let sign = if away { 1.0 } else { -1.0 };
        let fitness: Vec<f64> = strategy.ask().iter().map(|x| sign * x.iter().map(|x| x.abs()).sum::<f64>()).collect();
        strategy.tell_values(&fitness).unwrap();
        assert!(strategy.ask().as_slice().iter().all(|gene| gene.is_finite()));
    }
    restored.restore(&strategy.save()).unwrap();
    assert_eq!(restored, strategy);
}

fn any_value() -> impl Generator<Value = f64> {
    prop_oneof![
        3 => -10.0..10.0f64,
        1 => Just(f64::NAN),
        1 => Just(f64::NEG_INFINITY),
        1 => Just(f64::INFINITY),
        1 => Just(f64::MAX),
        1 => Just(-f64::MAX),
        1 => Just(1e-310),
    ]
}

/// A positive size of any magnitude.
fn any_size() -> impl Generator<Value = f64> {
    prop_oneof![4 => 0.01..2.0f64, 1 => Just(1e-100), 1 => Just(1e100), 1 => 1e-9..1e9f64]
}

fn any_mean() -> impl Generator<Value = Vec<f64>> {
    prop::collection::vec(prop_oneof![4 => -2.0..2.0f64, 1 => Just(1e100), 1 => Just(-1e100)], 1..6)
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(96))]

    #[test]
    fn natural_evolution_strategies_stay_finite(
        mean in any_mean(), sigma in any_size(), population in 2..9usize,
        rates in [0.0..=10.0f64, 0.0..=10.0, 0.0..=10.0],
        values in prop::collection::vec(any_value(), 1..40), seed: u64, away: bool,
    ) {
        let config = SnesConfig {
            population, mean_learning_rate: rates[0], sigma_learning_rate: rates[1],
            ..SnesConfig::new(mean.clone(), sigma)
        };
        let fresh = || Snes::new(config.clone(), seed).unwrap();
        survives(fresh(), fresh(), &values);
        driven(fresh(), fresh(), away);
        let config = XnesConfig {
            population, mean_learning_rate: rates[0], sigma_learning_rate: rates[1], shape_learning_rate: rates[2],
            ..XnesConfig::new(mean, sigma)
        };
        let fresh = || Xnes::new(config.clone(), seed).unwrap();
        survives(fresh(), fresh(), &values);
        driven(fresh(), fresh(), away);
    }

    #[test]
    fn mirrored_strategies_stay_finite(
        mean in any_mean(), sizes in [any_size(), any_size(), any_size()], pairs in 1..6usize,
        decays in [0.0..1.0f64, 0.0..1.0], rate in 0.0..=10.0f64,
        weight_decay in prop_oneof![0.0..1.0f64, Just(1e9)],
        values in prop::collection::vec(any_value(), 1..40), seed: u64, choice: bool, away: bool,
    ) {
        let adam = Optimizer::Adam { first_decay: decays[0], second_decay: decays[1], epsilon: sizes[2] };
        let optimizer = if choice { adam } else { Optimizer::Momentum { momentum: decays[0] } };
        let config = OpenAiEsConfig {
            mean: mean.clone(), pairs, sigma: sizes[0], learning_rate: sizes[1], weight_decay, optimizer,
        };
        let fresh = || OpenAiEs::new(config.clone(), seed).unwrap();
        survives(fresh(), fresh(), &values);
        driven(fresh(), fresh(), away);
        let config = PgpeConfig {
            step_size: sizes[1], max_speed: sizes[2], momentum: decays[0], sigma_learning_rate: rate,
            sigma_max_change: decays[1], fitness: if choice { PgpeFitness::Raw } else { PgpeFitness::CenteredRanks },
            ..PgpeConfig::new(mean.clone(), sizes[0], pairs)
        };
        let fresh = || Pgpe::new(config.clone(), seed).unwrap();
        survives(fresh(), fresh(), &values);
        driven(fresh(), fresh(), away);
        let top_directions = if choice { pairs } else { 1 };
        let config = ArsConfig { mean, directions: pairs, top_directions, step_size: sizes[0], noise: sizes[1] };
        let fresh = || Ars::new(config.clone(), seed).unwrap();
        survives(fresh(), fresh(), &values);
        driven(fresh(), fresh(), away);
    }
}

/// With raw fitness, a generation without comparable individuals changes only the noise.
#[test]
fn failures_alone_move_nothing_by_value() {
    let mut ars = Ars::new(ArsConfig::new(mean(3), 4), 1).unwrap();
    let config = PgpeConfig { fitness: PgpeFitness::Raw, ..PgpeConfig::new(mean(3), 0.3, 4) };
    let mut pgpe = Pgpe::new(config, 1).unwrap();
    for _ in 0..3 {
        ars.tell(&[Fitness::WORST; 8]).unwrap();
        pgpe.tell(&[Fitness::WORST; 8]).unwrap();
    }
    ars.tell_values(&[2.5; 8]).unwrap();
    assert_eq!(ars.mean(), mean(3));
    assert_eq!((pgpe.mean(), pgpe.sigmas()), (&mean(3)[..], &[0.3; 3][..]));
}
