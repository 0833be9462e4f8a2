//! Selection, the rebuilding of earlier generations, and equal bits from equal seeds.

use std::time::Instant;

use crate::errors;
use farsa_evo::coevolution::Populations;
use farsa_evo::words::{GaConfig, Mutation, OnePlusOne, OnePlusOneConfig, RandomSearch, TruncationGa};
use farsa_evo::{
    Champion, EvoError, Fitness, Genealogy as _, Population, Record, RecordKind, Snapshot, Statistics, Strategy,
    check_strategy,
};
use proptest::prelude::*;
use proptest::strategy::Strategy as _;

/// Counts the ones.
fn ones(genes: &[u16]) -> f64 {
    f64::from(genes.iter().map(|gene| gene.count_ones()).sum::<u32>())
}

fn judge(population: &Population, fitness: impl Fn(&[u16]) -> f64) -> Vec<Fitness> {
    population.iter().map(|genes| Fitness::nan_as_failed(fitness(genes))).collect()
}

/// Returns every evaluated generation, with the summary of the last.
fn evolve<S: Strategy>(
    strategy: &mut S,
    generations: u32,
    fitness: impl Fn(&[u16]) -> f64,
) -> (Vec<Population>, Statistics) {
    let mut evaluated = Vec::new();
    let mut summary = None;
    for _ in 0..generations {
        let fitness = judge(strategy.ask(), &fitness);
        summary = Statistics::from_fitness(&fitness);
        evaluated.push(strategy.ask().clone());
        strategy.tell(&fitness).unwrap();
    }
    (evaluated, summary.unwrap())
}

/// Evolves into a record and returns every evaluated generation.
fn recorded<S: Strategy>(
    strategy: &mut S,
    generations: u32,
    fitness: impl Fn(&[u16]) -> f64,
) -> (Vec<Population>, Record) {
    let mut record = Record::new(strategy).unwrap();
    let mut evaluated = Vec::new();
    for _ in 0..generations {
        evaluated.push(strategy.ask().clone());
        let fitness = judge(strategy.ask(), &fitness);
        record.tell(strategy, &fitness).unwrap();
    }
    (evaluated, record)
}

fn rebuilds<S: Strategy + std::fmt::Debug + PartialEq>(fresh: impl Fn() -> S) {
    let mut strategy = fresh();
    let (evaluated, record) = recorded(&mut strategy, 60, ones);
    for (generation, population) in (0..).zip(&evaluated) {
        assert_eq!(&record.genomes(&mut fresh(), generation).unwrap(), population, "generation {generation}");
    }
    // Also from one rebuilt generation to a later one.
    let mut on_the_way = fresh();
    for generation in [0, 3, 3, 17, 59] {
        assert_eq!(record.genomes(&mut on_the_way, generation).unwrap(), evaluated[generation as usize]);
    }
    let behind = errors::no_such_generation(58, 60);
    assert_eq!(record.rebuild(&mut on_the_way, 58), Err(behind));
    record.rebuild(&mut on_the_way, 60).unwrap();
    assert_eq!(on_the_way, strategy);
    let ahead = errors::no_such_generation(61, 60);
    assert_eq!(record.genomes(&mut fresh(), 61), Err(ahead));
    // Later generations are discarded and evolve again with equal bits.
    let mut again = record.clone();
    again.truncate(31);
    let mut resumed = fresh();
    again.rebuild(&mut resumed, 31).unwrap();
    for _ in 31..60 {
        let fitness = judge(resumed.ask(), ones);
        again.tell(&mut resumed, &fitness).unwrap();
    }
    assert_eq!((resumed, again), (strategy, record));
}

#[test]
fn every_generation_is_rebuilt_bit_for_bit() {
    rebuilds(|| TruncationGa::new(GaConfig::new(79), 17).unwrap());
    let flip = GaConfig { mutation: Mutation::Flip, mutation_rate: 1.0, ..GaConfig::new(3) };
    rebuilds(|| TruncationGa::new(flip, 17).unwrap());
    rebuilds(|| TruncationGa::new(GaConfig { population: 1, parents: 1, ..GaConfig::new(5) }, 17).unwrap());
    rebuilds(|| TruncationGa::new(GaConfig { population: 12, parents: 12, ..GaConfig::new(5) }, 17).unwrap());
    rebuilds(|| TruncationGa::new(GaConfig { population: 300, parents: 12, ..GaConfig::new(5) }, 17).unwrap());
    rebuilds(|| RandomSearch::new(9, 30, 17).unwrap());
    rebuilds(|| TruncationGa::new(GaConfig { gene_bits: 5, ..GaConfig::new(9) }, 17).unwrap());
    rebuilds(|| OnePlusOne::new(OnePlusOneConfig::new(14), 17).unwrap());
    rebuilds(|| {
        Populations::truncation(&[GaConfig::new(9), GaConfig { gene_bits: 8, ..GaConfig::new(12) }], 17).unwrap()
    });
}

