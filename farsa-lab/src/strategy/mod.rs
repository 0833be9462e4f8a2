//! What a run searches with: strategies as the command knows them, and what is rebuilt from their record.
//!
//! - `definition`: what the command has to know of a strategy, [`StrategyDefinition`]
//! - `search`: a strategy, whatever its genes are, [`Search`]
//! - `simple`: a strategy that is all said by its name, a line, a table and a function, [`SimpleStrategy`]
//! - `known`: the strategies that a run may be asked for by name, [`strategies`]
//! - `settings`: the settings that strategies share, and the table of an experiment with those of its strategy
//! - `truncation`: the truncation algorithm, in one population or several
//! - `one_plus_one`: one parent and one mutant
//! - `random`: search without selection
//! - `novelty`: novelty search over the truncation algorithm
//! - `generalist`: competitive co-evolution of two populations with generalist selection
//! - `reals`: strategies over real genes
//! - `learning`: one individual, which is trained by an iteration after each generation
//! - `history`: the genomes and champions of past generations
//! - `opponents`: whom an individual of one of several populations meets, in a run and when a trial is replayed

pub(crate) mod definition;
mod generalist;
pub(crate) mod history;
pub(crate) mod known;
mod learning;
mod novelty;
mod one_plus_one;
pub(crate) mod opponents;
mod random;
mod reals;
pub(crate) mod search;
pub(crate) mod settings;
mod simple;
pub(crate) mod truncation;

pub use definition::{Diagnostics, DiagnosticsChart, StrategyDefinition, StrategyStart};
pub use known::strategies;
pub use learning::Learning;
pub use one_plus_one::OnePlusOne;
pub use search::Search;
pub use simple::SimpleStrategy;
pub use truncation::Truncation;
