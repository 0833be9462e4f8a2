//! Evolution strategies, compared with a transcription of their source, on test functions and by digests.

#![allow(clippy::disallowed_methods)]

use crate::errors;
use farsa_evo::real::{EvolutionStrategy, EvolutionStrategyConfig, Recombination, StepSizes, Survival};
use farsa_evo::{EvoError, Fitness, Record, Strategy, check_strategy};
use farsa_num::{Domain, Stream};
use proptest::prelude::*;

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

type Mixing = (Recombination, Recombination, usize);

fn config(
    survival: Survival,
    (recombination, step_recombination, mixing): Mixing,
    step_sizes: StepSizes,
) -> EvolutionStrategyConfig {
    let base = EvolutionStrategyConfig::new(vec![1.0, -2.0, 0.0, 3.0], 0.5);
    let (parents, offspring) = (5, 20);
    EvolutionStrategyConfig {
        parents,
        offspring,
        mixing,
        survival,
        recombination,
        step_recombination,
        step_sizes,
        ..base
    }
}

/// Every option at least once, with four genes.
fn configs() -> [EvolutionStrategyConfig; 5] {
    use Recombination::{Discrete, Intermediate, None};
    let (shared, per_gene) = (StepSizes::one(4), StepSizes::per_gene(4));
    [
        config(Survival::Comma, (Discrete, Intermediate, 5), per_gene),
        config(Survival::Comma, (Intermediate, Intermediate, 3), shared),
        config(Survival::Plus, (Intermediate, Discrete, 2), per_gene),
        config(Survival::Plus, (None, None, 1), shared),
        config(Survival::PlusEvaluatedAgain, (Discrete, None, 4), per_gene),
    ]
}

#[test]
fn it_conforms() {
    for config in configs() {
        check_strategy(|| EvolutionStrategy::new(config.clone(), 7), 40).unwrap();
    }
    let [.., last] = configs();
    let single = EvolutionStrategyConfig { parents: 1, offspring: 1, mixing: 1, survival: Survival::Plus, ..last };
    check_strategy(|| EvolutionStrategy::new(single.clone(), 7), 20).unwrap();
}

#[test]
fn learning_rates_fall_with_the_number_of_genes() {
    assert_eq!(StepSizes::one(16), StepSizes::One { tau: 0.25 });
    let StepSizes::PerGene { tau_0, tau } = StepSizes::per_gene(16) else { panic!("one step size") };
    assert!((tau_0 - 1.0 / 32.0_f64.sqrt()).abs() < 1e-15 && (tau - 1.0 / 8.0_f64.sqrt()).abs() < 1e-15);
}

#[derive(Clone)]
struct Naive {
    genes: Vec<f64>,
    steps: Vec<f64>,
    fitness: f64,
}

/// Recombines one row of a child, as the source describes it.
fn mixed(how: Recombination, rows: &[&Vec<f64>], stream: &mut Stream) -> Vec<f64> {
    let width = rows[0].len();
    match how {
        Recombination::None => rows[0].clone(),
        Recombination::Discrete => (0..width).map(|i| rows[stream.below(rows.len() as u32) as usize][i]).collect(),
        Recombination::Intermediate => {
            (0..width).map(|i| rows.iter().map(|row| row[i]).sum::<f64>() / rows.len() as f64).collect()
        }
    }
}

