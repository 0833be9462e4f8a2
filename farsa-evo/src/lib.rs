#![doc = include_str!("../README.md")]
#![no_std]
#![cfg_attr(test, allow(clippy::unwrap_used))]

extern crate alloc;

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
mod strategy;
mod truncation;

pub use decode::{GeneRange, decode};
pub use error::EvoError;
pub use fitness::Fitness;
pub use lineage::Lineage;
pub use mutation::{BitMutation, Mutation, randomize};
pub use population::Population;
pub use random_search::{Found, RandomSearch};
pub use statistics::Statistics;
pub use strategy::Strategy;
pub use truncation::{GaConfig, TruncationGa};
