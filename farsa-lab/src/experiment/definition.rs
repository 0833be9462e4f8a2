//! What an experiment is to the command: a name, a table of settings, and what evaluates parameters.

use std::path::PathBuf;

use crate::error::Error;
use crate::experiment::evaluator::Evaluator;
use crate::experiment::settings::{Setting, Settings};
use crate::strategy::definition::StrategyDefinition;
use crate::strategy::truncation::Truncation;

/// An experiment that the `farsa` command lists, explains, runs, tests and replays.
///
/// The experiment says what there is to set and how parameters are evaluated; the command brings evolution, threads, files,
/// checkpoints and replay. See the crate's documentation for a whole one.
pub trait Experiment: Sync {
    /// The name on the command line and in the run directory: lower-case letters, digits and hyphens.
    fn name(&self) -> &'static str;

    /// What is asked, in one line.
    fn summary(&self) -> &'static str;

    /// The conditions that are compared, the default one first; empty if there is only one.
    fn conditions(&self) -> &'static [&'static str] {
        &[]
    }

    /// Grows by one whenever the same configuration, seed and genes earn another fitness.
    ///
    /// A run of another version is neither resumed nor replayed: its trials would be others.
    fn values_version(&self) -> u32 {
        1
    }

    /// What a run searches with under a condition; by default the truncation algorithm.
    fn strategy(&self, condition: &str) -> &'static dyn StrategyDefinition {
        let _ = condition;
        &Truncation
    }

    /// Every setting of the experiment under a condition (`""` if there are none), with its default.
    ///
    /// The settings of the [`strategy`](Self::strategy) (`evolution.*`) are added by the command; a setting here with the same
    /// key replaces the one there, which is how an experiment has its own defaults.
    fn settings(&self, condition: &str) -> Vec<Setting>;

    /// The files whose content trials depend on, such as tables of sensors that a setting names; by default none.
    ///
    /// A run remembers their checksums and is neither resumed, replayed nor tested with other ones. Relative paths are
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
    /// Called once for every thread; all of them must evaluate alike.
    ///
    /// # Errors
    /// [`Error::setting`] for values that are each allowed but do not go together.
    fn prepare(&self, condition: &str, settings: &Settings) -> Result<Box<dyn Evaluator>, Error>;
}

/// An [`Experiment`] that is all said by its name, a line, its conditions, a table and a function.
#[derive(Clone, Copy)]
pub struct SimpleExperiment {
    /// The name on the command line: lower-case letters, digits and hyphens.
    pub name: &'static str,
    /// What is asked, in one line.
    pub summary: &'static str,
    /// The conditions that are compared, the default one first; empty if there is only one.
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
