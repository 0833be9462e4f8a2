//! What a run searches with: strategies as the command knows them, and what is rebuilt from their record.
//!
//! - `definition`: what the command has to know of a strategy, [`StrategyDefinition`]
//! - `settings`: the settings that strategies share, and the table of an experiment with those of its strategy
//! - `truncation`: the truncation algorithm, in one population or several
//! - `one_plus_one`: one parent and one mutant
//! - `learning`: one individual, which is trained by an iteration after each generation
//! - `history`: the genomes and champions of past generations
//! - `opponents`: whom an individual of one of several populations meets, in a run and when a trial is replayed

pub(crate) mod definition;
pub(crate) mod history;
mod learning;
mod one_plus_one;
pub(crate) mod opponents;
pub(crate) mod settings;
pub(crate) mod truncation;

pub use definition::{Diagnostics, DiagnosticsChart, StrategyDefinition, StrategyStart};
pub use learning::Learning;
pub use one_plus_one::OnePlusOne;
pub use truncation::Truncation;
