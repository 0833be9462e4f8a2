//! Restarts of covariance matrix adaptation: the schedule of the runs, and their results.

use crate::errors;
use farsa_evo::covariance::{CmaEs, CmaEsConfig, CmaEsRestarts, CmaEsRestartsConfig, RestartSchedule};
use farsa_evo::{EvoError, Fitness, Snapshot, Strategy, check_strategy};
use farsa_num::{Digest, sin_cos};
use proptest::prelude::*;

fn config(mean: f64, genes: usize, sigma: f64, schedule: RestartSchedule) -> CmaEsRestartsConfig {
    CmaEsRestartsConfig::new(CmaEsConfig::new(vec![mean; genes], sigma), schedule)
}

/// Many local optima, the global one at 0.
fn rastrigin(x: &[f64]) -> f64 {
    x.iter().map(|x| x * x - 10.0 * sin_cos(core::f64::consts::TAU * x).1 + 10.0).sum()
}

fn tell(search: &mut impl Strategy<f64>, function: fn(&[f64]) -> f64) -> f64 {
    let values: Vec<f64> = search.ask().iter().map(|x| -function(x)).collect();
    search.tell_values(&values).unwrap();
    values.into_iter().fold(f64::NEG_INFINITY, f64::max)
}

/// Counts the generations until the function is below 10^-8.
fn generations(search: &mut impl Strategy<f64>, limit: usize) -> Option<usize> {
    (0..limit).find(|_| tell(search, rastrigin) > -1e-8)
}

#[test]
fn restarts_find_what_one_run_misses() {
    for seed in 0..5 {
        let single = CmaEsConfig::new(vec![3.0; 5], 1.0);
        assert_eq!(generations(&mut CmaEs::new(single, seed).unwrap(), 2000), None);
        for schedule in [RestartSchedule::Ipop, RestartSchedule::Bipop] {
            let mut search = CmaEsRestarts::new(config(3.0, 5, 1.0, schedule), seed).unwrap();
            let solved = generations(&mut search, 20_000);
            assert!(solved.is_some() && search.run() > 0, "{schedule:?}, seed {seed}");
        }
    }
}

#[test]
fn a_step_size_begins_as_given_and_falls_towards_an_optimum() {
    let mut search = CmaEsRestarts::new(config(3.0, 4, 0.7, RestartSchedule::Ipop), 1).unwrap();
    assert_eq!(search.sigma(), 0.7);
    for _ in 0..100 {
        tell(&mut search, |x| x.iter().map(|x| x * x).sum());
    }
    assert!(search.run() == 0 && search.sigma() < 1e-3, "{}", search.sigma());
}

/// Small runs draw their step size between a hundredth of the first and the first, uniformly in its logarithm
/// [Hansen2009].
#[test]
fn small_runs_begin_with_small_step_sizes() {
    let mut small = vec![];
    for seed in 1..5 {
        let mut search = CmaEsRestarts::new(config(3.0, 4, 1.0, RestartSchedule::Bipop), seed).unwrap();
        let mut run = 0;
        for _ in 0..8000 {
            tell(&mut search, rastrigin);
            if search.run() != run {
                run = search.run();
                small.push(search.sigma());
            }
        }
    }
    small.retain(|sigma| *sigma != 1.0);
    let magnitude = small.iter().map(|sigma| farsa_num::ln(*sigma)).sum::<f64>() / small.len() as f64;
    println!("{} small runs begin with e^{magnitude} in the geometric mean", small.len());
    assert!(small.len() > 20 && small.iter().all(|sigma| (0.01..1.0).contains(sigma)), "{small:?}");
    // The expected mean is ln 0.1. A mean over this number of runs is within 0.8 of it.
    assert!((magnitude + std::f64::consts::LN_10).abs() < 0.8, "{magnitude}");
}

/// Returns the individuals of each run and its evaluated blocks.
fn runs(schedule: RestartSchedule, seed: u64, generations: u32) -> Vec<(usize, u32)> {
    let mut search = CmaEsRestarts::new(config(3.0, 4, 1.0, schedule), seed).unwrap();
    let mut runs = vec![];
    for _ in 0..generations {
        if runs.len() <= search.run() as usize {
            runs.push((search.individuals(), 0));
        }
        runs.last_mut().unwrap().1 += 1;
        tell(&mut search, rastrigin);
    }
    runs
}

#[test]
fn runs_have_the_sizes_of_their_schedule() {
    let sizes: Vec<usize> = runs(RestartSchedule::Ipop, 1, 4000).into_iter().map(|(size, _)| size).collect();
    assert_eq!(sizes[..4], [8, 16, 32, 64]);
    for seed in 1..5 {
        let runs = runs(RestartSchedule::Bipop, seed, 8000);
        let (mut large, mut spent, mut latest) = (8, [0, 0], runs[0].1);
        for (size, blocks) in &runs[1..runs.len() - 1] {
            let small = spent[1] < spent[0];
            if small {
                assert!((8..=(large / 2).max(8)).contains(size), "{runs:?}");
                // A small run ends with the generation in which it has spent half the budget of the latest large run.
                assert!(*blocks < latest / 2 + *size as u32 / 8, "{runs:?}");
            } else {
                large *= 2;
                assert_eq!(*size, large, "{runs:?}");
                latest = *blocks;
            }
            spent[usize::from(small)] += blocks;
        }
        assert!(large >= 32 && runs.len() > 8, "{runs:?}");
    }
}

