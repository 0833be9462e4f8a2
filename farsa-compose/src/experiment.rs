//! An experiment that a file describes.

use std::path::Path;

use farsa_lab::{
    EpisodeId, Error, Evaluator, Experiment, InWorld, Setting, Settings, StrategyDefinition, Truncation,
    Value as Given, read_text_file,
};
use serde_json::Value;

use crate::check::places::Places;
use crate::check::schema::schema;
use crate::check::settings::{Entry, apply, entries};
use crate::check::walk::read;
use crate::composition::Composition;
use crate::document::Document;
use crate::episode::ComposedEpisode;
use crate::name::is_name;

/// The most bytes of a file.
const MOST_BYTES: u64 = 1_000_000;

/// An experiment that a file describes: what the command runs by `farsa run NAME.toml`.
///
/// ```
/// use farsa_compose::ComposedExperiment;
/// use farsa_lab::{EpisodeId, Evaluation, Experiment as _, Settings};
///
/// let text = r#"
/// summary = "an e-puck drives and turns away from walls"
/// robot = { kind = "e-puck" }
/// sensors = [{ kind = "infrared" }]
/// motors = [{ kind = "wheels" }]
/// network = { kind = "perceptron" }
/// episode = { steps = 100, trials = 2, ends = ["collision"] }
/// reward = [{ kind = "forward", over = "sum" }]
/// "#;
/// let experiment = ComposedExperiment::from_text("wander.toml", text, farsa_lab::strategies())?;
/// let settings = Settings::new(experiment.settings(""))?;
/// let mut evaluator = experiment.prepare("", &settings)?;
/// let parameters = vec![0.5; evaluator.parameters().len()];
/// let outcome = evaluator.evaluate(Evaluation::new(&parameters, EpisodeId::default()), None);
/// assert!(outcome.is_finite());
/// # Ok::<(), farsa_lab::Error>(())
/// ```
#[derive(Clone)]
pub struct ComposedExperiment {
    name: &'static str,
    summary: &'static str,
    conditions: &'static [&'static str],
    /// For each condition the settings that differ.
    changes: Vec<Vec<(String, Given)>>,
    strategy: &'static dyn StrategyDefinition,
    /// Settings of the strategy with other defaults.
    searched: Vec<Setting>,
    gene_bits: u32,
    text: String,
    document: Value,
    entries: Vec<Entry>,
    places: Places,
}

