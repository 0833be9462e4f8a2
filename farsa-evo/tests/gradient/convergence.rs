//! Test functions are optimized from fixed seeds, within budgets of a few times the needed evaluations.

use std::f64::consts::LN_10;

use farsa_evo::Strategy;
use farsa_evo::gradient::{
    Ars, ArsConfig, OpenAiEs, OpenAiEsConfig, Optimizer, Pgpe, PgpeConfig, PgpeFitness, Snes, SnesConfig, Xnes,
    XnesConfig,
};
use farsa_num::exp;

fn sphere(x: &[f64]) -> f64 {
    -x.iter().map(|x| x * x).sum::<f64>()
}

/// The ellipsoid of condition 10^6 along the axes.
fn ellipsoid(x: &[f64]) -> f64 {
    let last = (x.len() - 1) as f64;
    -x.iter().enumerate().map(|(i, x)| exp(LN_10 * 6.0 * i as f64 / last) * x * x).sum::<f64>()
}

/// The ellipsoid of condition 10^6, turned by a reflection so that all genes are correlated.
fn turned_ellipsoid(x: &[f64]) -> f64 {
    let mean = 2.0 * x.iter().sum::<f64>() / x.len() as f64;
    ellipsoid(&x.iter().map(|x| x - mean).collect::<Vec<f64>>())
}

fn square(x: f64) -> f64 {
    x * x
}

fn rosenbrock(x: &[f64]) -> f64 {
    -x.windows(2).map(|x| 100.0 * square(x[1] - x[0] * x[0]) + square(1.0 - x[0])).sum::<f64>()
}

/// Returns the best fitness within a budget of evaluations.
fn best(strategy: &mut impl Strategy<f64>, evaluations: usize, function: fn(&[f64]) -> f64) -> f64 {
    let generations = evaluations / strategy.ask().len();
    strategy.maximize(generations as u32, function).unwrap().fitness.get()
}

#[test]
fn natural_evolution_strategies_reach_the_optimum() {
    let start = |genes| vec![2.0; genes];
    for seed in 0..3 {
        let mut snes = Snes::new(SnesConfig::new(start(10), 1.0), seed).unwrap();
        assert!(best(&mut snes, 10_000, sphere) > -1e-12);
        let mut snes = Snes::new(SnesConfig::new(start(10), 1.0), seed).unwrap();
        assert!(best(&mut snes, 20_000, ellipsoid) > -1e-9);
        let mut xnes = Xnes::new(XnesConfig::new(start(10), 1.0), seed).unwrap();
        assert!(best(&mut xnes, 10_000, sphere) > -1e-12);
        let mut xnes = Xnes::new(XnesConfig::new(start(10), 1.0), seed).unwrap();
        assert!(best(&mut xnes, 60_000, turned_ellipsoid) > -1e-9);
        let mut xnes = Xnes::new(XnesConfig::new(vec![0.0; 5], 0.5), seed).unwrap();
        assert!(best(&mut xnes, 60_000, rosenbrock) > -1e-9);
    }
}

/// Steps of a fixed size end near the optimum, not in it.
#[test]
fn mirrored_strategies_come_near_the_optimum() {
    let start = || vec![2.0; 10];
    for seed in 0..3 {
        for optimizer in [Optimizer::ADAM, Optimizer::MOMENTUM] {
            let config = OpenAiEsConfig {
                sigma: 0.05,
                learning_rate: 0.02,
                weight_decay: 0.0,
                optimizer,
                ..OpenAiEsConfig::new(start(), 20)
            };
            let mut search = OpenAiEs::new(config, seed).unwrap();
            assert!(best(&mut search, 40_000, sphere) > -0.1, "{optimizer:?}");
        }
        for fitness in [PgpeFitness::CenteredRanks, PgpeFitness::Raw] {
            let config = PgpeConfig { fitness, ..PgpeConfig::new(start(), 0.5, 20) };
            let mut search = Pgpe::new(config, seed).unwrap();
            assert!(best(&mut search, 40_000, sphere) > -0.1, "{fitness:?}");
        }
        for top_directions in [8, 20] {
            let config = ArsConfig { top_directions, step_size: 0.05, noise: 0.05, ..ArsConfig::new(start(), 20) };
            let mut search = Ars::new(config, seed).unwrap();
            assert!(best(&mut search, 40_000, sphere) > -0.1, "{top_directions}");
        }
    }
}

/// Weight decay alone pulls the parameters to zero.
#[test]
fn weights_decay() {
    let config = OpenAiEsConfig { weight_decay: 100.0, ..OpenAiEsConfig::new(vec![5.0; 4], 5) };
    let mut search = OpenAiEs::new(config, 1).unwrap();
    search.maximize(1000, |_| 0.0).unwrap();
    assert!(search.mean().iter().all(|x| x.abs() < 0.5), "{:?}", search.mean());
}
