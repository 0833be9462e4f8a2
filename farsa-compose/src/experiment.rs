//! An experiment from a file.

use std::path::Path;

use farsa_lab::advanced::{Lanes, NormalizedController, Value as SettingValue, Vocabulary, read_text_file};
use farsa_lab::strategy::{StrategyDefinition, Truncation};
use farsa_lab::{EpisodeId, Error, Evaluator, Experiment, InWorld, Setting, Settings};
use farsa_physics::articulated::{self, Batch, Model, ModelError};
use serde_json::Value;

use crate::arena::ArenaWorld;
use crate::arena::episode::ArenaEpisode;
use crate::arena::setup::Setup;
use crate::arena::start_contacts;
use crate::built_in::registry;
use crate::check::completed::{complete, expand};
use crate::check::embed::embedded;
use crate::check::settings::{Entry, apply, entries};
use crate::check::source::{Names, Source};
use crate::check::walk;
use crate::composed_task::ComposedTask;
use crate::document::{Document, Engine, Object};
use crate::jointed;
use crate::jointed::episode::JointedEpisode;
use crate::jointed::start_contacts::check_start;
use crate::limits::Limits;
use crate::name::is_name;
use crate::parts::agents::Agents;
use crate::parts::network::AnyNetwork;
use crate::parts::reflex::{Reflex, ReflexController};

/// Version of the values of experiments with joints. 2: sweeps of contacts that settle.
const JOINTED_VERSION: u32 = 2;
/// Most bytes of a file.
const MAX_BYTES: u64 = 1_000_000;

/// An experiment from a file, as used by `farsa run NAME.toml`.
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
/// let experiment = ComposedExperiment::from_text("wander.toml", text, farsa_lab::strategy::strategies())?;
/// let settings = Settings::new(experiment.settings(""))?;
/// let mut evaluator = experiment.prepare("", &settings)?;
/// let parameters = vec![0.5; evaluator.info().parameters.len()];
/// let outcome = evaluator.evaluate(Evaluation::new(&parameters, EpisodeId::default()), None);
/// assert!(outcome.is_finite());
/// # Ok::<(), farsa_lab::Error>(())
/// ```
#[derive(Clone)]
pub struct ComposedExperiment {
    name: &'static str,
    summary: &'static str,
    conditions: &'static [&'static str],
    /// Settings that differ in each condition, with their places.
    changes: Vec<Vec<Change>>,
    strategy: &'static dyn StrategyDefinition,
    /// Settings of the strategy, with the defaults of the file.
    strategy_settings: Vec<Setting>,
    gene_bits: u32,
    values_version: u32,
    text: String,
    /// Document with all its defaults. An evaluator replaces the values of settings and reads it once.
    document: Value,
    entries: Vec<Entry>,
    source: Source,
}

