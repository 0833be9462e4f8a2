//! Strategies as the command sees them, and the reconstruction of generations from their record.

/// A strategy over integer or real genes.
pub(crate) mod any_strategy;
/// Interface between a strategy and the command.
pub(crate) mod definition;
/// Competitive coevolution of two populations with generalist selection.
mod generalist;
/// Genomes and champions of past generations.
pub(crate) mod history;
/// Strategies that `--strategy` finds by name.
pub(crate) mod known;
/// One individual, trained by an iteration per generation.
mod learning;
/// Novelty search over the truncation algorithm.
mod novelty;
/// One parent and one mutant.
mod one_plus_one;
/// Opponents of an individual of one of several populations.
pub(crate) mod opponents;
/// Search without selection.
mod random;
/// Strategies over real genes.
mod reals;
/// Settings that strategies share, and an experiment's table with those of its strategy.
pub(crate) mod settings;
/// A strategy of a name, a line, a table and a function.
mod simple;
/// Truncation algorithm, in one population or several.
pub(crate) mod truncation;

pub use any_strategy::AnyStrategy;
pub use definition::{Diagnostics, DiagnosticsChart, StrategyDefinition, StrategyStart};
pub use known::strategies;
pub use learning::Learning;
pub use one_plus_one::OnePlusOne;
pub use simple::SimpleStrategy;
pub use truncation::Truncation;
