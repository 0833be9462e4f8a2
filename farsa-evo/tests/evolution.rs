//! Whole evolutions: what selection keeps, that the past can be rebuilt, and that the same seed gives the same bits.

#![allow(clippy::unwrap_used)]

use std::time::Instant;

use farsa_evo::{
    Champion, Coevolution, EvoError, Fitness, GaConfig, Mutation, OnePlusOne, OnePlusOneConfig, Population,
    RandomSearch, Statistics, Strategy, TruncationGa,
};
use proptest::prelude::*;
use proptest::strategy::Strategy as _;

/// Number of ones.
fn ones(genes: &[u16]) -> f64 {
    f64::from(genes.iter().map(|gene| gene.count_ones()).sum::<u32>())
}

fn judge(population: &Population, fitness: impl Fn(&[u16]) -> f64) -> Vec<Fitness> {
    population.iter().map(|genes| Fitness::nan_as_failed(fitness(genes))).collect()
}

/// Evolves and returns every generation that was evaluated, with the summary of the last.
fn evolve<S: Strategy>(
    strategy: &mut S,
    generations: u32,
    fitness: impl Fn(&[u16]) -> f64,
) -> (Vec<Population>, Statistics) {
    let mut lived = Vec::new();
    let mut summary = None;
    for _ in 0..generations {
        let told = judge(strategy.ask(), &fitness);
        summary = Statistics::from_fitness(&told);
        lived.push(strategy.ask().clone());
        strategy.tell(&told).unwrap();
    }
    (lived, summary.unwrap())
}

fn rebuilds<S: Strategy>(mut strategy: S) {
    let (lived, _) = evolve(&mut strategy, 60, ones);
    for (generation, population) in (0..).zip(&lived) {
        assert_eq!(&strategy.genomes_at(generation).unwrap(), population, "generation {generation}");
        for individual in [0, population.len() / 2, population.len() - 1] {
            assert_eq!(strategy.genome_of(generation, individual).unwrap(), population.get(individual).unwrap());
        }
    }
    assert_eq!(&strategy.genomes_at(60).unwrap(), strategy.ask());
    let ahead = EvoError::NoSuchGeneration { generation: 61, latest: 60 };
    assert_eq!(strategy.genomes_at(61), Err(ahead));
    assert_eq!(strategy.genome_of(61, 0), Err(ahead));
    let population = strategy.ask().len();
    let beyond = EvoError::NoSuchIndividual { individual: population, population };
    assert_eq!(strategy.genome_of(3, population), Err(beyond));
}

#[test]
fn every_generation_is_rebuilt_bit_for_bit() {
    rebuilds(TruncationGa::new(GaConfig::new(79), 17).unwrap());
    rebuilds(
        TruncationGa::new(GaConfig { mutation: Mutation::Flip, mutation_rate: 1.0, ..GaConfig::new(3) }, 17).unwrap(),
    );
    rebuilds(TruncationGa::new(GaConfig { population: 1, parents: 1, ..GaConfig::new(5) }, 17).unwrap());
    rebuilds(TruncationGa::new(GaConfig { population: 12, parents: 12, ..GaConfig::new(5) }, 17).unwrap());
    rebuilds(RandomSearch::new(9, 30, 17).unwrap());
    rebuilds(TruncationGa::new(GaConfig { gene_bits: 5, ..GaConfig::new(9) }, 17).unwrap());
    rebuilds(OnePlusOne::new(OnePlusOneConfig::new(14), 17).unwrap());
    rebuilds(Coevolution::new(&[GaConfig::new(9), GaConfig { gene_bits: 8, ..GaConfig::new(12) }], 17).unwrap());
}

#[test]
fn onemax_converges_and_random_search_does_not() {
    let config = GaConfig { mutation_rate: 0.005, ..GaConfig::new(10) };
    let (_, evolved) = evolve(&mut TruncationGa::new(config, 1).unwrap(), 300, ones);
    assert_eq!(evolved.best, 160.0);
    let mut search = RandomSearch::new(10, 100, 1).unwrap();
    evolve(&mut search, 300, ones);
    assert!(search.best().unwrap().fitness.get() < 120.0);
}

