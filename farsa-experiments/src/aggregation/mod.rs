//! The experiment `aggregation`: a team gathers on nests.
//!
//! - `baseline`: a robot that finds a nest without evolution, to compare evolved ones with
//! - `config`: the values of `aggregation`, as settings
//! - `experiment`: its name, conditions and settings, and what runs its trials
//! - `episode`: an episode of `aggregation`: robots look for nests, and for each other
//! - `measure`: how close together robots are

mod baseline;
mod config;
mod episode;
mod experiment;
mod measure;

pub use baseline::BeaconSeeker;
pub use config::AggregationConfig;
pub use episode::{AggregationEpisode, AggregationScenario};
pub use experiment::{Aggregation, aggregate};
pub use measure::{Gathering, mean_distances};
