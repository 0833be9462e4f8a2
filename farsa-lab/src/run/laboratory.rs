//! The experiments and strategies that a command knows by name.

use crate::error::Error;
use crate::experiment::definition::Experiment;
use crate::strategy::definition::StrategyDefinition;
use crate::strategy::known;

/// Experiments and strategies by name: what the command is over.
///
/// ```no_run
/// use std::process::ExitCode;
///
/// use farsa_lab::{Experiment, Laboratory, StrategyDefinition};
///
/// fn command(experiments: &[&dyn Experiment], mine: &'static dyn StrategyDefinition) -> ExitCode {
///     Laboratory::new(experiments).with_strategy(mine).main()
/// }
/// ```
#[derive(Clone)]
pub struct Laboratory<'e> {
    experiments: Vec<&'e dyn Experiment>,
    strategies: Vec<&'static dyn StrategyDefinition>,
}

impl<'e> Laboratory<'e> {
    /// These experiments, in the order in which they are listed, with the strategies of this crate.
    pub fn new(experiments: &[&'e dyn Experiment]) -> Self {
        Self { experiments: experiments.to_vec(), strategies: known::strategies().to_vec() }
    }

    /// Adds a strategy for `--strategy NAME`; one of the same name goes.
    #[must_use]
    pub fn with_strategy(mut self, strategy: &'static dyn StrategyDefinition) -> Self {
        self.strategies.retain(|other| other.name() != strategy.name());
        self.strategies.push(strategy);
        self
    }

    /// The experiments.
    pub fn experiments(&self) -> &[&'e dyn Experiment] {
        &self.experiments
    }

    /// The strategies.
    pub fn strategies(&self) -> &[&'static dyn StrategyDefinition] {
        &self.strategies
    }

    /// The experiment of a name, which stands at `place`.
    ///
    /// # Errors
    /// [`Error::Unknown`] with the nearest name.
    pub(crate) fn experiment(&self, name: &str, place: &str) -> Result<&'e dyn Experiment, Error> {
        let names = self.experiments.iter().map(|experiment| experiment.name());
        let found = self.experiments.iter().copied().find(|experiment| experiment.name() == name);
        found.ok_or_else(|| Error::unknown(place, "experiment", name, names))
    }

    /// The strategy of a name, which stands at `place`.
    ///
    /// # Errors
    /// [`Error::Unknown`] with the nearest name.
    pub(crate) fn strategy(&self, name: &str, place: &str) -> Result<&'static dyn StrategyDefinition, Error> {
        known::find(&self.strategies, name, place)
    }
}