#[test]
fn a_steady_state_climbs_and_keeps_its_genes_narrow() {
    let mut search = OnePlusOne::new(OnePlusOneConfig::new(14), 1).unwrap();
    let (lived, _) = evolve(&mut search, 500, ones);
    assert!(lived.iter().all(|pair| pair.as_slice().iter().all(|&gene| gene < 256)));
    let (fitness, evaluations) = search.parent_fitness().unwrap();
    assert!(fitness.get() > 100.0 && evaluations > 1, "{fitness:?} of 112 in {evaluations}");
    // Without noise the fitness of a parent is what it always was, and never falls.
    let parents: Vec<f64> = lived.iter().map(|pair| ones(pair.get(0).unwrap())).collect();
    assert!(parents.windows(2).all(|pair| pair[0] <= pair[1]));
}

#[test]
fn resampling_at_rate_one_is_random_search_with_an_elite() {
    let config = GaConfig { population: 50, parents: 1, mutation_rate: 1.0, ..GaConfig::new(200) };
    let mut ga = TruncationGa::new(config, 4).unwrap();
    let (lived, _) = evolve(&mut ga, 20, ones);
    for pair in lived.windows(2) {
        let old = pair[0].get(0).unwrap();
        // A fresh genome shares half its 3200 bits with any other, to within five standard deviations of 28.
        for new in pair[1].iter().skip(1) {
            let differing: u32 = old.iter().zip(new).map(|(a, b)| (a ^ b).count_ones()).sum();
            assert!(differing.abs_diff(1600) < 142, "{differing}");
        }
    }
}

#[test]
fn a_lineage_resumes_the_run() {
    let mut whole = TruncationGa::new(GaConfig::new(20), 8).unwrap();
    evolve(&mut whole, 15, ones);
    let mut resumed = TruncationGa::resume(whole.lineage().clone()).unwrap();
    assert_eq!(resumed, whole);
    evolve(&mut whole, 15, ones);
    evolve(&mut resumed, 15, ones);
    assert_eq!(resumed, whole);
}

#[test]
fn a_thousand_generations_are_rebuilt_quickly() {
    // The size of the reference experiment, with ranks that change every generation.
    let mut ga = TruncationGa::new(GaConfig::new(792), 3).unwrap();
    let start = Instant::now();
    evolve(&mut ga, 1000, ones);
    println!("1000 generations: {:?}", start.elapsed());
    let start = Instant::now();
    assert_eq!(&ga.genomes_at(1000).unwrap(), ga.ask());
    let one_generation = start.elapsed();
    let start = Instant::now();
    assert_eq!(ga.genome_of(1000, 99).unwrap(), ga.ask().get(99).unwrap());
    println!("rebuilt: generation 1000 in {one_generation:?}, one of its genomes in {:?}", start.elapsed());
    assert!(one_generation.as_secs() < 5);
}

fn configs() -> impl proptest::strategy::Strategy<Value = GaConfig> {
    (1..9_usize, 1..5_usize, 1..6_usize, 0.0..=1.0_f64, any::<bool>()).prop_map(
        |(parents, copies, genes, rate, flip)| GaConfig {
            genes,
            population: parents * copies,
            parents,
            gene_bits: 16,
            mutation_rate: rate,
            mutation: if flip { Mutation::Flip } else { Mutation::Resample },
        },
    )
}

/// Fitness of few values, so that ties and failures abound.
fn coarse(seed: u64, index: usize) -> f64 {
    let word = (seed ^ index as u64).wrapping_mul(0x9e37_79b9_7f4a_7c15) >> 61;
    if word == 7 { f64::NAN } else { word as f64 }
}

