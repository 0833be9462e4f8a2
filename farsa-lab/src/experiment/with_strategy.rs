//! An experiment with another strategy than its own.

use std::path::PathBuf;

use crate::error::Error;
use crate::experiment::definition::Experiment;
use crate::experiment::evaluator::Evaluator;
use crate::experiment::settings::{Setting, Settings};
use crate::strategy::definition::StrategyDefinition;

/// An experiment under a name of its own, run with another strategy than its own: for comparisons, and for strategies of
/// other crates.
///
/// The experiment's own defaults of `evolution.*` settings stay where the strategy has a setting of the same key, and go where
/// it has not.
#[derive(Clone, Copy)]
pub struct WithStrategy<E> {
    name: &'static str,
    experiment: E,
    strategy: &'static dyn StrategyDefinition,
}

impl<E: Experiment> WithStrategy<E> {
    /// The experiment under this name and with this strategy.
    pub fn new(name: &'static str, experiment: E, strategy: &'static dyn StrategyDefinition) -> Self {
        Self { name, experiment, strategy }
    }
}

impl<E: Experiment> Experiment for WithStrategy<E> {
    fn name(&self) -> &'static str {
        self.name
    }

    fn summary(&self) -> &'static str {
        self.experiment.summary()
    }

    fn conditions(&self) -> &'static [&'static str] {
        self.experiment.conditions()
    }

    fn values_version(&self) -> u32 {
        self.experiment.values_version()
    }

    fn strategy(&self, _: &str) -> &'static dyn StrategyDefinition {
        self.strategy
    }

    fn settings(&self, condition: &str) -> Vec<Setting> {
        let theirs = self.strategy.settings();
        let known = |setting: &Setting| {
            !setting.key().starts_with("evolution.") || theirs.iter().any(|other| other.key() == setting.key())
        };
        self.experiment.settings(condition).into_iter().filter(known).collect()
    }

    fn files(&self, condition: &str, settings: &Settings) -> Result<Vec<PathBuf>, Error> {
        self.experiment.files(condition, settings)
    }

    fn gene_bits(&self) -> u32 {
        self.experiment.gene_bits()
    }

    fn prepare(&self, condition: &str, settings: &Settings) -> Result<Box<dyn Evaluator>, Error> {
        self.experiment.prepare(condition, settings)
    }
}