impl ComposedExperiment {
    /// Reads a file, whose name without its end is the experiment's.
    ///
    /// # Errors
    /// [`Error::Io`], and those of [`from_text`](Self::from_text).
    pub fn from_file(path: &Path, strategies: &[&'static dyn StrategyDefinition]) -> Result<Self, Error> {
        let text = read_text_file(path, MOST_BYTES)?;
        Self::from_text(&path.display().to_string(), &text, strategies)
    }

    /// Reads a text as the content of a file of this name; `strategies` are those that it may name.
    ///
    /// # Errors
    /// [`Error::Usage`] for a text that is no TOML, [`Error::Unknown`] for a word that there is not, with the nearest one,
    /// and [`Error::Setting`] for a value that cannot be; with file, line and key.
    pub fn from_text(file: &str, text: &str, strategies: &[&'static dyn StrategyDefinition]) -> Result<Self, Error> {
        let schema = schema();
        let (value, places) = read(file, text, &schema)?;
        let document: Document =
            serde_json::from_value(value).map_err(|error| Error::Usage(format!("{file}: {error}")))?;
        let stem = Path::new(file).file_stem().and_then(|stem| stem.to_str()).unwrap_or_default();
        if !is_name(stem) {
            let why = "is the name of the experiment: 1 to 40 lower-case letters, digits, - and _, the first no sign";
            return Err(Error::Usage(format!("{file}: `{stem}` {why}")));
        }
        let own = match document.strategy.get("name") {
            None => &Truncation as &'static dyn StrategyDefinition,
            Some(name) => {
                let name = name.as_str().ok_or_else(|| places.wrong("/strategy/name", "is not a text in quotes"))?;
                let found = strategies.iter().copied().find(|known| known.name() == name);
                let names = strategies.iter().map(|known| known.name());
                found.ok_or_else(|| Error::unknown(&places.of("/strategy/name"), "strategy", name, names))?
            }
        };
        let gene_bits = document.genome.bits;
        let value = serde_json::to_value(&document).map_err(|error| Error::Other(error.to_string()))?;
        let entries = entries(&value, &schema);
        let searched = searched(&document, own, &places)?;
        let names: Vec<&'static str> = document.conditions.iter().map(|condition| leaked(&condition.name)).collect();
        if let Some(index) = (1..names.len()).find(|index| names[..*index].contains(&names[*index])) {
            return Err(places.wrong(&format!("/conditions/{index}/name"), "stands twice"));
        }
        let table: Vec<Setting> = entries.iter().map(|entry| entry.setting.clone()).chain(searched.clone()).collect();
        let changes = document.conditions.iter().enumerate().map(|(index, condition)| {
            let mut settings = Settings::new(table.clone())?;
            let path = format!("/conditions/{index}/settings");
            let one = |(key, value): (&String, &Value)| {
                let path = format!("{path}/{key}");
                let value =
                    given(value).ok_or_else(|| places.wrong(&path, "is no flag, number, word or list of numbers"))?;
                settings.set(&places.of(&path), key, value.clone())?;
                Ok((key.clone(), settings.get(key)?.clone()))
            };
            condition.settings.iter().map(one).collect::<Result<Vec<_>, Error>>()
        });
        let changes = changes.collect::<Result<Vec<_>, _>>()?;
        let made = Self {
            name: leaked(stem),
            summary: leaked(&document.summary),
            conditions: Box::leak(names.into_boxed_slice()),
            changes,
            strategy: own,
            searched,
            gene_bits,
            text: text.into(),
            document: value,
            entries,
            places,
        };
        // What does not go together is said before anything runs.
        for condition in if made.conditions.is_empty() { &[""][..] } else { made.conditions } {
            made.composition(&Settings::new(made.settings(condition))?)?;
        }
        Ok(made)
    }

    fn composition(&self, settings: &Settings) -> Result<Composition, Error> {
        let value = apply(&self.document, &self.entries, settings)?;
        let document = serde_json::from_value(value).map_err(|error| Error::Usage(error.to_string()))?;
        Composition::new(document, &self.places)
    }
}

/// A text that lasts as long as the process, as the names of experiments do.
fn leaked(text: &str) -> &'static str {
    String::leak(text.to_owned())
}

/// A value of the document as that of a setting.
fn given(value: &Value) -> Option<Given> {
    match value {
        Value::Bool(flag) => Some(Given::Flag(*flag)),
        Value::Number(number) => number.as_i64().map(Given::Whole).or_else(|| number.as_f64().map(Given::Number)),
        Value::String(word) => Some(Given::Word(word.clone())),
        Value::Array(items) => items.iter().map(Value::as_f64).collect::<Option<Vec<_>>>().map(Given::Numbers),
        _ => None,
    }
}

/// The strategy's settings that the document gives other defaults.
fn searched(document: &Document, strategy: &dyn StrategyDefinition, places: &Places) -> Result<Vec<Setting>, Error> {
    let known = strategy.settings();
    let mut found = Vec::new();
    for (section, values) in [("evolution", &document.evolution), ("strategy", &document.strategy)] {
        for (name, value) in values.iter().filter(|(name, _)| section != "strategy" || *name != "name") {
            let (path, key) = (format!("/{section}/{name}"), format!("{section}.{name}"));
            let setting = known.iter().find(|setting| setting.key() == key);
            let keys = known.iter().map(Setting::key);
            let setting = setting.ok_or_else(|| Error::unknown(&places.of(&path), "key", &key, keys))?;
            let value =
                given(value).ok_or_else(|| places.wrong(&path, "is no flag, number, word or list of numbers"))?;
            let default = setting.with_default(value).map_err(|why| places.wrong(&path, why))?;
            found.push(default);
        }
    }
    Ok(found)
}

impl Experiment for ComposedExperiment {
    fn name(&self) -> &'static str {
        self.name
    }

    fn summary(&self) -> &'static str {
        self.summary
    }

    fn conditions(&self) -> &'static [&'static str] {
        self.conditions
    }

    fn strategy(&self, _: &str) -> &'static dyn StrategyDefinition {
        self.strategy
    }

    fn settings(&self, condition: &str) -> Vec<Setting> {
        let own = self.entries.iter().map(|entry| &entry.setting);
        let place = self.conditions.iter().position(|known| *known == condition);
        let changes = place.map_or(&[][..], |place| &self.changes[place]);
        let changed = |setting: &Setting| {
            let change = changes.iter().find(|(key, _)| key == setting.key());
            change.and_then(|(_, value)| setting.with_default(value.clone()).ok()).unwrap_or_else(|| setting.clone())
        };
        own.chain(&self.searched).map(changed).collect()
    }

    fn definition(&self) -> Option<&str> {
        Some(&self.text)
    }

    fn gene_bits(&self) -> u32 {
        self.gene_bits
    }

    fn prepare(&self, _: &str, settings: &Settings) -> Result<Box<dyn Evaluator>, Error> {
        let composition = self.composition(settings)?;
        let arena = composition.scene.arena.clone();
        let mut world = farsa_physics::arena::World::new(&arena).map_err(|error| self.places.wrong("/world", error))?;
        let mut episode = ComposedEpisode::new(composition);
        // Seeds of this kind are neither a run's nor a test's.
        for trial in 0..8 {
            let id = EpisodeId { seed: u64::MAX, trial, ..EpisodeId::default() };
            episode.arrange(&mut world, id).map_err(|error| self.places.wrong("/start", error))?;
        }
        Ok(Box::new(InWorld::in_arena(&arena, episode)?))
    }
}
