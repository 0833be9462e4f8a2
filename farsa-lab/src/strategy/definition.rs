//! Interface between a strategy and the command.

use farsa_evo::coevolution::Populations;
use farsa_evo::{EvoError, Snapshot, Strategy};

use crate::error::Error;
use crate::experiment::evaluator::Evaluator;
use crate::experiment::settings::{Setting, Settings};
use crate::limits::Limits;
use crate::strategy::any_strategy::AnyStrategy;
use crate::strategy::settings::NORMALISE;

/// Describes a strategy to the command, with its name, its settings and a constructor.
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
    /// Name of the strategy, made of lowercase letters, digits and hyphens.
    fn name(&self) -> &'static str;

    /// Short description of the method and its source, in one line. This is empty by default.
    fn summary(&self) -> &'static str {
        ""
    }

    /// Lists the settings with their defaults.
    ///
    /// They must include `evolution.generations`. Note that an experiment may choose other defaults.
    fn settings(&self) -> Vec<Setting>;

    /// Creates the strategy at its first generation.
    ///
    /// # Errors
    /// Return [`Error::setting`] if values contradict each other, and [`Error::Other`] if the strategy does not support
    /// the problem.
    fn start(&self, start: &StrategyStart<'_>) -> Result<AnyStrategy, Error>;

    /// Checks whether observations should be normalized, using those of all previous generations.
    ///
    /// This has no effect unless the experiment supports it ([`TaskInfo::observations`](crate::TaskInfo::observations)).
    /// By default it is the value of the setting `strategy.normalise_observations`, if there is one.
    fn normalises_observations(&self, settings: &Settings) -> bool {
        settings.has(NORMALISE) && settings.flag(NORMALISE).unwrap_or(false)
    }

    /// Describes the files and charts for [`Strategy::diagnostics`], if there are any.
    fn diagnostics(&self) -> Option<Diagnostics> {
        None
    }
}

/// A problem for a strategy to solve, as passed to [`StrategyDefinition::start`].
#[derive(Clone, Copy)]
#[non_exhaustive]
pub struct StrategyStart<'s> {
    /// Number of populations.
    pub populations: usize,
    /// Number of trials per evaluation.
    pub trials: usize,
    /// Number of genes of an individual, with one gene for each parameter of the experiment.
    pub genes: usize,
    /// Number of bits of a gene, from 1 to 16.
    pub gene_bits: u32,
    /// Number of objectives of the experiment. This includes the fitness.
    pub objectives: usize,
    /// Ranges of the measures of behavior, low to high.
    pub measures: &'s [[f64; 2]],
    /// Settings of the run.
    pub settings: &'s Settings,
    /// Seed of the run.
    pub seed: u64,
    /// Builds an evaluator of the run. Use this only if your strategy evaluates something by itself.
    pub evaluator: &'s dyn Fn() -> Result<Box<dyn Evaluator>, Error>,
    /// Limits of the run.
    pub limits: Limits,
}

impl StrategyStart<'_> {
    /// Gets the ranges of the measures, for strategies that cannot work without them.
    ///
    /// # Errors
    /// Returns [`Error::Other`] with the name of the strategy if the experiment has no measures.
    pub fn wanted_measures(&self, strategy: &str) -> Result<&[[f64; 2]], Error> {
        match self.measures {
            [] => Err(Error::Other(format!("says nothing of behaviour, which `{strategy}` wants"))),
            ranges => Ok(ranges),
        }
    }

    /// Gets the number of objectives, for strategies that need more than one.
    ///
    /// # Errors
    /// Returns [`Error::Other`] with the name of the strategy if the fitness is the only objective.
    pub fn wanted_objectives(&self, strategy: &str) -> Result<usize, Error> {
        match self.objectives {
            0 | 1 => Err(Error::Other(format!("has its fitness alone, where `{strategy}` wants several objectives"))),
            several => Ok(several),
        }
    }

    /// Creates a search over integer genes.
    ///
    /// The closure `search` builds the strategy of each population from a seed.
    ///
    /// # Errors
    /// If the closure fails, this returns the text of its [`EvoError`] as [`Error::Setting`], or as
    /// [`Error::Usage`] if it is about no setting.
    pub fn words<S>(&self, search: impl Fn(u64) -> Result<S, EvoError>) -> Result<AnyStrategy, Error>
    where
        S: Strategy + Snapshot + Send + 'static,
    {
        Ok(if self.populations == 1 {
            AnyStrategy::from_words(search(self.seed).map_err(|error| self.refused(&error))?)
        } else {
            AnyStrategy::from_words(
                Populations::new(self.populations, self.seed, search).map_err(|error| self.refused(&error))?,
            )
        })
    }

    /// Converts an error about the values of the settings. It has the key of a value that is a setting.
    fn refused(&self, error: &EvoError) -> Error {
        let (EvoError::OutOfRange { field, .. } | EvoError::Config { field, .. }) = error else {
            return Error::Usage(error.to_string());
        };
        let of_strategy = |key: &&str| key.starts_with("evolution.") || key.starts_with("strategy.");
        let mut keys = self.settings.table().iter().map(Setting::key).filter(of_strategy);
        match keys.find(|key| key.rsplit('.').next() == Some(field)) {
            Some(key) => Error::setting(key, error),
            None => Error::Usage(error.to_string()),
        }
    }

    /// Creates a search over real numbers.
    ///
    /// The closure `search` builds the strategy of each population from a seed.
    ///
    /// # Errors
    /// If the closure fails, this returns the text of its [`EvoError`] as [`Error::Setting`], or as
    /// [`Error::Usage`] if it is about no setting.
    pub fn reals<S>(&self, search: impl Fn(u64) -> Result<S, EvoError>) -> Result<AnyStrategy, Error>
    where
        S: Strategy<f64> + Snapshot + Send + 'static,
    {
        Ok(if self.populations == 1 {
            AnyStrategy::from_reals(search(self.seed).map_err(|error| self.refused(&error))?)
        } else {
            AnyStrategy::from_reals(
                Populations::new(self.populations, self.seed, search).map_err(|error| self.refused(&error))?,
            )
        })
    }
}

/// A table with numbers of a strategy for each generation.
///
/// It is written to `FILE.csv`, and drawn in `FILE.svg`.
#[derive(Clone, Copy, Debug)]
pub struct Diagnostics {
    /// Name of both files, without the extension.
    pub file: &'static str,
    /// Charts from top to bottom. This is also the order of the columns.
    pub charts: &'static [DiagnosticsChart],
}

/// A single chart of [`Diagnostics`].
#[derive(Clone, Copy, Debug)]
pub struct DiagnosticsChart {
    /// Title of the chart, which is shown after the name of the run.
    pub title: &'static str,
    /// Title of the vertical axis.
    pub axis: &'static str,
    /// Pairs of a column name and a label, one for each curve.
    pub curves: &'static [(&'static str, &'static str)],
}
