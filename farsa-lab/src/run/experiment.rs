//! An experiment as the command sees it: a name, a table of settings, and an evaluator.

use std::path::PathBuf;

use crate::error::Error;
use crate::experiment::evaluator::Evaluator;
use crate::experiment::settings::{Setting, Settings};
use crate::strategy::definition::StrategyDefinition;
use crate::strategy::truncation::Truncation;

/// An experiment that the `farsa` command lists, explains, runs, tests and replays.
///
/// The experiment defines its settings and the evaluation of parameters. The command adds evolution, threads, files,
/// checkpoints and replay. See the documentation of the crate for a complete example.
pub trait Experiment: Sync {
    /// The name on the command line and in the run directory: lower-case letters, digits and hyphens.
    fn name(&self) -> &'static str;

    /// Returns the question, in one line.
    fn summary(&self) -> &'static str;

    /// Returns the conditions to compare, the default one first. Empty for a single condition.
    fn conditions(&self) -> &'static [&'static str] {
        &[]
    }

    /// Grows by one whenever the same configuration, seed and genes earn another fitness.
    ///
    /// A run of another version is neither resumed nor replayed: its trials would be others.
    fn values_version(&self) -> u32 {
        1
    }

    /// Returns the default strategy of a condition. By default the truncation algorithm.
    fn strategy(&self, condition: &str) -> &'static dyn StrategyDefinition {
        let _ = condition;
        &Truncation
    }

    /// Returns every setting of the experiment under a condition (`""` without conditions), with its default.
    ///
    /// The command adds the settings of the [`strategy`](Self::strategy) (`evolution.*`). A setting here with the same
    /// key replaces the one there, which gives an experiment its own defaults.
    fn settings(&self, condition: &str) -> Vec<Setting>;

    /// Returns the files that trials depend on, such as sensor tables named by a setting. By default none.
    ///
    /// A run stores their checksums and refuses to resume, replay or test with changed files. Relative paths are
    /// relative to the current directory.
    ///
    /// # Errors
    /// [`Error::setting`] for a value that names no file.
    fn files(&self, condition: &str, settings: &Settings) -> Result<Vec<PathBuf>, Error> {
        let _ = (condition, settings);
        Ok(Vec::new())
    }

    /// The text of the file that describes it, where one does: a run keeps it with its configuration.
    fn definition(&self) -> Option<&str> {
        None
    }

    /// Bits of the genes that parameters are encoded in by strategies of bits, 1 to 16.
    fn gene_bits(&self) -> u32 {
        16
    }

    /// Builds what one thread evaluates trials by under a condition and checked settings.
    ///
    /// Called once for every thread. All evaluators must be equal.
    ///
    /// # Errors
    /// [`Error::setting`] for values that are each allowed but do not go together.
    fn prepare(&self, condition: &str, settings: &Settings) -> Result<Box<dyn Evaluator>, Error>;
}

/// An [`Experiment`] of a name, a line, conditions, a table and a function.
#[derive(Clone, Copy)]
pub struct SimpleExperiment {
    /// The name on the command line: lower-case letters, digits and hyphens.
    pub name: &'static str,
    /// Returns the question, in one line.
    pub summary: &'static str,
    /// Returns the conditions to compare, the default one first. Empty for a single condition.
    pub conditions: &'static [&'static str],
    /// Every setting with its default, under a condition.
    pub settings: fn(&str) -> Vec<Setting>,
    /// Builds what one thread evaluates trials by.
    pub prepare: fn(&Settings) -> Result<Box<dyn Evaluator>, Error>,
}

impl Experiment for SimpleExperiment {
    fn name(&self) -> &'static str {
        self.name
    }

    fn summary(&self) -> &'static str {
        self.summary
    }

    fn conditions(&self) -> &'static [&'static str] {
        self.conditions
    }

    fn settings(&self, condition: &str) -> Vec<Setting> {
        (self.settings)(condition)
    }

    fn prepare(&self, _: &str, settings: &Settings) -> Result<Box<dyn Evaluator>, Error> {
        (self.prepare)(settings)
    }
}
