//! Experiments with an embedded file whose robot is a model, which a setting replaces by another file.

use std::path::{Path, PathBuf};
use std::sync::OnceLock;

use farsa_compose::ComposedExperiment;
use farsa_lab::strategy::{StrategyDefinition, strategies};
use farsa_lab::{Error, Evaluator, Experiment, Setting, Settings};
use farsa_models::{ReadOptions, SelfContained, self_contained};
use toml::{Table, Value as Toml};

/// Path of a model instead of the embedded one.
const MODEL: &str = "robot.model";

/// An experiment described by an embedded file of farsa-compose, with an embedded model of a robot.
///
/// Its settings are those of the file, and `robot.model`, the path of another URDF or MJCF. Parts of the robot must have
/// the names that the file uses.
pub struct ModelExperiment {
    name: &'static str,
    text: &'static str,
    model: &'static str,
    composed: OnceLock<ComposedExperiment>,
}

impl ModelExperiment {
    /// The experiment of a name, of its file and of its model.
    pub(crate) const fn new(name: &'static str, text: &'static str, model: &'static str) -> Self {
        Self { name, text, model, composed: OnceLock::new() }
    }

    fn composed(&self) -> &ComposedExperiment {
        self.composed.get_or_init(|| self.read(self.model).expect("an embedded file is valid"))
    }

    fn read(&self, model: &str) -> Result<ComposedExperiment, Error> {
        let wrong = |error: &dyn std::fmt::Display| Error::Other(error.to_string());
        let mut document: Table = toml::from_str(self.text).map_err(|error| wrong(&error))?;
        let file = document.get("robot").and_then(|robot| robot.get("file")).and_then(Toml::as_str);
        let file = file.unwrap_or_default().to_owned();
        document.insert("files".into(), Toml::Table(Table::from_iter([(file, Toml::String(model.into()))])));
        let text = toml::to_string(&document).map_err(|error| wrong(&error))?;
        ComposedExperiment::from_text(&format!("{}.toml", self.name), &text, strategies())
    }
}

/// Reads the model that replaces the embedded one, if there is one.
fn other_model(settings: &Settings) -> Result<Option<SelfContained>, Error> {
    let path = settings.text(MODEL)?;
    if path.is_empty() {
        return Ok(None);
    }
    let read = self_contained(Path::new(path), &ReadOptions::default());
    read.map(Some).map_err(|error| Error::setting(MODEL, error.to_string()))
}

impl Experiment for ModelExperiment {
    fn name(&self) -> &'static str {
        self.name
    }

    fn values_version(&self) -> u32 {
        self.composed().values_version()
    }

    fn summary(&self) -> &'static str {
        self.composed().summary()
    }

    fn conditions(&self) -> &'static [&'static str] {
        self.composed().conditions()
    }

    fn strategy(&self, condition: &str) -> &'static dyn StrategyDefinition {
        self.composed().strategy(condition)
    }

    fn settings(&self, condition: &str) -> Vec<Setting> {
        let mut settings = self.composed().settings(condition);
        let doc = "Path of a URDF or MJCF instead of the model of this crate, with the same names of parts.";
        settings.push(Setting::text(MODEL, "").doc(doc));
        settings
    }

    fn files(&self, _: &str, settings: &Settings) -> Result<Vec<PathBuf>, Error> {
        Ok(other_model(settings)?.map_or_else(Vec::new, |model| model.files))
    }

    fn gene_bits(&self) -> u32 {
        self.composed().gene_bits()
    }

    fn prepare(&self, condition: &str, settings: &Settings) -> Result<Box<dyn Evaluator>, Error> {
        let other = other_model(settings)?.map(|model| {
            let composed = self.read(&model.text);
            composed.map_err(|error| Error::setting(MODEL, format!("this model does not fit: {error}")))
        });
        let other = other.transpose()?;
        other.as_ref().unwrap_or_else(|| self.composed()).prepare(condition, settings)
    }
}
