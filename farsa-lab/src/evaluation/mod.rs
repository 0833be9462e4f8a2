//! Trials after a run: tests, replays, pictures, external genotypes.

/// `farsa draw`: a moment of a trial as a picture, and the champion's picture for the report.
#[cfg(feature = "command")]
pub(crate) mod draw;
/// `farsa evaluate`: a genotype from any source on random trials.
#[cfg(feature = "command")]
pub(crate) mod evaluate;
/// Summary of the trials of a test.
#[cfg(feature = "command")]
pub(crate) mod findings;
/// `test-generations.csv`: the best of every n-th generation on fresh starts.
#[cfg(feature = "command")]
pub(crate) mod generations;
/// External genotypes: `.gen` files of the 2013 program, and plain lists of genes.
pub(crate) mod genotypes;
/// `farsa import`: genotypes of the 2013 program as a directory for tests, replays and pictures.
#[cfg(feature = "command")]
pub(crate) mod import;
/// `farsa evaluate --stdin`: JSON lines, parameters in and outcomes out, for optimizers in any language.
#[cfg(feature = "command")]
pub(crate) mod lines;
/// Memory use of recordings.
#[cfg(feature = "command")]
mod memory_budget;
/// Population that a part of the command line refers to.
#[cfg(feature = "command")]
pub(crate) mod populations;
/// `farsa test --protocol`: the champion in every case of a table.
#[cfg(feature = "command")]
pub(crate) mod protocols;
/// Table of a test and its record, two files that belong together.
#[cfg(feature = "command")]
mod recorded;
/// `farsa replay`: a trial of the run again, step by step.
#[cfg(feature = "command")]
pub(crate) mod replay;
/// Result of a replay, and its page.
#[cfg(feature = "command")]
pub(crate) mod replayed;
/// `farsa test`: the champion on fresh starts.
#[cfg(feature = "command")]
pub(crate) mod test;
/// `test.csv`: one line per trial of a test, and its summary.
#[cfg(feature = "command")]
pub(crate) mod test_table;
/// Changes of replayed trials.
#[cfg(feature = "command")]
pub(crate) mod trial_changes;
/// Trials of a test, and their outcomes in numbers and words.
pub(crate) mod trials;

pub use genotypes::read_genotypes;
#[cfg(feature = "command")]
pub use test_table::TestTrial;
