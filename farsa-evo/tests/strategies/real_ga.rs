//! The generational genetic algorithm over reals, compared with a transcription of its sources, on test functions and by
//! digests.

#![allow(clippy::disallowed_methods)]

use crate::errors;
use farsa_evo::real::{Crossover, RealGa, RealGaConfig, RealMutation, Selection};
use farsa_evo::{EvoError, Fitness, Snapshot, Strategy, check_strategy};
use farsa_num::{Domain, Stream};
use proptest::prelude::*;

const ADAPTIVE: RealMutation = RealMutation::SelfAdaptive { rate: 0.8, initial: 0.2, tau: 0.4, smallest: 1e-9 };

fn sphere(genes: &[f64]) -> f64 {
    -genes.iter().map(|x| (x - 0.5) * (x - 0.5)).sum::<f64>()
}

/// Condition 10^4: the last axis is a hundred times as steep as the first.
fn ellipsoid(genes: &[f64]) -> f64 {
    let last = genes.len().max(2) - 1;
    -genes.iter().enumerate().map(|(i, x)| 1e4_f64.powf(i as f64 / last as f64) * x * x).sum::<f64>()
}

fn rosenbrock(genes: &[f64]) -> f64 {
    let square = |x: f64| x * x;
    -genes.windows(2).map(|x| 100.0 * square(x[1] - x[0] * x[0]) + square(1.0 - x[0])).sum::<f64>()
}

fn config(selection: Selection, crossover: Crossover, mutation: RealMutation) -> RealGaConfig {
    let bounds = vec![[-5.0, 5.0], [0.0, 1.0], [2.0, 2.0], [-1.0, 3.0], [-5.0, 0.0]];
    let rate_factors = vec![1.0, 0.5, 1.0, 2.0, 0.0];
    let base = RealGaConfig::new(bounds);
    RealGaConfig { population: 24, elites: 2, selection, crossover, mutation, rate_factors, ..base }
}

/// Every option at least once.
fn configs() -> [RealGaConfig; 4] {
    let gaussian = RealMutation::Gaussian { rate: 0.4, sigma: 0.1 };
    [
        config(Selection::Tournament { size: 3 }, Crossover::SimulatedBinary { eta: 2.0 }, gaussian),
        config(Selection::Rank { pressure: 1.7 }, Crossover::Blend { alpha: 0.5 }, ADAPTIVE),
        config(Selection::Truncation { parents: 6 }, Crossover::Uniform { rate: 0.3 }, gaussian),
        RealGaConfig { elites: 0, ..config(Selection::Rank { pressure: 2.0 }, Crossover::None, ADAPTIVE) },
    ]
}

#[test]
fn it_conforms() {
    for config in configs() {
        check_strategy(|| RealGa::new(config.clone(), 7), 40).unwrap();
    }
    let alone = RealGaConfig { population: 1, elites: 0, ..RealGaConfig::new(vec![[0.0, 1.0]]) };
    let alone = RealGaConfig { selection: Selection::Rank { pressure: 2.0 }, ..alone };
    check_strategy(|| RealGa::new(alone.clone(), 7), 20).unwrap();
}

/// Draws the rank of a parent, as the sources describe it.
fn rank(selection: Selection, n: usize, stream: &mut Stream) -> usize {
    match selection {
        Selection::Tournament { size } => (0..size).map(|_| stream.below(n as u32) as usize).min().unwrap(),
        Selection::Truncation { parents } => stream.below(parents as u32) as usize,
        Selection::Rank { pressure: s } => {
            let (ball, mut sum) = (stream.uniform_f64(), 0.0);
            for i in 0..n {
                sum += (s - 2.0 * (s - 1.0) * i as f64 / (n - 1) as f64) / n as f64;
                if ball < sum {
                    return i;
                }
            }
            n - 1
        }
    }
}

fn mirrored(mut x: f64, [low, high]: [f64; 2]) -> f64 {
    while low < high && !(low..=high).contains(&x) {
        x = if x < low { 2.0 * low - x } else { 2.0 * high - x };
    }
    x
}