proptest! {
    #[test]
    fn selection_keeps_the_best_and_elites_are_unchanged(config in configs(), seed: u64, noise: u64) {
        let mut ga = TruncationGa::new(config, seed).unwrap();
        for generation in 0..4_u32 {
            let before = ga.ask().clone();
            let told: Vec<_> = (0..config.population)
                .map(|index| Fitness::nan_as_failed(coarse(noise ^ u64::from(generation) << 32, index)))
                .collect();
            ga.tell(&told).unwrap();
            let selected = ga.lineage().selected(generation).unwrap();
            prop_assert_eq!(selected[0] as usize, Statistics::from_fitness(&told).unwrap().best_index);
            let ahead = |a: usize, b: usize| told[a] > told[b] || told[a] == told[b] && a < b;
            for pair in selected.windows(2) {
                prop_assert!(ahead(pair[0] as usize, pair[1] as usize));
            }
            let last = *selected.last().unwrap() as usize;
            for index in 0..config.population {
                prop_assert!(selected.contains(&(index as u32)) || ahead(last, index));
            }
            let copies = config.population / config.parents;
            for (rank, &parent) in selected.iter().enumerate() {
                prop_assert_eq!(ga.ask().get(rank * copies), before.get(parent as usize));
                for copy in 0..copies {
                    let child = rank * copies + copy;
                    prop_assert_eq!(ga.lineage().parent_of(generation + 1, child), Some(parent as usize));
                }
            }
            prop_assert_eq!(&ga.genomes_at(generation).unwrap(), &before);
        }
    }

    #[test]
    fn fitness_is_never_nan(bits: u64) {
        let value = f64::from_bits(bits);
        prop_assert!(!Fitness::nan_as_failed(value).get().is_nan());
        prop_assert_eq!(Fitness::new(value).is_none(), value.is_nan());
    }

    #[test]
    fn streams_differ_by_seed(seed: u64) {
        let genomes = |seed| TruncationGa::new(GaConfig::new(4), seed).unwrap().ask().clone();
        prop_assert_ne!(genomes(seed), genomes(seed ^ 1));
    }
}

#[test]
fn values_are_told_as_fitness() {
    let config = GaConfig { population: 6, parents: 2, ..GaConfig::new(3) };
    let mut by_fitness = TruncationGa::new(config, 4).unwrap();
    let mut by_values = by_fitness.clone();
    let values = [1.0, f64::NAN, 5.0, -2.0, 5.0, f64::NEG_INFINITY];
    by_values.tell_values(&values).unwrap();
    by_fitness.tell(&values.map(Fitness::nan_as_failed)).unwrap();
    assert_eq!(by_values, by_fitness);
    assert_eq!(by_values.lineage().selected(0), Some(&[2, 4][..]));
    assert_eq!(by_values.tell_values(&values[1..]), Err(EvoError::FitnessCount { expected: 6, found: 5 }));
}

/// With fitness that falls from generation to generation, so that the best so far is an early one.
#[test]
fn the_champion_is_the_earliest_best_of_all_generations() {
    let config = GaConfig { population: 6, parents: 2, ..GaConfig::new(3) };
    let (mut evolution, mut lives) = (TruncationGa::new(config, 4).unwrap(), 0);
    let champion = evolution.maximize(5, |_| {
        lives += 1;
        [0.0, 3.0, 7.0, 7.0, f64::NAN, 1.0][(lives - 1) % 6] - f64::from((lives as u32 - 1) / 6 % 4)
    });
    let champion = champion.unwrap();
    assert_eq!((lives, evolution.generation()), (30, 5));
    assert_eq!((champion.generation, champion.individual, champion.fitness.get()), (0, 2, 7.0));
    assert_eq!(champion.genome, evolution.genome_of(0, 2).unwrap());
    assert_eq!(evolution.maximize(0, |_| 1.0), Err(EvoError::NoBest { generation: 5 }));

    let mut best = Some(champion.clone());
    let none = [Fitness::WORST; 5];
    let refused = Champion::keep(&mut best, 5, evolution.ask(), &none);
    assert_eq!(refused, Err(EvoError::FitnessCount { expected: 6, found: 5 }));
    let fitness = [0.0, 0.0, 0.0, 0.0, 0.0, 8.0].map(Fitness::nan_as_failed);
    Champion::keep(&mut best, 5, evolution.ask(), &fitness).unwrap();
    let better = best.unwrap();
    assert_eq!((better.generation, better.individual, better.fitness.get()), (5, 5, 8.0));
    assert_eq!(Some(&better.genome[..]), evolution.ask().get(5));
}
