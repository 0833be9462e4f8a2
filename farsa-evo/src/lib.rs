#![doc = include_str!("../README.md")]
#![no_std]
#![cfg_attr(test, allow(clippy::unwrap_used))]

extern crate alloc;

mod champion;
mod coevolution;
mod config;
mod decode;
mod error;
mod fitness;
mod lineage;
mod mutation;
mod population;
mod random_search;
#[cfg(feature = "serde")]
mod saved;
mod statistics;
mod steady_history;
mod steady_state;
mod strategy;
mod truncation;

pub use champion::Champion;
pub use coevolution::{Coevolution, Lineages};
pub use config::{GaConfig, SteadyStateConfig};
pub use decode::{GeneRange, decode};
pub use error::EvoError;
pub use fitness::Fitness;
pub use lineage::Lineage;
pub use mutation::{BitMutation, Mutation, randomize};
pub use population::Population;
pub use random_search::{Found, RandomSearch};
pub use statistics::Statistics;
pub use steady_history::SteadyHistory;
pub use steady_state::SteadyState;
pub use strategy::Strategy;
pub use truncation::TruncationGa;