/// SBX as `realcross` of Deb's NSGA-II has it, for one gene of one child.
fn deb(a: f64, b: f64, [yl, yu]: [f64; 2], eta: f64, stream: &mut Stream) -> f64 {
    if stream.uniform_f64() >= 0.5 || (a - b).abs() <= 1e-14 * (yu - yl) {
        return a;
    }
    let (y1, y2) = if a < b { (a, b) } else { (b, a) };
    let rand = stream.uniform_f64();
    let child = |beta: f64, sign: f64| {
        let alpha = 2.0 - beta.powf(-(eta + 1.0));
        let betaq = if rand <= 1.0 / alpha { rand * alpha } else { 1.0 / (2.0 - rand * alpha) }.powf(1.0 / (eta + 1.0));
        (0.5 * ((y1 + y2) + sign * betaq * (y2 - y1))).clamp(yl, yu)
    };
    let c1 = child(1.0 + 2.0 * (y1 - yl) / (y2 - y1), -1.0);
    let c2 = child(1.0 + 2.0 * (yu - y2) / (y2 - y1), 1.0);
    if stream.uniform_f64() < 0.5 { c2 } else { c1 }
}

/// Returns the genes and the step size of a child.
fn child(config: &RealGaConfig, ranked: &[(Vec<f64>, f64)], mut stream: Stream) -> (Vec<f64>, f64) {
    let stream = &mut stream;
    let (mut genes, mut step) = ranked[rank(config.selection, ranked.len(), stream)].clone();
    if config.crossover != Crossover::None && stream.uniform_f64() < config.crossover_rate {
        let partner = &ranked[rank(config.selection, ranked.len(), stream)].0;
        for (i, range) in config.bounds.iter().enumerate() {
            let (a, b) = (genes[i], partner[i]);
            genes[i] = match config.crossover {
                Crossover::None => a,
                Crossover::Uniform { rate } => [a, b][usize::from(stream.uniform_f64() < rate)],
                Crossover::Blend { alpha } => {
                    let (low, width) = (a.min(b), (a - b).abs());
                    mirrored(low - alpha * width + (1.0 + 2.0 * alpha) * width * stream.uniform_f64(), *range)
                }
                Crossover::SimulatedBinary { eta } => deb(a, b, *range, eta, stream),
            };
        }
    }
    let rate = match config.mutation {
        RealMutation::Gaussian { rate, sigma } => {
            step = sigma;
            rate
        }
        RealMutation::SelfAdaptive { rate, tau, smallest, .. } => {
            step = (step * (tau * stream.normal_pair_f64()[0]).exp()).clamp(smallest, 1.0);
            rate
        }
    };
    for (i, range) in config.bounds.iter().enumerate() {
        if stream.uniform_f64() < rate * config.rate_factors[i] {
            genes[i] = mirrored(genes[i] + step * (range[1] - range[0]) * stream.normal_pair_f64()[0], *range);
        }
    }
    (genes, step)
}

#[test]
fn generations_are_those_of_a_transcription() {
    for config in configs() {
        let mut search = RealGa::new(config.clone(), 11).unwrap();
        let mut naive: Vec<(Vec<f64>, f64)> =
            search.ask().iter().zip(search.step_sizes()).map(|(genes, step)| (genes.to_vec(), *step)).collect();
        for generation in 1..8 {
            let values: Vec<f64> = search.ask().iter().map(sphere).collect();
            search.tell_values(&values).unwrap();
            let mut order: Vec<usize> = (0..naive.len()).collect();
            order.sort_by(|a, b| values[*b].total_cmp(&values[*a]));
            let ranked: Vec<_> = order.iter().map(|i| naive[*i].clone()).collect();
            let made = |i: usize| {
                let stream = Stream::new(11, Domain::Mutation, 0, i as u32, generation);
                if i < config.elites { ranked[i].clone() } else { child(&config, &ranked, stream) }
            };
            naive = (0..ranked.len()).map(made).collect();
            let mean = naive.iter().map(|(_, step)| step).sum::<f64>() / naive.len() as f64;
            let [said] = search.diagnostics()[..] else { panic!("says one number") };
            assert!((said - mean).abs() <= 1e-12 * mean, "{said} {mean}");
            for (i, (genes, step)) in naive.iter().enumerate() {
                assert!((search.step_sizes()[i] - step).abs() <= 1e-12 * step);
                for (got, want) in search.ask().get(i).unwrap().iter().zip(genes) {
                    assert!((got - want).abs() <= 1e-12 * want.abs().max(1.0), "{generation} {i}: {got} {want}");
                }
            }
        }
    }
}

