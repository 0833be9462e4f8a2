//! The steady state strategy, compared with a transcription of its source, on test functions and by digests.

use crate::errors;
use farsa_evo::real::{SteadyState, SteadyStateConfig};
use farsa_evo::{EvoError, Strategy, check_strategy};
use farsa_num::{Domain, Stream};
use proptest::prelude::*;

fn sphere(genes: &[f64]) -> f64 {
    -genes.iter().map(|x| (x - 0.5) * (x - 0.5)).sum::<f64>()
}

fn rosenbrock(genes: &[f64]) -> f64 {
    let square = |x: f64| x * x;
    -genes.windows(2).map(|x| 100.0 * square(x[1] - x[0] * x[0]) + square(1.0 - x[0])).sum::<f64>()
}

fn configs() -> [SteadyStateConfig; 3] {
    let plain = SteadyStateConfig::new(vec![[-5.0, 5.0], [0.0, 1.0], [2.0, 2.0], [-1.0, 3.0]]);
    [
        plain.clone(),
        SteadyStateConfig { noise: 3.0, ..plain.clone() },
        SteadyStateConfig { population: 2, rate: 0.5, ..plain },
    ]
}

#[test]
fn it_conforms() {
    for config in configs() {
        check_strategy(|| SteadyState::new(config.clone(), 7), 40).unwrap();
    }
}

fn mirrored(mut x: f64, [low, high]: [f64; 2]) -> f64 {
    while low < high && !(low..=high).contains(&x) {
        x = if x < low { 2.0 * low - x } else { 2.0 * high - x };
    }
    x
}

#[test]
fn generations_are_those_of_a_transcription() {
    for config in configs() {
        let mut search = SteadyState::new(config.clone(), 11).unwrap();
        let mut pop: Vec<Vec<f64>> = search.ask().iter().map(<[f64]>::to_vec).collect();
        for generation in 1..20 {
            let values: Vec<f64> = search.ask().iter().map(sphere).collect();
            let noise = |i: usize| {
                let mut stream = Stream::new(11, Domain::Mutation, 1, i as u32, generation - 1);
                config.noise * (2.0 * stream.uniform_f64() - 1.0)
            };
            let ranked_by: Vec<f64> = values.iter().enumerate().map(|(i, fitness)| fitness + noise(i)).collect();
            search.tell_values(&values).unwrap();
            let mut index: Vec<usize> = (0..pop.len()).collect();
            index.sort_by(|a, b| ranked_by[*b].total_cmp(&ranked_by[*a]));
            let half = pop.len() / 2;
            for i in 0..half {
                let place = index[i + half];
                let mut stream = Stream::new(11, Domain::Mutation, 0, place as u32, generation);
                pop[place] = pop[index[i]].clone();
                for (gene, range) in pop[place].iter_mut().zip(&config.bounds) {
                    if stream.uniform_f64() < config.rate {
                        let normal = stream.normal_pair_f64()[0];
                        *gene = mirrored(*gene + config.sigma * (range[1] - range[0]) * normal, *range);
                    }
                }
                let parents = |i| search.genealogy().unwrap().parents_of(i);
                assert_eq!([parents(place), parents(index[i])], [[index[i]], [index[i]]]);
            }
            for (got, want) in search.ask().iter().flatten().zip(pop.iter().flatten()) {
                assert!((got - want).abs() <= 1e-12 * want.abs().max(1.0), "{generation}: {got} {want}");
            }
        }
    }
}

/// Ten genes, and two for Rosenbrock, with 20 000 evaluations each.
#[test]
fn it_converges() {
    let config = |genes| SteadyStateConfig { sigma: 0.005, ..SteadyStateConfig::new(vec![[-5.0, 5.0]; genes]) };
    let best = SteadyState::new(config(10), 5).unwrap().maximize(1000, sphere).unwrap();
    assert!(best.fitness.get() > -0.02, "{:?}", best.fitness);
    let best = SteadyState::new(config(2), 5).unwrap().maximize(1000, rosenbrock).unwrap();
    assert!(best.fitness.get() > -0.01, "{:?}", best.fitness);
}

#[test]
fn it_keeps_its_bits() {
    let got = configs().map(|config| {
        let mut search = SteadyState::new(config, 2010).unwrap();
        search.maximize(50, rosenbrock).unwrap();
        search.ask().digest()
    });
    let want = [0x25fd_dfa0_b1c2_e0fe, 0xb508_ad1c_4d72_881b, 0x1695_c4a9_a4b9_83c5];
    assert_eq!(got, want, "{got:#018x?}");
}

#[test]
fn impossible_configurations_are_refused() {
    let refused = |change: &dyn Fn(&mut SteadyStateConfig)| {
        let mut config = SteadyStateConfig::new(vec![[0.0, 1.0]; 3]);
        change(&mut config);
        match SteadyState::new(config, 0).unwrap_err() {
            EvoError::OutOfRange { field, value, .. } => (field, value),
            other => panic!("{other}"),
        }
    };
    assert_eq!(refused(&|c| c.population = 7), ("the population", 7.0));
    assert_eq!(refused(&|c| c.rate = 1.5), ("the mutation rate", 1.5));
    assert_eq!(refused(&|c| c.sigma = -0.5), ("sigma of mutation", -0.5));
    assert_eq!(refused(&|c| c.noise = f64::INFINITY), ("noise", f64::INFINITY));
    assert_eq!(refused(&|c| c.bounds[0] = [1.0, 0.0]), ("the high end of a gene", 0.0));
    assert_eq!(SteadyState::new(SteadyStateConfig::new(Vec::new()), 0).unwrap_err(), errors::no_genes());
}

#[test]
fn a_damaged_state_is_refused() {
    let [config, ..] = configs();
    let mut search = SteadyState::new(config, 3).unwrap();
    search.tell_values(&[0.0; 20]).unwrap();
    let before = search.clone();
    let state = search.snapshot().unwrap().save();
    for at in [4, state.len() - 8] {
        let mut damaged = state.clone();
        damaged[at..at + 8].fill(0x7e);
        assert!(search.snapshot().unwrap().restore(&damaged).is_err(), "{at}");
        assert_eq!(search, before);
    }
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(64))]
    #[test]
    fn genes_stay_within_bounds(
        seed: u64,
        noise in 0.0_f64..1e100,
        sigma in 0.0_f64..1.0,
        ends in proptest::array::uniform2(-1e100_f64..1e100),
        reported in proptest::collection::vec(proptest::num::f64::ANY, 20),
    ) {
        let [mut config, ..] = configs();
        config.bounds[0] = [ends[0].min(ends[1]), ends[0].max(ends[1])];
        (config.noise, config.sigma) = (noise, sigma);
        let bounds = config.bounds.clone();
        let mut search = SteadyState::new(config, seed).unwrap();
        for _ in 0..10 {
            search.tell_values(&reported).unwrap();
            for genes in search.ask() {
                prop_assert!(genes.iter().zip(&bounds).all(|(gene, [low, high])| low <= gene && gene <= high));
            }
        }
    }
}
