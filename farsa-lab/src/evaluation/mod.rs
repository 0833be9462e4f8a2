//! Trials after a run: tests, replays, pictures, genotypes from elsewhere.
//!
//! - `draw`: `farsa draw`: a moment of a trial as a picture, and a champion's for the report
//! - `evaluate`: `farsa evaluate`: a genotype from any source on random trials
//! - `genotypes`: Genotypes from elsewhere: the original's `.gen` files, and plain lists of genes
//! - `import`: `farsa import`: genotypes of the original FARSA as a directory that can be tested, replayed and drawn
//! - `kept`: how much of the memory recordings take
//! - `lines`: `farsa evaluate --stdin`: JSON lines, parameters in and outcomes out, for optimisers in any language
//! - `populations`: For which of several populations something on the command line is
//! - `protocols`: `farsa test --protocol`: the champion in every case of a table
//! - `recorded`: the table of a test and its record, two files that belong together
//! - `replay`: `farsa replay`: a trial of the run again, step by step
//! - `replayed`: what a replay came to, and its page: of one run, or of two beside each other
//! - `test`: `farsa test`: the champion on starts that it has never met
//! - `trials`: what a trial of a test is, and what came of one, in numbers and in words
//! - `test_table`: `test.csv`: a line per trial of a test, and what they say together

#[cfg(feature = "command")]
pub(crate) mod draw;
#[cfg(feature = "command")]
pub(crate) mod evaluate;
pub(crate) mod genotypes;
#[cfg(feature = "command")]
pub(crate) mod import;
#[cfg(feature = "command")]
mod kept;
#[cfg(feature = "command")]
pub(crate) mod lines;
#[cfg(feature = "command")]
pub(crate) mod populations;
#[cfg(feature = "command")]
pub(crate) mod protocols;
#[cfg(feature = "command")]
mod recorded;
#[cfg(feature = "command")]
pub(crate) mod replay;
#[cfg(feature = "command")]
pub(crate) mod replayed;
#[cfg(feature = "command")]
pub(crate) mod test;
#[cfg(feature = "command")]
pub(crate) mod test_table;
pub(crate) mod trials;

pub use genotypes::read_genotypes;
#[cfg(feature = "command")]
pub use test_table::TestTrial;
