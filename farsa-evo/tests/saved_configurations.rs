//! Configurations of searches over reals, and maps of words, as they are saved and read.

#![cfg(feature = "serde")]
#![allow(clippy::unwrap_used)]

use core::fmt::Debug;

use farsa_evo::{
    CosyneConfig, Crossover, EvolutionStrategyConfig, Permutation, RealGaConfig, RealMutation, Selection,
    SteadyStateConfig, StepSizes, Survival, WordCode, WordGene, WordMap,
};
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
fn a_map_comes_back_and_an_impossible_one_is_refused() {
    let word = |bits| WordGene::Word { bits, low: -1.0, high: 1.0, code: WordCode::Gray };
    comes_back(&WordMap::new(vec![word(7), WordGene::Frozen(0.25)]).unwrap());
    let bytes = postcard::to_allocvec(&vec![word(17)]).unwrap();
    assert!(postcard::from_bytes::<WordMap>(&bytes).is_err());
}