impl ComposedExperiment {
    /// Reads an experiment from a file. Other files that it names must be in the same folder.
    ///
    /// Its name is the name of the file without `.toml`.
    ///
    /// # Errors
    /// Returns [`Error::Io`] and [`Error::File`] for files that cannot be read, and the errors of
    /// [`from_text`](Self::from_text).
    pub fn from_file<'v>(path: impl AsRef<Path>, vocabulary: impl Into<Vocabulary<'v>>) -> Result<Self, Error> {
        let path = path.as_ref();
        let text = read_text_file(path, MAX_BYTES)?;
        let name = path.display().to_string();
        Self::read(Limits::default(), &name, &text, path.parent(), vocabulary.into())
    }

    /// Reads an experiment from a text, as if it were the content of this file. It may use any of the given
    /// strategies and parts.
    ///
    /// If the text names other files, it must contain them in its table `files`, as the
    /// [`definition`](Experiment::definition) of a run does. This never reads any files.
    ///
    /// # Errors
    /// Returns [`Error::Usage`] for invalid TOML, and [`Error::Setting`] for an invalid value. If a word is unknown,
    /// [`Error::Setting`] also mentions the nearest one. Each error has file, line and key. If there are several, you
    /// get [`Error::Several`].
    pub fn from_text<'v>(file: &str, text: &str, vocabulary: impl Into<Vocabulary<'v>>) -> Result<Self, Error> {
        Self::from_text_within(Limits::default(), file, text, vocabulary)
    }

    /// Reads a text like [`from_text`](Self::from_text), but with custom [`Limits`].
    ///
    /// You usually don't need this, unless your experiment is unusually large.
    ///
    /// # Errors
    /// Returns the errors of [`from_text`](Self::from_text).
    pub fn from_text_within<'v>(
        limits: Limits,
        file: &str,
        text: &str,
        vocabulary: impl Into<Vocabulary<'v>>,
    ) -> Result<Self, Error> {
        Self::read(limits, file, text, None, vocabulary.into())
    }

    /// Reads a text. With a folder it may name files there.
    pub(crate) fn read(
        limits: Limits,
        file: &str,
        text: &str,
        folder: Option<&Path>,
        vocabulary: Vocabulary<'_>,
    ) -> Result<Self, Error> {
        let registry = registry(vocabulary.parts)?;
        let (value, mut source) = walk::read(file, text, &registry.schemas[0])?;
        (source.limits, source.registry) = (limits, registry);
        let mut document: Document =
            serde_json::from_value(value).map_err(|error| Error::Usage(format!("{file}: {error}")))?;
        complete(&mut document, &source)?;
        if let Some(text) = embedded(file, text, folder, &document, &source)? {
            let made = Self::read(limits, file, &text, None, vocabulary)?;
            made.check_starts()?;
            return Ok(made);
        }
        add_scene(&mut document, &mut source)?;
        let stem = Path::new(file).file_stem().and_then(|stem| stem.to_str()).unwrap_or_default();
        if !is_name(stem) {
            let why = "is the name of the experiment: 1 to 40 lower-case letters, digits, - and _, the first no sign";
            return Err(Error::Usage(format!("{file}: `{stem}` {why}")));
        }
        let strategy = strategy(&document, vocabulary.strategies, &source)?;
        // With the defaults of all keys, which are settings, too.
        let value = serde_json::to_value(&document).map_err(|error| Error::Other(error.to_string()))?;
        source.names = Names::new(&value, &source.registry.schemas[0]);
        let entries = entries(&value, &source.registry.schemas[0]);
        let strategy_settings = strategy_settings(&document, strategy, &source)?;
        let table: Vec<_> =
            entries.iter().map(|entry| entry.setting.clone()).chain(strategy_settings.clone()).collect();
        let (conditions, changes) = conditions(&document, &table, &source)?;
        let made = Self {
            name: leaked(stem),
            summary: leaked(&document.summary),
            conditions: Box::leak(conditions.into_boxed_slice()),
            changes,
            strategy,
            strategy_settings,
            gene_bits: document.genome.bits,
            values_version: if document.has_joints() { JOINTED_VERSION } else { 1 },
            text: text.into(),
            document: value,
            entries,
            source,
        };
        // Reports parts that do not fit together before a run begins.
        for condition in if made.conditions.is_empty() { &[""][..] } else { made.conditions } {
            made.check(&Settings::new(made.settings(condition))?)?;
        }
        if folder.is_some() {
            made.check_starts()?;
        }
        Ok(made)
    }

    /// Refuses a start inside the floor or inside a thing. The text of a run is exempt, which is repeated as it was.
    fn check_starts(&self) -> Result<(), Error> {
        for condition in if self.conditions.is_empty() { &[""][..] } else { self.conditions } {
            let document = self.document(&Settings::new(self.settings(condition))?)?;
            if document.has_joints() {
                let (options, trials) = (jointed::setup::options(&document), document.episode.trials);
                let (setup, agents) = jointed::setup::Setup::new(document, &self.source)?;
                let trials = STARTS.filter(|trial| *trial < trials).map(start_of);
                check_start(&mut JointedEpisode::new(setup, agents), &options, trials, &self.source)?;
                continue;
            }
            let most = document.episode.trials;
            let trials = STARTS.filter(|trial| *trial < most).map(start_of);
            let (setup, agents) = Setup::new(document, &self.source)?;
            if !setup.scene.blocks.is_empty() {
                #[cfg(feature = "rapier")]
                {
                    let mut world = self.world_in_rapier(&setup)?;
                    let mut episode = ArenaEpisode::new(setup, agents);
                    start_contacts::check_start(&mut episode, &mut world, trials, &self.source)?;
                }
                continue;
            }
            let mut world = self.world_in_arena(&setup)?;
            let mut episode = ArenaEpisode::new(setup, agents);
            start_contacts::check_start(&mut episode, &mut world, trials, &self.source)?;
        }
        Ok(())
    }

    /// Builds an episode. The first starts must find places in the world.
    fn episode<W: ArenaWorld>(
        &self,
        (setup, agents): (Setup, Agents),
        world: &mut W,
    ) -> Result<ComposedTask<ArenaEpisode>, Error> {
        let mut episode = ArenaEpisode::new(setup, agents);
        for trial in STARTS {
            episode.arrange(world, start_of(trial)).map_err(|error| self.source.wrong("/start", error))?;
        }
        Ok(ComposedTask(episode))
    }

    /// Builds the world of robots on wheels.
    fn world_in_arena(&self, setup: &Setup) -> Result<farsa_physics::arena::World, Error> {
        farsa_physics::arena::World::new(&setup.scene.arena).map_err(|error| self.source.wrong("/world", error))
    }

    /// Builds the world of robots on wheels in rapier, with blocks.
    #[cfg(feature = "rapier")]
    fn world_in_rapier(&self, setup: &Setup) -> Result<farsa_physics::rapier::ArenaWorld, Error> {
        use farsa_physics::rapier::{ArenaOptions, ArenaScene, ArenaWorld, Block};
        let mut scene = ArenaScene::new(setup.scene.arena.clone());
        for block in &setup.scene.blocks {
            let crate::arena::scene::Block { centre, heading, size, mass, friction, color } = *block;
            scene.add_block(Block { centre, heading, size, mass, friction, color });
        }
        ArenaWorld::new(&scene, &ArenaOptions::default()).map_err(|error| self.source.wrong("/world", error))
    }

    /// Builds the evaluator for rapier.
    #[cfg(feature = "rapier")]
    fn in_rapier(&self, composed: (Setup, Agents)) -> Result<Box<dyn Evaluator>, Error> {
        let mut world = self.world_in_rapier(&composed.0)?;
        let episode = self.episode(composed, &mut world)?;
        Ok(Box::new(InWorld::new(world, episode).with_displacements().with_pushes()))
    }

    /// Prepares the experiment, but drives some robots by functions instead of networks. Robots are numbered from 0.
    ///
    /// This is useful to compare an evolved controller with one that was written by hand.
    ///
    /// # Errors
    /// Returns the errors of [`Experiment::prepare`]. You also get [`Error::Usage`] for a robot that does not exist
    /// or has joints.
    pub fn prepare_with(
        &self,
        settings: &Settings,
        reflexes: Vec<(usize, Reflex)>,
    ) -> Result<Box<dyn Evaluator>, Error> {
        let document = self.document(settings)?;
        let none = |robot: usize| Error::Usage(format!("there is no robot {robot} on wheels"));
        if document.has_joints() {
            return reflexes.first().map_or_else(|| self.with_joints(document), |(robot, _)| Err(none(*robot)));
        }
        let mut composed = Setup::new(document, &self.source)?;
        let agents = &mut composed.1;
        let shape = [agents.spec.inputs.len(), agents.spec.outputs.len()];
        for (robot, reflex) in reflexes {
            let network = agents.networks.get_mut(robot).ok_or_else(|| none(robot))?;
            *network = NormalizedController::new(AnyNetwork::of(ReflexController { shape, reflex }));
        }
        if agents.document.team.coevolution {
            agents.size = settings.count("evolution.population")?;
        }
        if agents.document.world.engine == Engine::Rapier {
            #[cfg(feature = "rapier")]
            return self.in_rapier(composed);
            #[cfg(not(feature = "rapier"))]
            return Err(self.without_rapier());
        }
        let arena = composed.0.scene.arena.clone();
        let mut world = self.world_in_arena(&composed.0)?;
        let episode = self.episode(composed, &mut world)?;
        Ok(Box::new(InWorld::in_arena(&arena, episode)?))
    }

    fn document(&self, settings: &Settings) -> Result<Document, Error> {
        let value = apply(&self.document, &self.entries, settings)?;
        let mut document: Document = serde_json::from_value(value).map_err(|error| Error::Usage(error.to_string()))?;
        complete(&mut document, &self.source)?;
        expand(&mut document, &self.source)?;
        Ok(document)
    }

    /// Rejects parts that do not fit together.
    fn check(&self, settings: &Settings) -> Result<(), Error> {
        let document = self.document(settings)?;
        if document.has_joints() {
            return jointed::setup::Setup::new(document, &self.source).map(|_| ());
        }
        Setup::new(document, &self.source).map(|_| ())
    }

    /// Builds the evaluator of a robot with joints.
    fn with_joints(&self, document: Document) -> Result<Box<dyn Evaluator>, Error> {
        let wrong = |error: ModelError| self.source.wrong("/robot", error);
        let (engine, options) = (document.world.engine, jointed::setup::options(&document));
        let (setup, agents) = jointed::setup::Setup::new(document, &self.source)?;
        let model = Model::<f32>::new(&setup.scene.robot, &options).map_err(wrong)?;
        #[cfg(feature = "rapier")]
        let robot = setup.scene.robot.clone();
        let mut episode = JointedEpisode::new(setup, agents);
        let mut world = articulated::World::new(model.clone());
        let arranged = STARTS.into_iter().all(|trial| episode.arrange(&mut world, start_of(trial)));
        if !arranged {
            return Err(self.source.wrong("/start", "finds no free place after a thousand tries"));
        }
        if engine == Engine::Rapier {
            #[cfg(feature = "rapier")]
            return self.with_joints_in_rapier(&robot, &options, episode);
            #[cfg(not(feature = "rapier"))]
            return Err(self.without_rapier());
        }
        let batch = move |lanes: Lanes| {
            let batch = Batch::new(model.clone(), lanes.count(), lanes.instructions());
            batch.map_err(|error| Error::Other(error.to_string()))
        };
        Ok(Box::new(InWorld::new(world, ComposedTask(episode)).with_lanes(batch).with_displacements().with_pushes()))
    }

    #[cfg(feature = "rapier")]
    fn with_joints_in_rapier(
        &self,
        robot: &farsa_body::robot::Robot,
        options: &articulated::Options,
        episode: JointedEpisode,
    ) -> Result<Box<dyn Evaluator>, Error> {
        use farsa_physics::rapier::{Options, World};
        let articulated::Options { time_step, substeps, gravity, .. } = *options;
        let world = World::new(robot, &Options { time_step, substeps, gravity, ..Options::default() });
        let world = world.map_err(|error| self.source.wrong("/world", error))?;
        Ok(Box::new(InWorld::new(world, ComposedTask(episode)).with_displacements().with_pushes()))
    }

    #[cfg(not(feature = "rapier"))]
    fn without_rapier(&self) -> Error {
        self.source.wrong("/world/engine", "`rapier`: this program was built without the feature `rapier`")
    }
}

