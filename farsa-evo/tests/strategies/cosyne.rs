//! Cooperative coevolution of weights, compared with a transcription of the algorithm, on test functions and by digests.

use crate::errors;
use farsa_evo::coevolution::{Cosyne, CosyneConfig, Permutation};
use farsa_evo::{EvoError, Fitness, RecordKind, Snapshot, Strategy, check_strategy};
use farsa_num::{Domain, Stream};
use proptest::prelude::*;

fn sphere(genes: &[f64]) -> f64 {
    -genes.iter().map(|x| (x - 0.5) * (x - 0.5)).sum::<f64>()
}

fn rosenbrock(genes: &[f64]) -> f64 {
    let square = |x: f64| x * x;
    -genes.windows(2).map(|x| 100.0 * square(x[1] - x[0] * x[0]) + square(1.0 - x[0])).sum::<f64>()
}

fn configs() -> [CosyneConfig; 4] {
    let plain = CosyneConfig { segments: vec![3, 1, 4], ..CosyneConfig::new(8) };
    [
        plain.clone(),
        CosyneConfig { permutation: Permutation::ByFitness, ..plain.clone() },
        CosyneConfig { population: 9, parents: 1, offspring: 3, mutation_rate: 1.0, ..plain.clone() },
        CosyneConfig { population: 4, parents: 4, offspring: 4, range: 0.5, ..plain },
    ]
}

#[test]
fn it_conforms() {
    for config in configs() {
        check_strategy(|| Cosyne::new(config.clone(), 7), 40).unwrap();
    }
    let [by_rank, by_fitness, ..] = configs().map(|config| Cosyne::new(config, 1).unwrap().record_kind());
    assert_eq!((by_rank, by_fitness), (RecordKind::Order, RecordKind::Values));
}

/// A generation of algorithm 2, gene by gene: rows of weights, each with its previous row.
#[allow(clippy::disallowed_methods)]
fn next(
    config: &CosyneConfig,
    seed: u64,
    generation: u32,
    rows: &[Vec<f64>],
    fitness: &[f64],
) -> Vec<Vec<(f64, usize)>> {
    let (m, n) = (rows.len(), rows[0].len());
    let mut order: Vec<usize> = (0..m).collect();
    order.sort_by(|a, b| fitness[*b].total_cmp(&fitness[*a]));
    let mut p: Vec<Vec<(f64, usize)>> =
        order.iter().map(|&row| rows[row].iter().map(|&weight| (weight, row)).collect()).collect();
    let parents = p.clone();
    for k in 0..config.offspring {
        let mut stream = Stream::new(seed, Domain::Mutation, 0, (k / 2) as u32, generation);
        let first = stream.below(config.parents as u32) as usize;
        let mut second = stream.below(config.parents as u32) as usize;
        while config.parents > 1 && second == first {
            second = stream.below(config.parents as u32) as usize;
        }
        let cuts: Vec<usize> = config.segments.iter().map(|&genes| stream.below(genes as u32 + 1) as usize).collect();
        for child in 0..=k % 2 {
            let mut gene = 0;
            for (&genes, &cut) in config.segments.iter().zip(&cuts) {
                for within in 0..genes {
                    let from = if (within < cut) == (child == 0) { first } else { second };
                    let (mut weight, row) = parents[from][gene];
                    if stream.uniform_f64() < config.mutation_rate {
                        let angle = core::f64::consts::PI * (stream.uniform_f64() - 0.5);
                        weight += config.mutation_scale * angle.tan();
                    }
                    // For an odd k the first child is drawn but not used.
                    if child == k % 2 {
                        p[m - config.offspring + k][gene] = (weight, row);
                    }
                    gene += 1;
                }
            }
        }
    }
    let [worst, best] = [fitness[order[m - 1]], fitness[order[0]]];
    for i in 0..n {
        let mut stream = Stream::new(seed, Domain::Mutation, 1, i as u32, generation);
        let marked: Vec<usize> = (0..m - config.offspring)
            .filter(|&j| match config.permutation {
                Permutation::All => true,
                Permutation::ByFitness => {
                    let part: f64 = (fitness[order[j]] - worst) / (best - worst);
                    stream.uniform_f64() < 1.0 - part.powf(1.0 / n as f64)
                }
            })
            .collect();
        for last in (1..marked.len()).rev() {
            let target = stream.below(last as u32 + 1) as usize;
            let weight = p[marked[last]][i];
            p[marked[last]][i] = p[marked[target]][i];
            p[marked[target]][i] = weight;
        }
    }
    p
}

