#![doc = include_str!("../README.md")]
#![no_std]
#![cfg_attr(test, allow(clippy::unwrap_used))]

extern crate alloc;

mod champion;
mod coevolution;
mod coevolving;
mod collection;
mod config;
mod conformance;
mod covariance;
mod decode;
mod error;
mod fitness;
mod gene;
mod gradient;
mod judgement;
mod judgement_shape;
mod map_elites;
mod meetings;
mod mutation;
mod novelty;
mod one_plus_one;
mod pareto;
mod population;
mod random_search;
mod real;
mod recording;
#[cfg(feature = "serde")]
mod saved;
mod side_by_side;
mod snapshot;
mod statistics;
mod strategy;
mod truncation;
mod vectors;
mod word_map;

pub use champion::Champion;
pub use coevolution::Coevolution;
pub use coevolving::{
    Cosyne, CosyneConfig, GeneralistCoevolution, GeneralistConfig, Outcomes, Permutation, Replacement,
};
pub use collection::{Collection, Member};
pub use config::{GaConfig, OnePlusOneConfig};
pub use conformance::check_strategy;
pub use covariance::{
    CholeskyCmaEs, CmaEs, CmaEsConfig, CmaEsRestarts, CmaEsRestartsConfig, RestartSchedule, SeparableCmaEs,
    SeparableCmaEsConfig,
};
pub use decode::{GeneRange, decode};
pub use error::EvoError;
pub use fitness::Fitness;
pub use gene::Gene;
pub use gradient::{
    Ars, ArsConfig, ObservationStatistics, OpenAiEs, OpenAiEsConfig, Optimizer, Pgpe, PgpeConfig, PgpeFitness, Snes,
    SnesConfig, Xnes, XnesConfig,
};
pub use judgement::Judgements;
pub use judgement_shape::JudgementShape;
pub use map_elites::{
    Addition, Archive, Cells, CvtArchive, CvtCells, Elite, Emitter, GridArchive, GridCells, MapElites, MapElitesConfig,
};
pub use meetings::Meetings;
pub use mutation::{BitMutation, Mutation, randomize};
pub use novelty::{ArchiveRule, NoveltyConfig, NoveltySearch};
pub use one_plus_one::OnePlusOne;
pub use pareto::{Nsga2, Nsga2Config, crowding_distances, dominates, hypervolume, non_dominated_fronts};
pub use population::Population;
pub use random_search::{Found, RandomSearch};
pub use real::{
    Crossover, EvolutionStrategy, EvolutionStrategyConfig, RealGa, RealGaConfig, RealMutation, Recombination,
    Selection, SteadyState, SteadyStateConfig, StepSizes, Survival,
};
pub use recording::{Record, RecordEntry, RecordWriter};
pub use side_by_side::SideBySide;
pub use snapshot::Snapshot;
pub use statistics::Statistics;
pub use strategy::{Genealogy, Recorded, Strategy};
pub use truncation::TruncationGa;
pub use word_map::{WordCode, WordGene, WordMap};