fn child(config: &EvolutionStrategyConfig, parents: &[Naive], mut stream: Stream) -> Naive {
    let stream = &mut stream;
    let mut drawn: Vec<&Naive> = parents.iter().collect();
    for slot in 0..config.mixing {
        let partner = slot + stream.below((drawn.len() - slot) as u32) as usize;
        drawn.swap(slot, partner);
    }
    drawn.truncate(config.mixing);
    let logarithms: Vec<Vec<f64>> = drawn.iter().map(|p| p.steps.iter().map(|step| step.ln()).collect()).collect();
    let steps = mixed(config.step_recombination, &logarithms.iter().collect::<Vec<_>>(), stream);
    let steps: Vec<f64> = steps.into_iter().map(f64::exp).collect();
    let genes = mixed(config.recombination, &drawn.iter().map(|p| &p.genes).collect::<Vec<_>>(), stream);
    let n = genes.len();
    let (steps, normal): (Vec<f64>, Vec<f64>) = match config.step_sizes {
        StepSizes::One { tau } => {
            let mut z = vec![0.0; 1 + n];
            stream.fill_normal(&mut z);
            (vec![steps[0] * (tau * z[0]).exp()], z[1..].to_vec())
        }
        StepSizes::PerGene { tau_0, tau } => {
            let mut z = vec![0.0; 1 + 2 * n];
            stream.fill_normal(&mut z);
            let step = |i: usize| steps[i] * (tau_0 * z[0]).exp() * (tau * z[1 + i]).exp();
            ((0..n).map(step).collect(), z[1 + n..].to_vec())
        }
    };
    let sigma = |i: usize| steps[if steps.len() == 1 { 0 } else { i }];
    let genes = (0..n).map(|i| genes[i] + sigma(i) * normal[i]).collect();
    Naive { genes, steps, fitness: f64::NAN }
}

#[test]
fn generations_are_those_of_a_transcription() {
    for config in configs() {
        let mut search = EvolutionStrategy::new(config.clone(), 11).unwrap();
        let width = search.step_sizes().len() / search.ask().len();
        let mut asked: Vec<Naive> = search
            .ask()
            .iter()
            .map(|genes| Naive { genes: genes.to_vec(), steps: vec![0.5; width], fitness: 0.0 })
            .collect();
        let mut parents: Vec<Naive> = Vec::new();
        for generation in 1..10 {
            // The landscape differs in every generation, which shows which parents are evaluated again.
            let judge = |genes: &[f64]| sphere(genes) * f64::from(1 + generation % 3);
            for one in &mut asked {
                one.fitness = judge(&one.genes);
            }
            let values: Vec<f64> = search.ask().iter().map(judge).collect();
            search.tell_values(&values).unwrap();
            let mut pool = if config.survival == Survival::Plus { parents } else { Vec::new() };
            pool.append(&mut asked);
            pool.sort_by(|a, b| b.fitness.total_cmp(&a.fitness));
            pool.truncate(config.parents);
            parents = pool;
            if config.survival == Survival::PlusEvaluatedAgain {
                asked.clone_from(&parents);
            }
            let stream = |i: u32| Stream::new(11, Domain::Mutation, 0, i, generation);
            asked.extend((0..20).map(|i| child(&config, &parents, stream(i))));
            let rows = search.ask().iter().zip(search.step_sizes().chunks(width));
            assert_eq!(rows.len(), asked.len());
            for ((genes, steps), naive) in rows.zip(&asked) {
                for (got, want) in genes.iter().zip(&naive.genes).chain(steps.iter().zip(&naive.steps)) {
                    assert!((got - want).abs() <= 1e-12 * want.abs().max(1.0), "{generation}: {got} {want}");
                }
            }
        }
    }
}

#[test]
fn surviving_parents_keep_their_fitness() {
    let [_, _, plus, ..] = configs();
    let mut search = EvolutionStrategy::new(plus, 3).unwrap();
    let values: Vec<f64> = (0..20).map(f64::from).collect();
    search.tell_values(&values).unwrap();
    let parents = |search: &EvolutionStrategy, i| search.genealogy().unwrap().parents_of(i);
    assert!((0..20).all(|i| parents(&search, i).len() == 2 && parents(&search, i).iter().all(|&p| p >= 15)));
    // One child is better than all parents. The others fail.
    let mut values = [f64::NAN; 20];
    values[7] = 30.0;
    search.tell_values(&values).unwrap();
    let survivors: Vec<f64> = search.parent_fitness().into_iter().map(Fitness::get).collect();
    assert_eq!(survivors, [30.0, 19.0, 18.0, 17.0, 16.0]);
    // The others are two generations old.
    assert!((0..20).all(|i| parents(&search, i).is_empty() || parents(&search, i) == [7]));
    assert!((0..20).any(|i| parents(&search, i) == [7]));
}

