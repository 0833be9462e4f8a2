//! Configurations of searches over reals, and maps of words, as they are saved and read.

use core::fmt::Debug;

use farsa_evo::archives::{ArchiveRule, CvtCells, GridCells, MapElitesConfig, NoveltyConfig};
use farsa_evo::coevolution::{CosyneConfig, GeneralistConfig, Permutation};
use farsa_evo::pareto::Nsga2Config;
use farsa_evo::real::{
    Crossover, EvolutionStrategyConfig, RealGaConfig, RealMutation, Selection, SteadyStateConfig, StepSizes, Survival,
};
use farsa_evo::words::{WordCode, WordGene, WordMap};
use serde::Serialize;
use serde::de::DeserializeOwned;

fn comes_back<T: Serialize + DeserializeOwned + PartialEq + Debug>(value: &T) {
    let bytes = postcard::to_allocvec(value).unwrap();
    assert_eq!(&postcard::from_bytes::<T>(&bytes).unwrap(), value);
}

#[test]
fn configurations_come_back() {
    let bounds = vec![[-1.0, 1.0], [0.5, 0.5]];
    let mutation = RealMutation::SelfAdaptive { rate: 0.5, initial: 0.1, tau: 0.7, smallest: 1e-6 };
    let (selection, crossover) = (Selection::Rank { pressure: 1.5 }, Crossover::Blend { alpha: 0.5 });
    comes_back(&RealGaConfig { mutation, selection, crossover, ..RealGaConfig::new(bounds.clone()) });
    comes_back(&GeneralistConfig { gene_bits: 8, ..GeneralistConfig::new(7) });
    comes_back(&SteadyStateConfig { noise: 0.25, ..SteadyStateConfig::new(bounds) });
    comes_back(&CosyneConfig { segments: vec![2, 3], permutation: Permutation::ByFitness, ..CosyneConfig::new(5) });
    let (survival, step_sizes) = (Survival::PlusEvaluatedAgain, StepSizes::one(3));
    comes_back(&EvolutionStrategyConfig {
        survival,
        step_sizes,
        ..EvolutionStrategyConfig::new(vec![1.0, 2.0, 3.0], 0.5)
    });
}

#[test]
fn configurations_of_more_than_fitness_come_back_and_impossible_cells_are_refused() {
    let bounds = vec![[-1.0, 1.0], [0.5, 0.75]];
    comes_back(&Nsga2Config { crossover_eta: 15.0, ..Nsga2Config::new(bounds.clone(), 3) });
    comes_back(&MapElitesConfig::new(bounds.clone()));
    comes_back(&MapElitesConfig::cma_me(bounds.clone(), 3, 12, 0.1));
    let archive = ArchiveRule::Threshold { first: 0.5, most: 4, patience: 10 };
    comes_back(&NoveltyConfig { archive, ..NoveltyConfig::new(2) });
    comes_back(&GridCells::new(bounds.clone(), vec![4, 5]).unwrap());
    comes_back(&CvtCells::new(20, &bounds, 200, 1).unwrap());
    let grid = postcard::to_allocvec(&(vec![[1.0, -1.0]], vec![4_usize])).unwrap();
    assert!(postcard::from_bytes::<GridCells>(&grid).is_err());
    let cells = postcard::to_allocvec(&(2_usize, vec![1.0, 2.0, 3.0])).unwrap();
    assert!(postcard::from_bytes::<CvtCells>(&cells).is_err());
}

#[test]
fn a_map_comes_back_and_an_impossible_one_is_refused() {
    let word = |bits| WordGene::Word { bits, low: -1.0, high: 1.0, code: WordCode::Gray };
    comes_back(&WordMap::new(vec![word(7), WordGene::Frozen(0.25)]).unwrap());
    let bytes = postcard::to_allocvec(&vec![word(17)]).unwrap();
    assert!(postcard::from_bytes::<WordMap>(&bytes).is_err());
}