/// Trials whose starts are tried before a run.
const STARTS: std::ops::Range<u32> = 0..8;

/// Returns an episode with a seed that no run or test uses.
fn start_of(trial: u32) -> EpisodeId {
    EpisodeId { seed: u64::MAX, trial, ..EpisodeId::default() }
}

/// Adds the objects of the scene's file to a document.
fn add_scene(document: &mut Document, source: &mut Source) -> Result<(), Error> {
    let Some(name) = &document.world.scene else { return Ok(()) };
    let Some(text) = document.files.get(name) else { return Ok(()) };
    let (mut value, lines) = walk::read(name, text, &source.registry.schemas[1])?;
    let objects = value.get_mut("objects").map(Value::take).unwrap_or_default();
    let objects: Vec<Object> =
        serde_json::from_value(objects).map_err(|error| Error::Usage(format!("{name}: {error}")))?;
    for (number, object) in objects.into_iter().enumerate() {
        source.include(&format!("/objects/{}", document.objects.len()), &format!("/objects/{number}"), &lines);
        document.objects.push(object);
    }
    // Defaults of registered things of the scene.
    complete(document, source)
}

/// Leaks a text, because names of experiments are static.
fn leaked(text: &str) -> &'static str {
    String::leak(text.to_owned())
}

/// Converts a value of the document into that of a setting.
fn setting_value(value: &Value, path: &str, source: &Source) -> Result<SettingValue, Error> {
    let converted = match value {
        Value::Bool(flag) => Some(SettingValue::Flag(*flag)),
        Value::Number(number) => {
            number.as_i64().map(SettingValue::Whole).or_else(|| number.as_f64().map(SettingValue::Number))
        }
        Value::String(word) => Some(SettingValue::Word(word.clone())),
        Value::Array(items) => items.iter().map(Value::as_f64).collect::<Option<Vec<_>>>().map(SettingValue::Numbers),
        _ => None,
    };
    converted.ok_or_else(|| source.wrong(path, "is no flag, number, word or list of numbers"))
}