#[test]
fn parents_are_named() {
    let [config, ..] = configs();
    let mut search = RealGa::new(config, 3).unwrap();
    let parents = |search: &RealGa, i| search.genealogy().unwrap().parents_of(i);
    assert!((0..30).all(|i| parents(&search, i).is_empty()));
    let values: Vec<f64> = (0..24).map(|i| f64::from((i * 7) % 24)).collect();
    search.tell_values(&values).unwrap();
    // 17 * 7 = 119 = 4 * 24 + 23, and 10 * 7 = 70 = 2 * 24 + 22.
    assert_eq!([0, 1].map(|i| parents(&search, i)), [[17], [10]]);
    assert!((2..24).all(|i| (1..=2).contains(&parents(&search, i).len())));
    assert!((2..24).any(|i| parents(&search, i).len() == 2) && parents(&search, 24).is_empty());
}

/// Ten genes and 30 000 evaluations with a population of 100. Rosenbrock has four genes and 100 000 evaluations.
#[test]
fn it_converges() {
    let base = |genes| RealGaConfig::new(vec![[-5.0, 5.0]; genes]);
    let adaptive = RealMutation::SelfAdaptive { rate: 1.0, initial: 0.1, tau: 0.32, smallest: 1e-12 };
    for config in [base(10), RealGaConfig { mutation: adaptive, crossover_rate: 0.5, ..base(10) }] {
        let reached = [sphere as fn(&[f64]) -> f64, ellipsoid]
            .map(|function| RealGa::new(config.clone(), 5).unwrap().maximize(300, function).unwrap().fitness.get());
        // The best of the first generation is about -30 and -50 000.
        assert!(reached[0] > -0.01 && reached[1] > -2.0, "{reached:?}");
    }
    let best = RealGa::new(base(4), 5).unwrap().maximize(1000, rosenbrock).unwrap();
    assert!(best.fitness.get() > -1.0, "{:?}", best.fitness);
}

#[test]
fn it_keeps_its_bits() {
    let got = configs().map(|config| {
        let mut search = RealGa::new(config, 2010).unwrap();
        search.maximize(50, rosenbrock).unwrap();
        search.ask().digest()
    });
    let want = [0x3a2e_7326_9cf2_a892, 0xb7d3_c9e4_9a78_2284, 0x9c66_10af_c7ab_b2ce, 0x92f6_ea20_e030_9774];
    assert_eq!(got, want, "{got:#018x?}");
}

