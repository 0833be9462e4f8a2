//! Shared parts of the fuzz targets.

/// A bound on the memory of a reader.
mod allocation;
/// The experiment whose runs the targets read.
mod experiment;
/// Models of robots that are the same.
mod models;
/// Changes of texts by the fuzzer.
mod mutation;
/// Readers and directories of runs by each strategy.
mod runs;
/// Directories in memory.
mod scratch;
/// Lengths, hashes and checksums that are right.
mod seal;

pub use allocation::{bounded, bounded_toml};
pub use experiment::{TUNE, laboratory, limits};
pub use models::same_model;
pub use mutation::mutated;
pub use runs::{configurations, selected, with_directory, with_run};
pub use scratch::Scratch;
pub use seal::{sealed_controller, sealed_file, sealed_head};
