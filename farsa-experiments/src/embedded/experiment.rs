//! Experiments whose files are embedded in the program.

use std::path::PathBuf;
use std::sync::OnceLock;

use farsa_compose::{ComposedExperiment, Reflex};
#[cfg(not(feature = "rapier"))]
use farsa_lab::advanced::ENGINE;
use farsa_lab::strategy::{StrategyDefinition, strategies};
use farsa_lab::{Error, Evaluator, Experiment, Setting, Settings};

use crate::embedded::infrared;
use crate::embedded::settings::NamedSettings;

/// An experiment described by an embedded file of farsa-compose. It has separate settings.
pub struct EmbeddedExperiment {
    name: &'static str,
    text: &'static str,
    settings: &'static str,
    check: fn(&Settings) -> Result<(), Error>,
    parts: OnceLock<Parts>,
}

/// Both files as they are read.
struct Parts {
    composed: ComposedExperiment,
    settings: NamedSettings,
}

impl EmbeddedExperiment {
    /// The experiment of a name, of its file and of the file with its settings. `check` refuses settings that are each
    /// allowed and do not go together.
    pub(crate) const fn new(
        name: &'static str,
        text: &'static str,
        settings: &'static str,
        check: fn(&Settings) -> Result<(), Error>,
    ) -> Self {
        Self { name, text, settings, check, parts: OnceLock::new() }
    }

    fn parts(&self) -> &Parts {
        self.parts.get_or_init(|| Parts {
            composed: self.read(self.text).expect("an embedded file is valid"),
            settings: toml::from_str(self.settings).expect("the settings of an embedded file are valid"),
        })
    }

    fn read(&self, text: &str) -> Result<ComposedExperiment, Error> {
        ComposedExperiment::from_text(&format!("{}.toml", self.name), text, strategies())
    }

    /// The named settings, and those of the file under a condition.
    #[cfg(test)]
    pub(crate) fn halves(&self, condition: &str) -> (&NamedSettings, Vec<Setting>) {
        (&self.parts().settings, self.parts().composed.settings(condition))
    }

    /// The condition of a name, or the default one.
    fn named<'c>(&self, condition: &'c str) -> &'c str {
        let default = self.conditions().first().copied().unwrap_or_default();
        if condition.is_empty() { default } else { condition }
    }

    /// Prepares the experiment with functions that drive some robots, by their numbers from 0, instead of networks.
    ///
    /// # Errors
    /// As [`Experiment::prepare`], and [`Error::Usage`] for a robot that does not exist.
    pub fn prepare_with(
        &self,
        condition: &str,
        settings: &Settings,
        reflexes: Vec<(usize, Reflex)>,
    ) -> Result<Box<dyn Evaluator>, Error> {
        #[cfg(not(feature = "rapier"))]
        if settings.has(ENGINE) && settings.word(ENGINE)? == "rapier" {
            return Err(crate::worlds::missing("rapier"));
        }
        (self.check)(settings)?;
        let condition = self.named(condition);
        let parts = self.parts();
        let measured = infrared::with_tables(self.text, settings)?;
        let measured = measured.map(|text| self.read(&text)).transpose().map_err(infrared::blame)?;
        let composed = measured.as_ref().unwrap_or(&parts.composed);
        let mut values = Settings::new(composed.settings(condition))?;
        parts.settings.apply(condition, settings, &mut values)?;
        if measured.is_none() {
            infrared::choose(settings, &mut values)?;
        }
        composed.prepare_with(&values, reflexes).map_err(|error| self.blame(error))
    }

    /// An error of the file as one of the setting that causes it.
    fn blame(&self, error: Error) -> Error {
        match error {
            Error::Setting { key, why, .. } if key == "world" => Error::Other(why),
            Error::Setting { why, .. } => Error::setting(&self.parts().settings.refused, why),
            error => error,
        }
    }
}

impl Experiment for EmbeddedExperiment {
    fn name(&self) -> &'static str {
        self.name
    }

    fn summary(&self) -> &'static str {
        self.parts().composed.summary()
    }

    fn conditions(&self) -> &'static [&'static str] {
        self.parts().composed.conditions()
    }

    fn strategy(&self, condition: &str) -> &'static dyn StrategyDefinition {
        self.parts().composed.strategy(condition)
    }

    fn settings(&self, condition: &str) -> Vec<Setting> {
        let condition = self.named(condition);
        let Parts { composed, settings } = self.parts();
        settings.table(condition, &composed.settings(condition))
    }

    fn files(&self, _: &str, settings: &Settings) -> Result<Vec<PathBuf>, Error> {
        infrared::files(settings)
    }

    fn gene_bits(&self) -> u32 {
        self.parts().composed.gene_bits()
    }

    fn prepare(&self, condition: &str, settings: &Settings) -> Result<Box<dyn Evaluator>, Error> {
        self.prepare_with(condition, settings, Vec::new())
    }
}
