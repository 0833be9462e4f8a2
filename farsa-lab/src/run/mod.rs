//! Runs: from a configuration to a champion, on all processors, to be gone on with at any time.
//!
//! - `arguments`: the words of the command line that several commands share
//! - `bench`: `farsa bench`: how fast lives are lived here, and how long a whole study would take
//! - `best_of_run`: the best of a run, for comparisons that the command does not make
//! - `config_file`: a configuration file, and the settings of a command line
//! - `evolve`: evolution from the first or any later generation on, with everything kept that is needed to go on
//! - `plan`: what is to be run: an experiment, a condition, a seed and all settings
//! - `pool`: lives on several threads, with results that no thread can be told from
//! - `progress`: what a waiting user sees: a bar on a terminal, plain lines elsewhere
//! - `records`: the sealed files of a run: where to go on, who descends from whom, who is best, and genotypes from elsewhere
//! - `replications`: `farsa run --replications`: one plan under one seed after the other, each in a directory of its own
//! - `summary`: what came of a run, for the command to tell
//! - `tests`: tests of whole runs by every search: what is selected, written, resumed and lived again
//! - `world_choice`: which world an experiment is lived in, where there is a choice

pub(crate) mod arguments;
pub(crate) mod bench;
mod best_of_run;
pub(crate) mod config_file;
pub(crate) mod evolve;
pub(crate) mod plan;
pub(crate) mod pool;
pub(crate) mod progress;
pub(crate) mod records;
pub(crate) mod replications;
pub(crate) mod summary;
#[cfg(test)]
mod tests;
pub(crate) mod world_choice;

pub use best_of_run::BestOfRun;
pub use world_choice::ENGINE;