#[test]
fn the_first_run_equals_plain_cma_es() {
    let restarts = config(3.0, 4, 1.0, RestartSchedule::Ipop);
    let mut alone = CmaEs::new(restarts.first.clone(), 7).unwrap();
    let mut search = CmaEsRestarts::new(restarts, 7).unwrap();
    while search.run() == 0 {
        assert_eq!(search.ask(), alone.ask());
        tell(&mut alone, rastrigin);
        tell(&mut search, rastrigin);
    }
    assert!((40..1000).contains(&search.generation()), "{}", search.generation());
    assert_ne!(search.ask(), alone.ask());
}

#[test]
fn it_conforms() {
    for schedule in [RestartSchedule::Ipop, RestartSchedule::Bipop] {
        check_strategy(|| CmaEsRestarts::new(config(0.0, 3, 1.0, schedule), 3), 22).unwrap();
        // The steps are so small that a run ends with its first generation, with runs of 1, 2, 4 ... blocks.
        check_strategy(|| CmaEsRestarts::new(config(1e6, 2, 1e-12, schedule), 3), 80).unwrap();
    }
}

#[test]
fn impossible_configurations_are_refused() {
    let refused = |change: fn(&mut CmaEsRestartsConfig)| {
        let mut config = config(0.0, 4, 1.0, RestartSchedule::Bipop);
        change(&mut config);
        CmaEsRestarts::new(config, 0).unwrap_err()
    };
    assert_eq!(refused(|c| c.first.mean.clear()), errors::no_genes());
    assert_eq!(refused(|c| c.spread = -1.0).to_string(), "spread is -1, where 0 to 1e100 is possible");
    // The largest run has 512 times as many individuals.
    let population = 512 * 1_000_000;
    assert_eq!(refused(|c| c.first.population = 1_000_000), errors::too_large(population, 4));
}

#[test]
fn refused_states_change_nothing() {
    let mut search = CmaEsRestarts::new(config(1e6, 2, 1e-12, RestartSchedule::Ipop), 3).unwrap();
    while search.individuals() < 48 {
        tell(&mut search, rastrigin);
    }
    tell(&mut search, rastrigin);
    let (before, state) = (search.clone(), search.save());
    // Generation, large, number, blocks, kind, iterations, block, history, then sigma of the run.
    for (place, wrong) in
        [(4, 3), (4, 1024), (12, 0), (12, 513), (16, 2), (24, 8), (24, u32::MAX), (28, 5), (28, u32::MAX)]
    {
        let mut state = state.clone();
        state[place..place + 4].copy_from_slice(&wrong.to_le_bytes());
        assert!(matches!(search.restore(&state), Err(EvoError::State { .. })), "{place}: {wrong}");
        assert_eq!(search, before);
    }
    for wrong in [0.0, f64::NAN, -1.0] {
        let mut state = state.clone();
        state[72..80].copy_from_slice(&f64::to_le_bytes(wrong));
        assert!(matches!(search.restore(&state), Err(EvoError::State { .. })), "{wrong}");
        assert_eq!(search, before);
    }
    search.restore(&state).unwrap();
    assert_eq!(search, before);
}

#[test]
fn the_bits_stay_as_they_are() {
    let mut digests = [0; 2];
    for (digest, schedule) in digests.iter_mut().zip([RestartSchedule::Ipop, RestartSchedule::Bipop]) {
        let mut search = CmaEsRestarts::new(config(3.0, 3, 1.0, schedule), 2005).unwrap();
        let mut bits = Digest::new();
        for _ in 0..1000 {
            bits.add_u64(search.ask().digest());
            tell(&mut search, rastrigin);
        }
        *digest = bits.finish();
    }
    assert_eq!(digests, [0x96ea_864f_43b0_7c4d, 0xa69a_1894_9be6_0625], "{digests:#018x?}");
}

proptest! {
    #![proptest_config(ProptestConfig { failure_persistence: None, ..ProptestConfig::default() })]

    #[test]
    fn genes_stay_finite(
        genes in 1..5_usize, exponent in -99..99_i32, seed: u64, bipop: bool,
        reported in proptest::collection::vec(prop_oneof![any::<f64>(), Just(f64::NAN), -1.0..1.0_f64], 60),
    ) {
        let sigma = farsa_num::exp(f64::from(exponent) * core::f64::consts::LN_10);
        let schedule = if bipop { RestartSchedule::Bipop } else { RestartSchedule::Ipop };
        let mut search = CmaEsRestarts::new(config(1.0, genes, sigma, schedule), seed).unwrap();
        for generation in 0..120 {
            let reported = reported.iter().cycle().skip(generation).step_by(1 + generation % 7);
            let fitness: Vec<Fitness> = reported.take(search.ask().len()).map(|x| Fitness::nan_as_failed(*x)).collect();
            search.tell(&fitness).unwrap();
            prop_assert!(search.ask().as_slice().iter().chain(&search.diagnostics()).all(|x| x.is_finite()));
            let mut again = search.clone();
            prop_assert_eq!(again.restore(&search.save()), Ok(()));
            prop_assert_eq!(&again, &search);
        }
    }
}
