//! Trials after a run: tests, replays, pictures, genotypes from elsewhere.
//!
//! - `draw`: `farsa draw`: a moment of a trial as a picture, and a champion's for the report
//! - `evaluate`: `farsa evaluate`: a genotype from any source on random trials
//! - `genotypes`: Genotypes from elsewhere: the original's `.gen` files, and plain lists of genes
//! - `import`: `farsa import`: genotypes of the original FARSA as a directory that can be tested, replayed and drawn
//! - `lines`: `farsa evaluate --stdin`: JSON lines, parameters in and outcomes out, for optimisers in any language
//! - `populations`: For which of several populations something on the command line is
//! - `protocols`: `farsa test --protocol`: the champion in every case of a table
//! - `recorded`: the table of a test and its record, two files that belong together
//! - `replay`: `farsa replay`: a trial of the run again, step by step
//! - `replayed`: what a replay came to, and its page: of one run, or of two beside each other
//! - `test`: `farsa test`: the champion on starts that it has never met
//! - `test_table`: `test.csv`: a line per trial of a test, and what they say together

pub(crate) mod draw;
pub(crate) mod evaluate;
pub(crate) mod genotypes;
pub(crate) mod import;
pub(crate) mod lines;
pub(crate) mod populations;
pub(crate) mod protocols;
mod recorded;
pub(crate) mod replay;
pub(crate) mod replayed;
pub(crate) mod test;
pub(crate) mod test_table;

pub use genotypes::read_genotypes;