/// A hill climber with adaptive steps that cannot save its state.
#[derive(Debug, PartialEq)]
struct HillClimber {
    generation: u32,
    population: Population,
}

impl HillClimber {
    fn new() -> Self {
        Self { generation: 0, population: Population::new(4, 2).unwrap() }
    }
}

impl Strategy for HillClimber {
    fn generation(&self) -> u32 {
        self.generation
    }
    fn ask(&self) -> &Population {
        &self.population
    }
    fn tell(&mut self, fitness: &[Fitness]) -> Result<(), EvoError> {
        let best = self.champions(fitness)[0];
        let genes = self.population.get(best).unwrap().to_vec();
        self.generation += 1;
        for (individual, genome) in self.population.iter_mut().enumerate() {
            genome.copy_from_slice(&genes);
            genome[individual / 2] = if individual % 2 == 0 { genes[0] + 1 } else { genes[1].saturating_sub(1) };
        }
        Ok(())
    }
}

#[test]
fn three_methods_make_a_strategy_that_is_recorded() {
    rebuilds(HillClimber::new);
    assert!(HillClimber::new().genealogy().is_none() && HillClimber::new().snapshot().is_none());
}

/// The hill climber with recorded genomes.
struct Slow(HillClimber);

impl Strategy for Slow {
    fn generation(&self) -> u32 {
        self.0.generation()
    }
    fn ask(&self) -> &Population {
        self.0.ask()
    }
    fn tell(&mut self, fitness: &[Fitness]) -> Result<(), EvoError> {
        self.0.tell(fitness)
    }
    fn record_kind(&self) -> RecordKind {
        RecordKind::Genomes
    }
    fn snapshot(&mut self) -> Option<&mut dyn Snapshot> {
        (self.0.population.len() == 4).then_some(self)
    }
}

impl Snapshot for Slow {
    fn save(&self) -> Vec<u8> {
        self.0.generation.to_le_bytes().into()
    }
    fn restore(&mut self, _: &[u8]) -> Result<(), EvoError> {
        Err(errors::no_snapshot())
    }
}

#[test]
fn recorded_genomes_are_rebuilt_without_fitness() {
    let mut strategy = Slow(HillClimber::new());
    let (evaluated, record) = recorded(&mut strategy, 9, ones);
    for (generation, population) in (0..).zip(&evaluated) {
        assert_eq!(&record.genomes(&mut Slow(HillClimber::new()), generation).unwrap(), population);
    }
    assert_eq!(record.rebuild(&mut Slow(HillClimber::new()), 3), Err(errors::genomes_only()));
    assert!(record.genomes(&mut Slow(HillClimber::new()), 9).is_err());
    assert_eq!(record.order(3), None);
    assert!(record.champion(0, 8).is_some() && record.champion(0, 9).is_none());
    // Evolution cannot continue from this one.
    let mut lost = Slow(HillClimber { population: Population::new(3, 2).unwrap(), ..HillClimber::new() });
    assert_eq!(Record::new(&mut lost).unwrap_err(), errors::no_snapshot());
}

/// A strategy that names fixed champions for any fitness.
struct Wrong {
    populations: usize,
    champions: Vec<usize>,
    population: Population,
}

impl Strategy for Wrong {
    fn generation(&self) -> u32 {
        0
    }
    fn ask(&self) -> &Population {
        &self.population
    }
    fn tell(&mut self, _: &[Fitness]) -> Result<(), EvoError> {
        Ok(())
    }
    fn populations(&self) -> usize {
        self.populations
    }
    fn champions(&self, _: &[Fitness]) -> Vec<usize> {
        self.champions.clone()
    }
}