/// Returns the strategy that a document names, or the default one.
fn strategy(
    document: &Document,
    strategies: &[&'static dyn StrategyDefinition],
    source: &Source,
) -> Result<&'static dyn StrategyDefinition, Error> {
    let Some(name) = document.strategy.get("name") else { return Ok(&Truncation) };
    let path = "/strategy/name";
    let name = name.as_str().ok_or_else(|| source.wrong(path, "is not a text in quotes"))?;
    let names = strategies.iter().map(|strategy| strategy.name());
    Ok(strategies[source.position(names, ("strategy", name), path)?])
}

/// Lists the settings of a strategy that a document changes, with its values as defaults.
fn strategy_settings(
    document: &Document,
    strategy: &dyn StrategyDefinition,
    source: &Source,
) -> Result<Vec<Setting>, Error> {
    let settings = Settings::new(strategy.settings())?;
    let mut changed = Vec::new();
    for (section, values) in [("evolution", &document.evolution), ("strategy", &document.strategy)] {
        for (name, value) in values.iter().filter(|(name, _)| section != "strategy" || *name != "name") {
            let path = format!("/{section}/{name}");
            let setting = settings.find(&source.of(&path), &format!("{section}.{name}"))?;
            let default = setting.with_default(setting_value(value, &path, source)?);
            changed.push(default.map_err(|why| source.wrong(&path, why))?.at(&source.of(&path)));
        }
    }
    Ok(changed)
}

