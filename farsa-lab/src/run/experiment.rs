//! An experiment as the command sees it: a name, a table of settings, and an evaluator.

use std::path::PathBuf;

use crate::error::Error;
use crate::experiment::evaluator::Evaluator;
use crate::experiment::settings::{Setting, Settings};
use crate::strategy::definition::StrategyDefinition;
use crate::strategy::truncation::Truncation;

/// An experiment that you can list, explain, run, test and replay using the `farsa` command.
///
/// You only need to define its settings, and how parameters are evaluated. Evolution, threads, files, checkpoints and
/// replay are provided by the command. See the documentation of the crate for a complete example. For simple
/// experiments, you can use [`SimpleExperiment`] instead of implementing this trait.
pub trait Experiment: Sync {
    /// Name on the command line and in the run directory. It may contain lower-case letters, digits and hyphens.
    fn name(&self) -> &'static str;

    /// Question of the experiment, in one line.
    fn summary(&self) -> &'static str;

    /// Conditions to compare, starting with the default one. This is empty for a single condition.
    fn conditions(&self) -> &'static [&'static str] {
        &[]
    }

    /// Version of the values. Increase it by one whenever the same configuration, seed and genes get a different
    /// fitness.
    ///
    /// Runs of another version are neither resumed nor replayed, because their trials would differ.
    fn values_version(&self) -> u32 {
        1
    }

    /// Default strategy of a condition. If you don't override this, it is the truncation algorithm.
    fn strategy(&self, condition: &str) -> &'static dyn StrategyDefinition {
        let _ = condition;
        &Truncation
    }

    /// Builds the table of all settings of a condition, with their defaults. If there are no conditions, `condition`
    /// is `""`.
    ///
    /// The command adds the settings of the [`strategy`](Self::strategy) (`evolution.*`). You can replace them by
    /// settings with the same key, for example to change their defaults.
    fn settings(&self, condition: &str) -> Vec<Setting>;

    /// Lists the files on which trials depend, such as sensor tables named by a setting. By default this list is empty.
    ///
    /// A run stores their checksums. If such a file has changed, the run can't be resumed, replayed or tested.
    /// Relative paths start at the current directory.
    ///
    /// # Errors
    /// Returns [`Error::setting`] for a value that does not name a file.
    fn files(&self, condition: &str, settings: &Settings) -> Result<Vec<PathBuf>, Error> {
        let _ = (condition, settings);
        Ok(Vec::new())
    }

    /// Text of the file that describes the experiment, if there is one. Runs store it together with their
    /// configuration.
    fn definition(&self) -> Option<&str> {
        None
    }

    /// Place at which a file chooses the strategy, for errors about it, for example `my.toml line 3`. By default empty.
    fn strategy_place(&self) -> String {
        String::new()
    }

    /// Number of bits of each gene, from 1 to 16. This only matters for strategies with integer genes.
    fn gene_bits(&self) -> u32 {
        16
    }

    /// Builds an evaluator for a single thread, under a condition and with valid settings.
    ///
    /// This is called once for every thread, and all evaluators must be equal.
    ///
    /// # Errors
    /// Returns [`Error::setting`] if values are valid by themselves, but contradict each other.
    fn prepare(&self, condition: &str, settings: &Settings) -> Result<Box<dyn Evaluator>, Error>;
}

/// A simple [`Experiment`] that is given by a few constants and functions.
#[derive(Clone, Copy)]
pub struct SimpleExperiment {
    /// Name on the command line. It may contain lower-case letters, digits and hyphens.
    pub name: &'static str,
    /// Question of the experiment, in one line.
    pub summary: &'static str,
    /// Conditions to compare, starting with the default one. Leave this empty for a single condition.
    pub conditions: &'static [&'static str],
    /// Builds the table of all settings of a condition, with their defaults.
    pub settings: fn(&str) -> Vec<Setting>,
    /// Builds an evaluator for a single thread.
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
