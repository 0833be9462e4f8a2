//! Runs: from a configuration to a champion, on all processors, to be gone on with at any time.
//!
//! - `begin`: how a run begins, and how it is taken up where its checkpoint left it
//! - `bench`: `farsa bench`: how fast trials run here, and how long a whole study would take
//! - `best_of_run`: the best of a run, for comparisons that the command does not make
//! - `collection`: what a strategy keeps beyond a generation, as a table and a picture
//! - `config_file`: a configuration file, and the settings of a command line
//! - `contained`: code of an experiment that panics, caught
//! - `diagnostics`: what a strategy says of each generation beside the fitness, as a table and a picture
//! - `evaluations`: who evaluates a generation: the threads and ranks of a run, or the workers of a page
//! - `evolve`: evolution from the first or any later generation on, with everything kept that is needed to go on
//! - `fitness`: the fitness of a generation: all trials of all individuals, and which of them failed
//! - `imported_file`: a file in another format as one that describes an experiment
//! - `laboratory`: the experiments and strategies that a command knows by name, [`Laboratory`]
//! - `following`: what a rank other than the first does in a run: it holds the same search and writes nothing
//! - `leading`: what ranks do around the generations of a run
//! - `plan`: what is to be run: an experiment, a condition, a seed and all settings
//! - `pool`: trials on several threads, with the same results on any number of them
//! - `progress`: what a waiting user sees: a bar on a terminal, plain lines elsewhere
//! - `queue`: runs that any number of processes work at: each takes the next one that nobody has
//! - `records`: the sealed files of a run: where to go on, what the strategy was told, who is best, and genotypes from elsewhere
//! - `replications`: `farsa run --replications`: one plan under one seed after the other, each in a directory of its own
//! - `progression`: a search in progress, the same on every rank of a run
//! - `summary`: what came of a run, for the command to tell
//! - `tests`: tests of whole runs with every strategy: what is selected, written, resumed and replayed
//! - `text_table`: tables for a terminal
//! - `told`: `record.bin`: what the strategy was told in every generation, and what came of it
//! - `world_choice`: which world an experiment runs in, where there is a choice

#[cfg(feature = "command")]
pub(crate) mod begin;
#[cfg(feature = "command")]
pub(crate) mod bench;
mod best_of_run;
#[cfg(feature = "command")]
pub(crate) mod collection;
pub(crate) mod config_file;
pub(crate) mod contained;
#[cfg(feature = "command")]
mod diagnostics;
pub(crate) mod evaluations;
#[cfg(feature = "command")]
pub(crate) mod evolve;
pub(crate) mod fitness;
#[cfg(feature = "command")]
pub(crate) mod following;
mod imported_file;
pub(crate) mod laboratory;
#[cfg(feature = "command")]
pub(crate) mod leading;
pub(crate) mod plan;
#[cfg(feature = "command")]
pub(crate) mod pool;
#[cfg(feature = "command")]
pub(crate) mod progress;
pub(crate) mod progression;
#[cfg(feature = "command")]
pub(crate) mod queue;
pub(crate) mod records;
#[cfg(feature = "command")]
pub(crate) mod replications;
#[cfg(feature = "command")]
pub(crate) mod summary;
#[cfg(all(test, feature = "command"))]
mod tests;
#[cfg(feature = "command")]
pub(crate) mod text_table;
#[cfg(feature = "command")]
pub(crate) mod told;
pub(crate) mod world_choice;

pub use best_of_run::BestOfRun;
pub use imported_file::{ImportedFile, LeftOut};
pub use laboratory::{ExperimentFiles, ImportExperiment, Laboratory, ReadExperiment, Template};
pub use world_choice::ENGINE;
