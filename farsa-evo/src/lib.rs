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
mod one_plus_one;
mod one_plus_one_history;
mod population;
mod random_search;
#[cfg(feature = "serde")]
mod saved;
mod statistics;
mod strategy;
mod truncation;

pub use champion::Champion;
pub use coevolution::{Coevolution, Lineages};
pub use config::{GaConfig, OnePlusOneConfig};
pub use decode::{GeneRange, decode};
pub use error::EvoError;
pub use fitness::Fitness;
pub use lineage::Lineage;
pub use mutation::{BitMutation, Mutation, randomize};
pub use one_plus_one::OnePlusOne;
pub use one_plus_one_history::OnePlusOneHistory;
pub use population::Population;
pub use random_search::{Found, RandomSearch};
pub use statistics::Statistics;
pub use strategy::Strategy;
pub use truncation::TruncationGa;