#[test]
fn impossible_configurations_are_refused() {
    let refused = |change: &dyn Fn(&mut RealGaConfig)| {
        let mut config = RealGaConfig::new(vec![[0.0, 1.0]; 3]);
        change(&mut config);
        match RealGa::new(config, 0).unwrap_err() {
            EvoError::OutOfRange { field, value, .. } => (field, value),
            other => panic!("{other}"),
        }
    };
    assert_eq!(refused(&|c| c.bounds[1] = [2.0, 1.0]), ("the high end of a gene", 1.0));
    assert_eq!(refused(&|c| c.bounds[1][0] = f64::NEG_INFINITY), ("the low end of a gene", f64::NEG_INFINITY));
    assert_eq!(refused(&|c| c.elites = 100), ("the number of elites", 100.0));
    assert_eq!(refused(&|c| c.crossover_rate = 1.1), ("the crossover rate", 1.1));
    assert_eq!(refused(&|c| c.rate_factors = vec![1.0]), ("the number of rate factors", 1.0));
    assert_eq!(refused(&|c| c.rate_factors = vec![1.0, -2.0, 1.0]), ("a rate factor", -2.0));
    assert_eq!(refused(&|c| c.selection = Selection::Tournament { size: 0 }), ("the size of a tournament", 0.0));
    assert_eq!(refused(&|c| c.selection = Selection::Truncation { parents: 101 }), ("the number of parents", 101.0));
    assert_eq!(refused(&|c| c.selection = Selection::Rank { pressure: 2.5 }), ("the selection pressure", 2.5));
    assert_eq!(refused(&|c| c.crossover = Crossover::Blend { alpha: -1.0 }), ("alpha of blend crossover", -1.0));
    let eta = ("eta of simulated binary crossover", -1.0);
    assert_eq!(refused(&|c| c.crossover = Crossover::SimulatedBinary { eta: -1.0 }), eta);
    let mutation = RealMutation::Gaussian { rate: 0.1, sigma: 2.0 };
    assert_eq!(refused(&|c| c.mutation = mutation), ("sigma of mutation", 2.0));
    let mutation = RealMutation::SelfAdaptive { rate: 0.1, initial: 0.1, tau: 0.1, smallest: 0.0 };
    assert_eq!(refused(&|c| c.mutation = mutation), ("the smallest step size", 0.0));
    assert_eq!(RealGa::new(RealGaConfig::new(Vec::new()), 0).unwrap_err(), errors::no_genes());
    let nobody = RealGaConfig { population: 0, ..RealGaConfig::new(vec![[0.0, 1.0]]) };
    assert_eq!(RealGa::new(nobody, 0).unwrap_err(), errors::no_individuals());
}

#[test]
fn a_damaged_state_is_refused() {
    let [_, config, ..] = configs();
    let mut search = RealGa::new(config.clone(), 3).unwrap();
    search.tell_values(&[0.0; 24]).unwrap();
    let before = search.clone();
    let state = search.snapshot().unwrap().save();
    // Positions of a parent, a step size and a gene.
    for at in [4, 4 + 8 * 24, 4 + 16 * 24 + 8] {
        let mut damaged = state.clone();
        damaged[at..at + 8].copy_from_slice(&1e9_f64.to_le_bytes());
        damaged[at..at + 4].fill(0xff);
        assert!(search.snapshot().unwrap().restore(&damaged).is_err(), "{at}");
        assert_eq!(search, before);
    }
    // A step size below the minimum.
    let RealMutation::SelfAdaptive { smallest, .. } = config.mutation else { panic!("adapts no step sizes") };
    for (step, possible) in [(smallest, true), (smallest.next_down(), false), (-smallest, false)] {
        let mut state = state.clone();
        state[4 + 8 * 24..][..8].copy_from_slice(&step.to_le_bytes());
        assert_eq!(before.clone().restore(&state).is_ok(), possible, "{step}");
    }
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(64))]
    #[test]
    fn genes_stay_within_bounds(
        seed: u64,
        which in 0_usize..4,
        tau in 0.0_f64..10.0,
        ends in proptest::array::uniform2(-1e100_f64..1e100),
        reported in proptest::collection::vec(proptest::num::f64::ANY, 24),
    ) {
        let mut config = configs()[which].clone();
        config.bounds[0] = [ends[0].min(ends[1]), ends[0].max(ends[1])];
        if let RealMutation::SelfAdaptive { tau: rate, .. } = &mut config.mutation {
            *rate = tau;
        }
        let bounds = config.bounds.clone();
        let mut search = RealGa::new(config, seed).unwrap();
        for _ in 0..10 {
            search.tell(&reported.iter().copied().map(Fitness::nan_as_failed).collect::<Vec<_>>()).unwrap();
            for genes in search.ask() {
                prop_assert!(genes.iter().zip(&bounds).all(|(gene, [low, high])| low <= gene && gene <= high));
            }
        }
    }
}
