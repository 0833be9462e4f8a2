//! The interface between a strategy and the command.

use farsa_evo::coevolution::Populations;
use farsa_evo::{EvoError, Snapshot, Strategy};

use crate::error::Error;
use crate::experiment::evaluator::Evaluator;
use crate::experiment::settings::{Setting, Settings};
use crate::limits::Limits;
use crate::strategy::any_strategy::AnyStrategy;
use crate::strategy::settings::NORMALISE;

/// A strategy as the command sees it: a name, a table of settings and a constructor.
///
/// The strategy itself is a [`farsa_evo::Strategy`] of three methods. With both traits the command runs it, writes its
/// checkpoints, resumes it, and replays any individual of any generation.
/// [`Experiment::strategy`](crate::Experiment::strategy) names the default of an experiment. `--strategy NAME` selects
/// another of [`strategies`](crate::strategy::strategies) or of [`Laboratory::with_strategy`](crate::Laboratory::with_strategy).
///
/// ```
/// use std::process::ExitCode;
///
/// use farsa_evo::words::RandomSearch;
/// use farsa_lab::{Error, Experiment, Laboratory, Setting};
/// use farsa_lab::strategy::{AnyStrategy, StrategyDefinition, StrategyStart};
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
///     fn start(&self, start: &StrategyStart<'_>) -> Result<AnyStrategy, Error> {
///         let population = start.settings.count("evolution.population")?;
///         start.words(|seed| RandomSearch::new(start.genes, population, seed))
///     }
/// }
///
/// /// The command over an experiment, which runs it by `--strategy guessing` too.
/// fn command(experiment: impl Experiment) -> ExitCode {
///     Laboratory::new(&[&experiment]).with_strategy(&Guessing).main()
/// }
/// ```
pub trait StrategyDefinition: Sync {
    /// The name: lower-case letters, digits and hyphens.
    fn name(&self) -> &'static str;

    /// Returns the method in one line with its source. By default empty.
    fn summary(&self) -> &'static str {
        ""
    }

    /// Returns the settings with their defaults, `evolution.generations` among them. An experiment may have other
    /// defaults.
    fn settings(&self) -> Vec<Setting>;

    /// Makes the strategy, at its first generation.
    ///
    /// # Errors
    /// [`Error::setting`] for values that do not go together, [`Error::Other`] for a problem that it cannot search.
    fn start(&self, start: &StrategyStart<'_>) -> Result<AnyStrategy, Error>;

    /// Returns whether observations are normalized by those of all previous generations, if the experiment can
    /// ([`TaskInfo::observations`](crate::TaskInfo::observations)). By default the value of the setting
    /// `strategy.normalise_observations`, if there is one.
    fn normalises_observations(&self, settings: &Settings) -> bool {
        settings.has(NORMALISE) && settings.flag(NORMALISE).unwrap_or(false)
    }

    /// Returns the form of [`Strategy::diagnostics`] in files and pictures, if there are any.
    fn diagnostics(&self) -> Option<Diagnostics> {
        None
    }
}

/// The problem that a strategy is built for.
#[derive(Clone, Copy)]
#[non_exhaustive]
pub struct StrategyStart<'s> {
    /// Number of populations.
    pub populations: usize,
    /// Trials of an evaluation.
    pub trials: usize,
    /// Genes of an individual, one for each parameter of the experiment.
    pub genes: usize,
    /// Bits of a gene, 1 to 16.
    pub gene_bits: u32,
    /// Objectives that the experiment names, the fitness among them.
    pub objectives: usize,
    /// Ranges of the measures of behavior, low to high.
    pub measures: &'s [[f64; 2]],
    /// The settings of the run.
    pub settings: &'s Settings,
    /// The seed of the run.
    pub seed: u64,
    /// Builds an evaluator of the run, for a strategy that evaluates something itself.
    pub evaluator: &'s dyn Fn() -> Result<Box<dyn Evaluator>, Error>,
    /// Limits of the run.
    pub limits: Limits,
}

impl StrategyStart<'_> {
    /// Returns the ranges of the measures, for a strategy of this name.
    ///
    /// # Errors
    /// [`Error::Other`] for an experiment without measures.
    pub fn wanted_measures(&self, strategy: &str) -> Result<&[[f64; 2]], Error> {
        match self.measures {
            [] => Err(Error::Other(format!("says nothing of behaviour, which `{strategy}` wants"))),
            ranges => Ok(ranges),
        }
    }

    /// The number of objectives, more than one, for a strategy of this name.
    ///
    /// # Errors
    /// [`Error::Other`] for an experiment with its fitness alone.
    pub fn wanted_objectives(&self, strategy: &str) -> Result<usize, Error> {
        match self.objectives {
            0 | 1 => Err(Error::Other(format!("has its fitness alone, where `{strategy}` wants several objectives"))),
            several => Ok(several),
        }
    }

    /// A search over words of each population by the strategy that `search` makes of a seed.
    ///
    /// # Errors
    /// [`Error::Usage`] with the text of [`EvoError`].
    pub fn words<S>(&self, search: impl Fn(u64) -> Result<S, EvoError>) -> Result<AnyStrategy, Error>
    where
        S: Strategy + Snapshot + 'static,
    {
        Ok(if self.populations == 1 {
            AnyStrategy::from_words(search(self.seed).map_err(|error| refused(&error))?)
        } else {
            AnyStrategy::from_words(
                Populations::new(self.populations, self.seed, search).map_err(|error| refused(&error))?,
            )
        })
    }

    /// A search over reals of each population by the strategy that `search` makes of a seed.
    ///
    /// # Errors
    /// [`Error::Usage`] with the text of [`EvoError`].
    pub fn reals<S>(&self, search: impl Fn(u64) -> Result<S, EvoError>) -> Result<AnyStrategy, Error>
    where
        S: Strategy<f64> + Snapshot + 'static,
    {
        Ok(if self.populations == 1 {
            AnyStrategy::from_reals(search(self.seed).map_err(|error| refused(&error))?)
        } else {
            AnyStrategy::from_reals(
                Populations::new(self.populations, self.seed, search).map_err(|error| refused(&error))?,
            )
        })
    }
}

/// Converts an error about the values of a strategy's settings.
fn refused(error: &EvoError) -> Error {
    Error::Usage(error.to_string())
}

/// A table of a strategy's numbers about each generation, `FILE.csv`, and its picture, `FILE.svg`.
#[derive(Clone, Copy, Debug)]
pub struct Diagnostics {
    /// The name of both files without its end.
    pub file: &'static str,
    /// Pictures, top to bottom. Their curves in this order are the columns.
    pub charts: &'static [DiagnosticsChart],
}

/// One picture of [`Diagnostics`].
#[derive(Clone, Copy, Debug)]
pub struct DiagnosticsChart {
    /// The title, after the name of the run.
    pub title: &'static str,
    /// Title of the vertical axis.
    pub axis: &'static str,
    /// For each curve the name of its column and its label.
    pub curves: &'static [(&'static str, &'static str)],
}
