//! Strategies, their records and what they are judged by.
#![allow(missing_docs, clippy::unwrap_used)]

mod conformance;
mod cosyne;
mod covariance;
mod errors;
mod evolution;
mod evolution_strategy;
mod flat;
mod generalist_coevolution;
mod map_elites;
mod novelty_search;
mod nsga2;
mod outcomes;
mod real_ga;
mod records;
mod restarts;
#[cfg(feature = "serde")]
mod saved;
#[cfg(feature = "serde")]
mod saved_configurations;
mod scores;
mod seeds;
mod steady_state;
mod word_map;