/// Names of conditions, with the settings that each changes.
type Conditions = (Vec<&'static str>, Vec<Vec<Change>>);
/// Key and value of a changed setting, and its place.
type Change = (String, SettingValue, String);

/// Reads the conditions of a document, which change settings of a table.
fn conditions(document: &Document, table: &[Setting], source: &Source) -> Result<Conditions, Error> {
    let names: Vec<&'static str> = document.conditions.iter().map(|condition| leaked(&condition.name)).collect();
    if let Some(index) = (1..names.len()).find(|index| names[..*index].contains(&names[*index])) {
        return Err(source.wrong(&format!("/conditions/{index}/name"), "stands twice"));
    }
    let changes = document.conditions.iter().enumerate().map(|(index, condition)| {
        let mut settings = Settings::new(table.to_vec())?;
        let change = |(key, value): (&String, &Value)| {
            let path = format!("/conditions/{index}/settings/{key}");
            settings.set(&source.of(&path), key, setting_value(value, &path, source)?)?;
            Ok((key.clone(), settings.get(key)?.clone(), source.of(&path)))
        };
        condition.settings.iter().map(change).collect::<Result<Vec<_>, Error>>()
    });
    let changes = changes.collect::<Result<_, _>>()?;
    Ok((names, changes))
}

impl Experiment for ComposedExperiment {
    fn name(&self) -> &'static str {
        self.name
    }

    fn values_version(&self) -> u32 {
        self.values_version
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
        let settings = self.entries.iter().map(|entry| &entry.setting);
        let place = self.conditions.iter().position(|name| *name == condition);
        let changes = place.map_or(&[][..], |place| &self.changes[place]);
        let changed = |setting: &Setting| {
            let change = changes.iter().find(|(key, ..)| key == setting.key());
            let changed = |(_, value, place): &Change| Some(setting.with_default(value.clone()).ok()?.at(place));
            change.and_then(changed).unwrap_or_else(|| setting.clone())
        };
        settings.chain(&self.strategy_settings).map(changed).collect()
    }

    fn definition(&self) -> Option<&str> {
        Some(&self.text)
    }

    fn strategy_place(&self) -> String {
        self.source.of("/strategy/name")
    }

    fn gene_bits(&self) -> u32 {
        self.gene_bits
    }

    fn prepare(&self, _: &str, settings: &Settings) -> Result<Box<dyn Evaluator>, Error> {
        self.prepare_with(settings, Vec::new())
    }
}
