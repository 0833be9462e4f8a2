//! An experiment that a file describes.

use std::path::Path;

use farsa_body::robot::Robot;
use farsa_lab::{
    EpisodeId, Error, Evaluator, Experiment, InWorld, Lanes, PlanarWorld, Setting, Settings, StrategyDefinition,
    Truncation, Value as Given, read_text_file,
};
use farsa_physics::articulated::{self, Batch, Model, ModelError};
use serde_json::Value;

use crate::arena::composition::Composition;
use crate::arena::episode::ArenaEpisode;
use crate::check::embed::embedded;
use crate::check::places::Places;
use crate::check::schema::{SCENE_SCHEMA, SCHEMA};
use crate::check::settings::{Entry, apply, entries};
use crate::check::walk;
use crate::composed::Composed;
use crate::document::{Document, Engine, Object};
use crate::jointed;
use crate::jointed::episode::JointedEpisode;
use crate::name::is_name;
use crate::parts::agents::Agents;

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
    /// Reads a file, whose name without its end is the experiment's, and the files that it names in its folder.
    ///
    /// # Errors
    /// [`Error::Io`] and [`Error::Damaged`] for what cannot be read, and those of [`from_text`](Self::from_text).
    pub fn from_file(path: &Path, strategies: &[&'static dyn StrategyDefinition]) -> Result<Self, Error> {
        let text = read_text_file(path, MOST_BYTES)?;
        Self::read(&path.display().to_string(), &text, path.parent(), strategies)
    }

    /// Reads a text as the content of a file of this name; `strategies` are those that it may name.
    ///
    /// No file is read: those that the text names are in its table `files`, as in the [`definition`](Experiment::definition) that
    /// a run keeps.
    ///
    /// # Errors
    /// [`Error::Usage`] for a text that is no TOML, [`Error::Unknown`] for a word that there is not, with the nearest one,
    /// and [`Error::Setting`] for a value that cannot be; with file, line and key. [`Error::Several`] where more than one key, word or
    /// number is wrong.
    pub fn from_text(file: &str, text: &str, strategies: &[&'static dyn StrategyDefinition]) -> Result<Self, Error> {
        Self::read(file, text, None, strategies)
    }

    /// Reads a text that names files in a folder, or none but its own.
    pub(crate) fn read(
        file: &str,
        text: &str,
        folder: Option<&Path>,
        strategies: &[&'static dyn StrategyDefinition],
    ) -> Result<Self, Error> {
        let schema = &*SCHEMA;
        let (value, mut places) = walk::read(file, text, schema)?;
        let mut document: Document =
            serde_json::from_value(value).map_err(|error| Error::Usage(format!("{file}: {error}")))?;
        if let Some(text) = embedded(file, text, folder, &document, &places)? {
            return Self::read(file, &text, None, strategies);
        }
        add_scene(&mut document, &mut places)?;
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
        let entries = entries(&value, schema);
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
            made.check(&Settings::new(made.settings(condition))?)?;
        }
        Ok(made)
    }

    /// An episode, for whose starts the world has room.
    fn episode<W: PlanarWorld>(
        &self,
        (composition, agents): (Composition, Agents),
        world: &mut W,
    ) -> Result<Composed<ArenaEpisode>, Error> {
        let mut episode = ArenaEpisode::new(composition, agents);
        for trial in STARTS {
            episode.arrange(world, start_of(trial)).map_err(|error| self.places.wrong("/start", error))?;
        }
        Ok(Composed(episode))
    }

    /// Evaluates in rapier.
    #[cfg(feature = "rapier")]
    fn in_rapier(&self, composed: (Composition, Agents)) -> Result<Box<dyn Evaluator>, Error> {
        use farsa_physics::rapier::{ArenaOptions, ArenaScene, ArenaWorld, Block};
        let mut scene = ArenaScene::new(composed.0.scene.arena.clone());
        for block in &composed.0.scene.blocks {
            let crate::arena::scene::Block { centre, heading, size, mass, friction, color } = *block;
            scene.add_block(Block { centre, heading, size, mass, friction, color });
        }
        let world = ArenaWorld::new(&scene, &ArenaOptions::default());
        let mut world = world.map_err(|error| self.places.wrong("/world", error))?;
        let episode = self.episode(composed, &mut world)?;
        Ok(Box::new(InWorld::new(world, episode).with_displacements().with_pushes()))
    }

    #[cfg(not(feature = "rapier"))]
    fn in_rapier(&self, _: (Composition, Agents)) -> Result<Box<dyn Evaluator>, Error> {
        Err(self.without_rapier())
    }

    fn document(&self, settings: &Settings) -> Result<Document, Error> {
        let value = apply(&self.document, &self.entries, settings)?;
        serde_json::from_value(value).map_err(|error| Error::Usage(error.to_string()))
    }

    /// Refuses what does not go together.
    fn check(&self, settings: &Settings) -> Result<(), Error> {
        let document = self.document(settings)?;
        if document.has_joints() {
            return jointed::composition::Composition::new(document, &self.places).map(|_| ());
        }
        Composition::new(document, &self.places).map(|_| ())
    }

    /// Evaluates a robot with joints.
    fn with_joints(&self, document: Document) -> Result<Box<dyn Evaluator>, Error> {
        let wrong = |error: ModelError| self.places.wrong("/robot", error);
        let (engine, options) = (document.world.engine, jointed::composition::options(&document));
        let (composition, agents) = jointed::composition::Composition::new(document, &self.places)?;
        let model = Model::<f32>::new(&composition.scene.robot, &options).map_err(wrong)?;
        let robot = composition.scene.robot.clone();
        let mut episode = JointedEpisode::new(composition, agents);
        let mut world = articulated::World::new(model.clone());
        let arranged = STARTS.into_iter().all(|trial| episode.arrange(&mut world, start_of(trial)));
        if !arranged {
            return Err(self.places.wrong("/start", "finds no free place after a thousand tries"));
        }
        if engine == Engine::Rapier {
            return self.with_joints_in_rapier(&robot, &options, episode);
        }
        let batch = move |lanes: Lanes| {
            let batch = Batch::new(model.clone(), lanes.count(), lanes.instructions());
            batch.map_err(|error| Error::Other(error.to_string()))
        };
        Ok(Box::new(InWorld::new(world, Composed(episode)).with_lanes(batch).with_displacements().with_pushes()))
    }

    #[cfg(feature = "rapier")]
    fn with_joints_in_rapier(
        &self,
        robot: &Robot,
        options: &articulated::Options,
        episode: JointedEpisode,
    ) -> Result<Box<dyn Evaluator>, Error> {
        use farsa_physics::rapier::{Options, World};
        let articulated::Options { time_step, substeps, gravity, .. } = *options;
        let world = World::new(robot, &Options { time_step, substeps, gravity, ..Options::default() });
        let world = world.map_err(|error| self.places.wrong("/world", error))?;
        Ok(Box::new(InWorld::new(world, Composed(episode)).with_displacements().with_pushes()))
    }

    #[cfg(not(feature = "rapier"))]
    fn with_joints_in_rapier(
        &self,
        _: &Robot,
        _: &articulated::Options,
        _: JointedEpisode,
    ) -> Result<Box<dyn Evaluator>, Error> {
        Err(self.without_rapier())
    }

    #[cfg(not(feature = "rapier"))]
    fn without_rapier(&self) -> Error {
        self.places.wrong("/world/engine", "`rapier`: this program was built without the feature `rapier`")
    }
}

/// The starts that are tried before anything runs.
const STARTS: std::ops::Range<u32> = 0..8;

/// Seeds of this kind are neither a run's nor a test's.
fn start_of(trial: u32) -> EpisodeId {
    EpisodeId { seed: u64::MAX, trial, ..EpisodeId::default() }
}

/// Adds the objects of the scene's file, if there is one, to those of a document.
fn add_scene(document: &mut Document, places: &mut Places) -> Result<(), Error> {
    let Some(name) = &document.world.scene else { return Ok(()) };
    let Some(text) = document.files.get(name) else { return Ok(()) };
    let (mut value, lines) = walk::read(name, text, &SCENE_SCHEMA)?;
    let objects = value.get_mut("objects").map(Value::take).unwrap_or_default();
    let objects: Vec<Object> =
        serde_json::from_value(objects).map_err(|error| Error::Usage(format!("{name}: {error}")))?;
    for (number, object) in objects.into_iter().enumerate() {
        places.put_elsewhere(&format!("/objects/{}", document.objects.len()), &format!("/objects/{number}"), &lines);
        document.objects.push(object);
    }
    Ok(())
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
    let known = Settings::new(strategy.settings())?;
    let mut found = Vec::new();
    for (section, values) in [("evolution", &document.evolution), ("strategy", &document.strategy)] {
        for (name, value) in values.iter().filter(|(name, _)| section != "strategy" || *name != "name") {
            let (path, key) = (format!("/{section}/{name}"), format!("{section}.{name}"));
            let setting = known.find(&places.of(&path), &key)?;
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
        let document = self.document(settings)?;
        if document.has_joints() {
            return self.with_joints(document);
        }
        let mut composed = Composition::new(document, &self.places)?;
        if composed.1.document.team.coevolution {
            composed.1.size = settings.count("evolution.population")?;
        }
        if composed.1.document.world.engine == Engine::Rapier {
            return self.in_rapier(composed);
        }
        let arena = composed.0.scene.arena.clone();
        let mut world = farsa_physics::arena::World::new(&arena).map_err(|error| self.places.wrong("/world", error))?;
        let episode = self.episode(composed, &mut world)?;
        Ok(Box::new(InWorld::in_arena(&arena, episode)?))
    }
}
