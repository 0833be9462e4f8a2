//! What the command has to know of a strategy.

use farsa_evo::Strategy;

use crate::error::Error;
use crate::experiment::evaluator::Evaluator;
use crate::experiment::settings::{Setting, Settings};

/// A strategy as the command knows it: a name, a table of settings and a function that makes one.
///
/// The strategy itself is a [`farsa_evo::Strategy`]: three methods. With both traits the command runs it, writes its
/// checkpoints, goes on after an interruption, and replays any individual of any generation. An experiment names the one it
/// is run with, [`Experiment::strategy`](crate::Experiment::strategy); [`WithStrategy`](crate::WithStrategy) gives it
/// another.
///
/// ```
/// use std::process::ExitCode;
///
/// use farsa_evo::{RandomSearch, Strategy};
/// use farsa_lab::{Error, Experiment, Setting, StrategyDefinition, StrategyStart, WithStrategy, cli};
///
/// /// A generation of guesses after the other.
/// struct Guessing;
///
/// impl StrategyDefinition for Guessing {
///     fn name(&self) -> &'static str {
///         "guessing"
///     }
///     fn settings(&self) -> Vec<Setting> {
///         vec![
///             Setting::whole("evolution.generations", 100, 1..=1_000_000).doc("Generations."),
///             Setting::whole("evolution.population", 50, 1..=1000).doc("Guesses of a generation."),
///         ]
///     }
///     fn start(&self, start: &StrategyStart<'_>) -> Result<Box<dyn Strategy>, Error> {
///         let population = start.settings.count("evolution.population")?;
///         let search = RandomSearch::new(start.genes, population, start.seed);
///         Ok(Box::new(search.map_err(|error| Error::Other(error.to_string()))?))
///     }
/// }
///
/// /// The command over an experiment, with its own strategy and with this one.
/// fn command(experiment: impl Experiment + Copy) -> ExitCode {
///     cli::main(&[&experiment, &WithStrategy::new("by-guessing", experiment, &Guessing)])
/// }
/// ```
pub trait StrategyDefinition: Sync {
    /// The name: lower-case letters, digits and hyphens.
    fn name(&self) -> &'static str;

    /// Its settings with their defaults, `evolution.generations` among them; an experiment may have other defaults.
    fn settings(&self) -> Vec<Setting>;

    /// Makes the strategy, at its first generation.
    ///
    /// # Errors
    /// [`Error::setting`] for values that do not go together, [`Error::Other`] for a problem that it cannot search.
    fn start(&self, start: &StrategyStart<'_>) -> Result<Box<dyn Strategy>, Error>;

    /// How [`Strategy::diagnostics`] are written and drawn, where the strategy has some.
    fn diagnostics(&self) -> Option<Diagnostics> {
        None
    }
}

/// What a strategy is made for.
#[derive(Clone, Copy)]
#[non_exhaustive]
pub struct StrategyStart<'s> {
    /// Number of populations.
    pub populations: usize,
    /// Genes of an individual, one for each parameter of the experiment.
    pub genes: usize,
    /// Bits of a gene, 1 to 16.
    pub gene_bits: u32,
    /// The settings of the run.
    pub settings: &'s Settings,
    /// The seed of the run.
    pub seed: u64,
    /// Builds an evaluator of the run, for a strategy that evaluates something itself.
    pub evaluator: &'s dyn Fn() -> Result<Box<dyn Evaluator>, Error>,
}

/// A table of numbers about each generation that a strategy tells beside the fitness, `FILE.csv`, and its picture, `FILE.svg`.
#[derive(Clone, Copy, Debug)]
pub struct Diagnostics {
    /// The name of both files without its end.
    pub file: &'static str,
    /// The pictures, one below the other; their curves in this order are the columns.
    pub charts: &'static [DiagnosticsChart],
}

/// One picture of [`Diagnostics`].
#[derive(Clone, Copy, Debug)]
pub struct DiagnosticsChart {
    /// The title, after the name of the run.
    pub title: &'static str,
    /// What the vertical axis shows.
    pub axis: &'static str,
    /// For each curve the name of its column and its label.
    pub curves: &'static [(&'static str, &'static str)],
}
