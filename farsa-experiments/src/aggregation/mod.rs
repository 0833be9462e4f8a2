//! The experiment `aggregation`: a team gathers on nests.

/// A robot that finds a nest without evolution, to compare evolved ones with.
mod baseline;
/// The values of `aggregation`, as settings.
mod config;
/// An episode of `aggregation`: robots look for nests, and for each other.
mod episode;
/// Its name, conditions and settings, and what runs its trials.
mod experiment;
/// Spread and clusters of robots.
mod measure;

pub use baseline::BeaconSeeker;
pub use config::AggregationConfig;
pub use episode::{AggregationEpisode, AggregationScenario};
pub use experiment::{Aggregation, aggregate};
pub use measure::{Gathering, mean_distances};
