//! Runs: from a configuration to a champion, on all processors. A run can be interrupted and resumed at any time.

/// Creates the directory of a run and restores a search from its checkpoint.
#[cfg(feature = "command")]
pub(crate) mod begin;
/// `farsa bench`: measures trials per second and estimates the duration of a study.
#[cfg(feature = "command")]
pub(crate) mod bench;
/// Panics of an experiment's code, caught.
pub(crate) mod catch_panic;
/// Archive or front of a strategy, as a table and a picture.
#[cfg(feature = "command")]
pub(crate) mod collection;
/// A configuration file, and the settings of a command line.
pub(crate) mod config_file;
/// Rank 0 of a run: it sends commands to the workers and synchronizes all ranks.
#[cfg(feature = "command")]
pub(crate) mod coordinator;
/// Diagnostics of a strategy for each generation, as a table and a picture.
#[cfg(feature = "command")]
mod diagnostics;
/// Interface to what evaluates a generation: threads and ranks, or the workers of a page.
pub(crate) mod evaluation_backend;
/// Loop over generations, with saves.
#[cfg(feature = "command")]
pub(crate) mod evolve;
/// An experiment as the command sees it: a name, settings, and an evaluator.
pub(crate) mod experiment;
/// Fitness of a generation from the trials of all individuals.
pub(crate) mod fitness;
/// A file in another format, converted to a file that describes an experiment.
mod imported_file;
/// Experiments and strategies that a command finds by name.
pub(crate) mod laboratory;
/// Experiment, condition, seed and settings of a run.
pub(crate) mod plan;
/// A pool of threads that run trials.
#[cfg(feature = "command")]
pub(crate) mod pool;
/// An experiment for programs that evaluate, step and search by themselves.
#[cfg(feature = "command")]
mod problem;
/// Progress on a terminal or in plain lines.
#[cfg(feature = "command")]
pub(crate) mod progress;
/// Runs shared by any number of processes. Each process takes the next unclaimed run.
#[cfg(feature = "command")]
pub(crate) mod queue;
/// `record.bin`: the reported fitness of every generation.
pub(crate) mod record_file;
/// Checksummed files of a run: checkpoint, champions and imported genotypes.
pub(crate) mod records;
/// Makes the files of a run agree with its checkpoint.
#[cfg(feature = "command")]
mod recover;
/// `farsa run --replications`: one plan under consecutive seeds.
#[cfg(feature = "command")]
pub(crate) mod replications;
/// Genomes of a measurement.
#[cfg(feature = "command")]
pub(crate) mod sample;
/// State of a search, equal on every rank.
pub(crate) mod search_state;
/// Result of a run.
#[cfg(feature = "command")]
pub(crate) mod summary;
/// Tests of whole runs with every strategy.
#[cfg(all(test, feature = "command"))]
mod tests;
/// Tables for a terminal.
#[cfg(feature = "command")]
pub(crate) mod text_table;
/// Words that experiment files may use in addition to those of their format.
mod vocabulary;
/// Ranks except the first: they evaluate the same search and write no files.
#[cfg(feature = "command")]
pub(crate) mod worker;
/// Choice of world, where an experiment offers one.
pub(crate) mod world_choice;
/// Errors of a plan that cannot begin.
mod wrong_configuration;

pub use experiment::{Experiment, SimpleExperiment};
pub use imported_file::{ImportedFile, LeftOut};
pub use laboratory::{ExperimentFiles, ImportExperiment, Laboratory, ReadExperiment, Template};
#[cfg(feature = "command")]
pub use problem::{Evaluated, Problem, ProblemOptions, Search};
pub use vocabulary::{Part, Vocabulary};
pub use world_choice::ENGINE;