/// With the arithmetic mean of step sizes, their logarithm grows by about (1 - 1 / mu) (`tau_0^2` + `tau^2`) / 2 = 0.28 in
/// each generation without selection. With the geometric mean it is a random walk, \[Hansen2006\].
#[test]
fn without_selection_step_sizes_have_no_bias() {
    let mut change = 0.0;
    for seed in 0..40 {
        let mut search = EvolutionStrategy::new(EvolutionStrategyConfig::new(vec![0.0; 2], 1.0), seed).unwrap();
        for _ in 0..20 {
            search.tell_values(&[0.0; 100]).unwrap();
        }
        change += search.diagnostics()[0].ln() / 40.0;
    }
    // The deviation of the mean over seeds is sqrt(20 (tau_0^2 + tau^2) / 15 / 40) = 0.14, and a bias adds 5.6.
    assert!(change.abs() < 1.0, "{change}");
}

#[test]
fn steps_stay_within_their_limits() {
    let config = EvolutionStrategyConfig::new(vec![0.0; 3], 0.5);
    assert_eq!(config.largest_step, 5000.0);
    let config = EvolutionStrategyConfig {
        smallest_step: 0.4,
        largest_step: 0.6,
        step_sizes: StepSizes::One { tau: 5.0 },
        ..config
    };
    let mut search = EvolutionStrategy::new(config, 1).unwrap();
    for _ in 0..20 {
        search.tell_values(&[0.0; 100]).unwrap();
        assert!(search.step_sizes().iter().all(|step| (0.4..=0.6).contains(step)));
    }
    assert!([0.4, 0.6].iter().all(|limit| search.step_sizes().contains(limit)));
}

#[test]
fn a_record_rebuilds_it() {
    for config in configs() {
        let fresh = || EvolutionStrategy::new(config.clone(), 5).unwrap();
        let mut search = fresh();
        let mut record = Record::new(&mut search).unwrap();
        for _ in 0..30 {
            let values: Vec<Fitness> = search.ask().iter().map(|genes| Fitness::nan_as_failed(sphere(genes))).collect();
            record.tell(&mut search, &values).unwrap();
        }
        let mut again = fresh();
        record.rebuild(&mut again, 30).unwrap();
        assert_eq!(again, search);
    }
}

/// Ten genes with 30 000 evaluations for the sphere and 60 000 for the ellipsoid. Rosenbrock has four genes, 100 000
/// evaluations.
#[test]
fn it_converges() {
    let base = |genes| EvolutionStrategyConfig::new(vec![3.0; genes], 1.0);
    let best = |config, generations, function: fn(&[f64]) -> f64| {
        EvolutionStrategy::new(config, 5).unwrap().maximize(generations, function).unwrap().fitness.get()
    };
    for survival in [Survival::Comma, Survival::Plus, Survival::PlusEvaluatedAgain] {
        let config = EvolutionStrategyConfig { survival, ..base(10) };
        let shared = EvolutionStrategyConfig { step_sizes: StepSizes::one(10), ..config.clone() };
        let got = [best(config.clone(), 300, sphere), best(shared, 300, sphere), best(config, 600, ellipsoid)];
        assert!(got.iter().all(|fitness| *fitness > -1e-10), "{survival:?}: {got:?}");
    }
    let got = best(base(4), 1000, rosenbrock);
    // The mean has -10 812. In the valley the steps of single axes stay short.
    assert!(got > -0.5, "{got}");
}

#[test]
fn it_keeps_its_bits() {
    let got = configs().map(|config| {
        let mut search = EvolutionStrategy::new(config, 2010).unwrap();
        search.maximize(50, rosenbrock).unwrap();
        search.ask().digest()
    });
    let want = [
        0x66d5_99ce_15ac_d78d,
        0x48f3_ac79_400c_3e85,
        0x5803_4965_dda2_f935,
        0x71d4_5203_01d2_85c7,
        0x55d5_a28e_29b7_04ee,
    ];
    assert_eq!(got, want, "{got:#018x?}");
}

