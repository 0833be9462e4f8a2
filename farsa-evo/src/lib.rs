#![doc = include_str!("../README.md")]
#![no_std]
#![cfg_attr(docsrs, feature(doc_cfg))]
#![cfg_attr(test, allow(clippy::unwrap_used))]

extern crate alloc;

pub mod archives;
mod champion;
pub mod coevolution;
mod conformance;
pub mod covariance;
mod error;
mod fitness;
mod gene;
pub mod gradient;
pub mod pareto;
mod population;
pub mod prelude;
pub mod real;
mod recording;
#[cfg(feature = "serde")]
mod saved;
mod score_shape;
mod scores;
mod search;
mod snapshot;
mod statistics;
mod strategy;
mod vectors;
pub mod words;

pub use champion::Champion;
pub use conformance::check_strategy;
pub use error::EvoError;
pub use fitness::Fitness;
pub use gene::Gene;
pub use gradient::observation_statistics::ObservationStatistics;
pub use population::Population;
pub use recording::{Record, RecordEntry, RecordWriter};
pub use score_shape::ScoreShape;
pub use scores::Scores;
pub use search::Search;
pub use snapshot::Snapshot;
pub use statistics::Statistics;
pub use strategy::{Collection, Genealogy, Member, Opponents, RecordKind, Strategy};