#[test]
fn champions_and_populations_are_checked() {
    let wrong = |populations, champions: &[usize]| {
        let population = Population::new(6, 2).unwrap();
        let mut strategy = Wrong { populations, champions: champions.into(), population };
        Record::new(&mut strategy).and_then(|mut record| record.tell(&mut strategy, &[Fitness::WORST; 6])).unwrap_err()
    };
    for populations in [0, 4, 7] {
        assert_eq!(wrong(populations, &[]), errors::uneven_populations(populations, 6));
    }
    let count = errors::other_record("champions", 2);
    assert_eq!((wrong(2, &[]), wrong(2, &[0, 3, 4])), (count.clone(), count));
    for (champions, individual) in [([3, 3], 3), ([0, 6], 6), ([0, 1], 1), ([usize::MAX, 3], usize::MAX)] {
        assert_eq!(wrong(2, &champions), errors::no_such_individual(individual, 6));
    }
    // The generation never advances.
    assert_eq!(wrong(2, &[0, 3]), errors::stuck(0, 0));
}

#[test]
fn a_record_belongs_to_one_strategy() {
    let config = GaConfig { population: 6, parents: 2, ..GaConfig::new(3) };
    let mut evolution = TruncationGa::new(config, 4).unwrap();
    let mut record = Record::new(&mut evolution).unwrap();
    let fitness = [Fitness::WORST; 6];
    assert_eq!(record.tell(&mut evolution, &fitness[1..]), Err(errors::fitness_count(6, 5)));
    evolution.tell(&fitness).unwrap();
    let skipped = errors::other_record("generations", 0);
    assert_eq!(record.tell(&mut evolution, &fitness), Err(skipped));
    assert_eq!(Record::new(&mut evolution), Err(errors::not_at_start(1)));
    let other = |config| record.rebuild(&mut TruncationGa::new(config, 4).unwrap(), 0).unwrap_err();
    assert_eq!(other(GaConfig { genes: 4, ..config }), errors::other_record("genes", 3));
    let more = GaConfig { population: 8, ..config };
    assert_eq!(other(more), errors::other_record("individuals", 6));
    let of_values = record.check(&RandomSearch::new(3, 6, 4).unwrap()).unwrap_err();
    assert!(matches!(of_values, EvoError::Record { .. }), "{of_values}");
    let halves = Populations::truncation(&[GaConfig { population: 3, parents: 1, ..config }; 2], 4).unwrap();
    assert_eq!(record.check(&halves), Err(errors::other_record("populations", 1)));
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
fn one_plus_one_climbs_and_keeps_its_genes_narrow() {
    let mut search = OnePlusOne::new(OnePlusOneConfig::new(14), 1).unwrap();
    let parents = |search: &OnePlusOne| [0, 1, 2].map(|individual| search.parents_of(individual).len());
    assert_eq!(parents(&search), [0, 0, 0]);
    let (evaluated, _) = evolve(&mut search, 500, ones);
    assert_eq!(parents(&search), [1, 1, 0]);
    assert!(evaluated.iter().all(|pair| pair.as_slice().iter().all(|&gene| gene < 256)));
    let (fitness, evaluations) = search.parent_fitness().unwrap();
    assert!(fitness.get() > 100.0 && evaluations > 1, "{fitness:?} of 112 in {evaluations}");
    // Without noise the fitness of a parent never falls.
    let parents: Vec<f64> = evaluated.iter().map(|pair| ones(pair.get(0).unwrap())).collect();
    assert!(parents.windows(2).all(|pair| pair[0] <= pair[1]));
}

#[test]
fn resampling_at_rate_one_is_random_search_with_an_elite() {
    let config = GaConfig { population: 50, parents: 1, mutation_rate: 1.0, ..GaConfig::new(200) };
    let mut ga = TruncationGa::new(config, 4).unwrap();
    let (evaluated, _) = evolve(&mut ga, 20, ones);
    for pair in evaluated.windows(2) {
        let old = pair[0].get(0).unwrap();
        // A new genome shares half its 3200 bits with any other, within five standard deviations of 28.
        for new in pair[1].iter().skip(1) {
            let differing: u32 = old.iter().zip(new).map(|(a, b)| (a ^ b).count_ones()).sum();
            assert!(differing.abs_diff(1600) < 142, "{differing}");
        }
    }
}

/// Prints the time for the size of the reference experiment, with ranks that change in every generation.
#[test]
fn a_thousand_generations_of_a_hundred_take_few_bytes() {
    let fresh = || TruncationGa::new(GaConfig::new(792), 3).unwrap();
    let mut ga = fresh();
    let (_, record) = recorded(&mut ga, 1000, ones);
    assert!(record.bytes() <= 300_000, "{} bytes", record.bytes());
    let start = Instant::now();
    let mut again = fresh();
    record.rebuild(&mut again, 1000).unwrap();
    println!("1000 generations rebuilt in {:?}, from {} bytes", start.elapsed(), record.bytes());
    assert_eq!(again, ga);
    // Small genomes have occasional states, which at most double the record.
    let fresh = || TruncationGa::new(GaConfig::new(14), 3).unwrap();
    let mut ga = fresh();
    let (evaluated, record) = recorded(&mut ga, 1000, ones);
    assert!((150_000..=220_000).contains(&record.bytes()), "{} bytes", record.bytes());
    assert_eq!(record.genomes(&mut fresh(), 777).unwrap(), evaluated[777]);
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

/// Fitness with few distinct values, for many ties and failures.
fn coarse(seed: u64, index: usize) -> f64 {
    let word = (seed ^ index as u64).wrapping_mul(0x9e37_79b9_7f4a_7c15) >> 61;
    if word == 7 { f64::NAN } else { word as f64 }
}

proptest! {
    #[test]
    fn selection_keeps_the_best_and_elites_are_unchanged(config in configs(), seed: u64, noise: u64) {
        let mut ga = TruncationGa::new(config, seed).unwrap();
        let mut record = Record::new(&mut ga).unwrap();
        for generation in 0..4_u32 {
            let before = ga.ask().clone();
            prop_assert_eq!(ga.parents_of(0).len(), usize::from(generation > 0));
            let fitness: Vec<_> = (0..config.population)
                .map(|index| Fitness::nan_as_failed(coarse(noise ^ u64::from(generation) << 32, index)))
                .collect();
            record.tell(&mut ga, &fitness).unwrap();
            let selected = ga.selected().to_vec();
            let order = record.order(generation).unwrap();
            prop_assert_eq!(order.iter().map(|&i| i as u32).take(selected.len()).collect::<Vec<_>>(), &selected[..]);
            prop_assert_eq!(selected[0] as usize, Statistics::from_fitness(&fitness).unwrap().best_index);
            let ahead = |a: usize, b: usize| fitness[a] > fitness[b] || fitness[a] == fitness[b] && a < b;
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
                    prop_assert_eq!(ga.parents_of(child), [parent as usize]);
                }
            }
            prop_assert!(ga.parents_of(config.population).is_empty());
            let mut fresh = TruncationGa::new(config, seed).unwrap();
            prop_assert_eq!(&record.genomes(&mut fresh, generation).unwrap(), &before);
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
    assert_eq!(by_values.selected(), [2, 4]);
    assert_eq!(by_values.tell_values(&values[1..]), Err(errors::fitness_count(6, 5)));
}

/// Fitness falls over the generations, so that the best individual is an early one.
#[test]
fn the_champion_is_the_earliest_best_of_all_generations() {
    let config = GaConfig { population: 6, parents: 2, ..GaConfig::new(3) };
    let (mut evolution, mut evaluations) = (TruncationGa::new(config, 4).unwrap(), 0);
    let first = evolution.ask().clone();
    let champion = evolution.maximize(5, |_| {
        evaluations += 1;
        [0.0, 3.0, 7.0, 7.0, f64::NAN, 1.0][(evaluations - 1) % 6] - f64::from((evaluations as u32 - 1) / 6 % 4)
    });
    let champion = champion.unwrap();
    assert_eq!((evaluations, evolution.generation()), (30, 5));
    assert_eq!((champion.generation, champion.individual, champion.fitness.get()), (0, 2, 7.0));
    assert_eq!(champion.genome, first.get(2).unwrap());
    assert_eq!(evolution.maximize(0, |_| 1.0), Err(EvoError::NoBest { generation: 5 }));

    let mut best = Some(champion.clone());
    let none = [Fitness::WORST; 5];
    let refused = Champion::keep(&mut best, 5, evolution.ask(), &none);
    assert_eq!(refused, Err(errors::fitness_count(6, 5)));
    let fitness = [0.0, 0.0, 0.0, 0.0, 0.0, 8.0].map(Fitness::nan_as_failed);
    Champion::keep(&mut best, 5, evolution.ask(), &fitness).unwrap();
    let better = best.unwrap();
    assert_eq!((better.generation, better.individual, better.fitness.get()), (5, 5, 8.0));
    assert_eq!(Some(&better.genome[..]), evolution.ask().get(5));
}

#[test]
fn every_strategy_conforms() {
    let config = GaConfig { population: 12, parents: 4, ..GaConfig::new(5) };
    check_strategy(|| TruncationGa::new(config, 3), 30).unwrap();
    check_strategy(|| OnePlusOne::new(OnePlusOneConfig::new(5), 3), 30).unwrap();
    check_strategy(|| Populations::truncation(&[config, config], 3), 30).unwrap();
    check_strategy(|| RandomSearch::new(5, 12, 3), 30).unwrap();
}