#[test]
fn impossible_configurations_are_refused() {
    let refused = |change: &dyn Fn(&mut EvolutionStrategyConfig)| {
        let mut config = EvolutionStrategyConfig::new(vec![0.0; 3], 1.0);
        change(&mut config);
        match EvolutionStrategy::new(config, 0).unwrap_err() {
            EvoError::OutOfRange { field, value, .. } => (field, value),
            other => panic!("{other}"),
        }
    };
    assert_eq!(refused(&|c| c.parents = 101), ("the number of parents", 101.0));
    assert_eq!(refused(&|c| c.mixing = 16), ("the mixing number", 16.0));
    assert_eq!(refused(&|c| c.mixing = 0), ("the mixing number", 0.0));
    assert_eq!(refused(&|c| c.mean[2] = f64::INFINITY), ("a mean", f64::INFINITY));
    assert_eq!(refused(&|c| c.initial_step = 0.0), ("the first step size", 0.0));
    assert_eq!(refused(&|c| c.smallest_step = 0.0), ("the smallest step size", 0.0));
    assert_eq!(refused(&|c| c.largest_step = 0.9), ("the largest step size", 0.9));
    assert_eq!(refused(&|c| c.largest_step = 1e101), ("the largest step size", 1e101));
    assert_eq!(refused(&|c| c.step_sizes = StepSizes::One { tau: -1.0 }), ("tau", -1.0));
    assert_eq!(refused(&|c| c.step_sizes = StepSizes::PerGene { tau_0: 11.0, tau: 1.0 }), ("tau_0", 11.0));
    let base = EvolutionStrategyConfig::new(vec![0.0; 3], 1.0);
    let nobody = EvolutionStrategyConfig { parents: 0, ..base.clone() };
    assert_eq!(EvolutionStrategy::new(nobody, 0).unwrap_err(), errors::no_parents());
    let many = EvolutionStrategyConfig { offspring: usize::MAX, ..base };
    assert_eq!(EvolutionStrategy::new(many, 0).unwrap_err(), errors::too_large(usize::MAX, 3));
}

#[test]
fn a_damaged_state_is_refused() {
    let [_, _, config, ..] = configs();
    let mut search = EvolutionStrategy::new(config, 3).unwrap();
    search.tell_values(&[0.0; 20]).unwrap();
    let before = search.clone();
    let state = search.snapshot().unwrap().save();
    let row = 8 * 8;
    let of_steps = 4 + 5 * (12 + row);
    // Positions of an origin, a fitness, a parent's step size and gene, a step size and a gene.
    let damages = [(4, 0xee), (8, 0xff), (16, 0xee), (48, 0x7f), (of_steps, 0xff), (state.len() - 8, 0x7e)];
    for (at, byte) in damages {
        let mut damaged = state.clone();
        damaged[at..at + 8].fill(byte);
        assert!(search.snapshot().unwrap().restore(&damaged).is_err(), "{at}");
        assert_eq!(search, before);
    }
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(64))]
    #[test]
    fn genes_stay_finite(
        seed: u64,
        which in 0_usize..5,
        rate in 0.0_f64..10.0,
        mean in -1e100_f64..1e100,
        power in -99_i32..=100,
        reported in proptest::collection::vec(proptest::num::f64::ANY, 25),
    ) {
        let mut config = configs()[which].clone();
        config.mean[0] = mean;
        (config.smallest_step, config.largest_step) = (1e-100, 1e100);
        config.initial_step = format!("1e{power}").parse().unwrap();
        config.step_sizes = match config.step_sizes {
            StepSizes::One { .. } => StepSizes::One { tau: rate },
            StepSizes::PerGene { .. } => StepSizes::PerGene { tau_0: rate, tau: rate },
        };
        let mut search = EvolutionStrategy::new(config, seed).unwrap();
        for _ in 0..30 {
            let count = search.ask().len();
            search.tell_values(&reported[..count]).unwrap();
            prop_assert!(search.ask().as_slice().iter().chain(search.step_sizes()).all(|x| x.is_finite()));
            let state = search.snapshot().unwrap().save();
            prop_assert_eq!(search.snapshot().unwrap().restore(&state), Ok(()));
        }
    }
}