#[test]
fn generations_are_those_of_a_transcription() {
    for config in configs() {
        let mut search = Cosyne::new(config.clone(), 11).unwrap();
        for generation in 1..20 {
            let rows: Vec<Vec<f64>> = search.ask().iter().map(<[f64]>::to_vec).collect();
            let fitness: Vec<f64> = rows.iter().map(|row| rosenbrock(row)).collect();
            search.tell_values(&fitness).unwrap();
            let want = next(&config, 11, generation, &rows, &fitness);
            for (individual, (got, want)) in search.ask().iter().zip(&want).enumerate() {
                let near = |got: f64, want: f64| (got - want).abs() <= 1e-9 * want.abs().max(1.0);
                assert!(got.iter().zip(want).all(|(got, want)| near(*got, want.0)), "{generation}: {got:?} {want:?}");
                let mut parents: Vec<usize> = want.iter().map(|(_, row)| *row).collect();
                parents.sort_unstable();
                parents.dedup();
                assert_eq!(search.genealogy().unwrap().parents_of(individual), parents);
            }
        }
    }
}

/// Only mutation creates new weights, and no weight moves to another gene.
#[test]
fn weights_stay_in_their_subpopulation() {
    for permutation in [Permutation::All, Permutation::ByFitness] {
        let config = CosyneConfig { mutation_rate: 0.0, permutation, ..configs()[0].clone() };
        let mut search = Cosyne::new(config, 3).unwrap();
        let column = |search: &Cosyne, gene: usize| search.ask().iter().map(|row| row[gene]).collect::<Vec<f64>>();
        for _ in 0..10 {
            let before: Vec<Vec<f64>> = (0..8).map(|gene| column(&search, gene)).collect();
            let fitness: Vec<f64> = search.ask().iter().map(sphere).collect();
            search.tell_values(&fitness).unwrap();
            for (gene, before) in before.iter().enumerate() {
                assert!(column(&search, gene).iter().all(|weight| before.contains(weight)));
            }
        }
    }
}

#[test]
fn by_fitness_the_best_network_stays() {
    let config = CosyneConfig { permutation: Permutation::ByFitness, ..CosyneConfig::new(6) };
    let mut search = Cosyne::new(config, 5).unwrap();
    for _ in 0..30 {
        let fitness: Vec<f64> = search.ask().iter().map(sphere).collect();
        let best = (0..30).max_by(|a, b| fitness[*a].total_cmp(&fitness[*b])).unwrap();
        let best = search.ask().get(best).unwrap().to_vec();
        search.tell_values(&fitness).unwrap();
        assert_eq!(search.ask().get(0).unwrap(), best);
    }
}

/// 30 individuals, 12 000 evaluations.
#[test]
fn it_converges() {
    for permutation in [Permutation::All, Permutation::ByFitness] {
        let config = |genes| CosyneConfig { permutation, ..CosyneConfig::new(genes) };
        let best = Cosyne::new(config(5), 5).unwrap().maximize(400, sphere).unwrap();
        // Random weights reach -20 with the same budget.
        assert!(best.fitness.get() > -0.2, "{permutation:?}: {:?}", best.fitness);
    }
}

#[test]
fn it_keeps_its_bits() {
    let got = configs().map(|config| {
        let mut search = Cosyne::new(config, 2008).unwrap();
        search.maximize(50, rosenbrock).unwrap();
        search.ask().digest()
    });
    let want = [0x0d05_7959_8d3f_f0c2, 0x2218_8ccb_2556_87fa, 0x0b0c_79d9_6166_8145, 0xe54e_74f4_9b83_66ed];
    assert_eq!(got, want, "{got:#018x?}");
}

