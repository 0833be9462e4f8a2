//! Errors of a plan that cannot begin: its configuration is wrong.

use crate::error::Error;
use crate::experiment::evaluator::Evaluator;
use crate::experiment::settings::Settings;
use crate::run::plan::Plan;

impl Plan<'_> {
    /// Prepares the experiment with these settings. A failure is a wrong configuration.
    pub(super) fn prepared(&self, settings: &Settings) -> Result<Box<dyn Evaluator>, Error> {
        self.experiment.prepare(&self.condition, settings).map_err(|error| self.placed(error.into_usage()))
    }

    /// Adds the place of a value from a file to an error about its key.
    fn placed(&self, error: Error) -> Error {
        match error {
            Error::Setting { place, key, why } if place.is_empty() => {
                Error::Setting { place: self.settings.place(&key).into(), key, why }
            }
            other => other,
        }
    }

    /// Converts the error of a strategy that does not start.
    pub(super) fn of_strategy(&self, error: Error) -> Error {
        match error {
            Error::Other(why) => self.unfit(format!("{}: {why}", self.experiment.name())),
            Error::Usage(why) => self.unfit(format!("{}: {why}", self.definition().name())),
            other => self.placed(other),
        }
    }

    /// Builds the error of a strategy that does not fit the experiment, with the place at which a file chooses it.
    pub(super) fn unfit(&self, why: String) -> Error {
        let place = if self.chosen_strategy().is_none() { self.experiment.strategy_place() } else { String::new() };
        Error::Usage(if place.is_empty() { why } else { format!("{place}: {why}") })
    }
}