#[test]
fn impossible_configurations_are_refused() {
    let refused = |change: &dyn Fn(&mut CosyneConfig)| {
        let mut config = CosyneConfig::new(4);
        change(&mut config);
        match Cosyne::new(config, 0).unwrap_err() {
            EvoError::OutOfRange { field, value, .. } => (field, value),
            other => panic!("{other}"),
        }
    };
    assert_eq!(refused(&|c| c.population = 1), ("the population", 1.0));
    assert_eq!(refused(&|c| c.segments = vec![4, 0]), ("the genes of a segment", 0.0));
    assert_eq!(refused(&|c| c.parents = 0), ("the number of parents", 0.0));
    assert_eq!(refused(&|c| c.parents = 31), ("the number of parents", 31.0));
    assert_eq!(refused(&|c| c.offspring = 31), ("the number of offspring", 31.0));
    assert_eq!(refused(&|c| c.range = -1.0), ("the range of the first weights", -1.0));
    assert_eq!(refused(&|c| c.range = f64::INFINITY), ("the range of the first weights", f64::INFINITY));
    assert_eq!(refused(&|c| c.mutation_rate = 1.5), ("the mutation rate", 1.5));
    assert_eq!(refused(&|c| c.mutation_scale = -0.5), ("the scale of mutation", -0.5));
    let nan = CosyneConfig { mutation_scale: f64::NAN, ..CosyneConfig::new(4) };
    assert!(matches!(nan.validate(), Err(EvoError::OutOfRange { field: "the scale of mutation", .. })));
    assert_eq!(Cosyne::new(CosyneConfig::new(0), 0).unwrap_err(), errors::no_genes());
    let nobody = CosyneConfig { population: 0, ..CosyneConfig::new(4) };
    assert_eq!(Cosyne::new(nobody, 0).unwrap_err(), errors::no_individuals());
    let large = CosyneConfig { segments: vec![usize::MAX, 2], ..CosyneConfig::new(4) };
    assert_eq!(large.validate(), Err(errors::too_large(30, usize::MAX)));
}

#[test]
fn a_damaged_state_is_refused() {
    let mut search = Cosyne::new(configs()[0].clone(), 3).unwrap();
    search.tell_values(&[0.0; 30]).unwrap();
    let before = search.clone();
    let state = search.snapshot().unwrap().save();
    // Positions of an origin and of a gene.
    for at in [4, state.len() - 8] {
        let mut damaged = state.clone();
        damaged[at..at + 8].fill(0xff);
        assert!(search.snapshot().unwrap().restore(&damaged).is_err(), "{at}");
        assert_eq!(search, before);
    }
    assert!(matches!(search.restore(&state[..20]), Err(EvoError::State { .. })));
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(64))]
    #[test]
    fn genes_stay_finite_and_saved_states_are_the_same(
        seed: u64,
        segments in proptest::collection::vec(1_usize..5, 1..4),
        parents in 1_usize..6,
        offspring in 0_usize..=6,
        scale in 0.0_f64..1e100,
        by_fitness: bool,
        reported in proptest::collection::vec(proptest::num::f64::ANY, 6),
    ) {
        let permutation = if by_fitness { Permutation::ByFitness } else { Permutation::All };
        let config = CosyneConfig {
            segments, population: 6, parents, offspring, mutation_scale: scale, permutation, ..CosyneConfig::new(1)
        };
        let mut search = Cosyne::new(config.clone(), seed).unwrap();
        for _ in 0..10 {
            search.tell(&reported.iter().copied().map(Fitness::nan_as_failed).collect::<Vec<_>>()).unwrap();
            prop_assert!(search.ask().as_slice().iter().all(|gene| gene.is_finite()));
        }
        let mut restored = Cosyne::new(config, seed).unwrap();
        restored.restore(&search.save()).unwrap();
        prop_assert_eq!(&restored, &search);
    }
}
