//! The experiment `passive-walker`, in which two legs walk down a slope without a motor.

pub use crate::walking::{
    episode::Brain, episode::Launch, episode::Pace, episode::SENSES, episode::Walk, episode::WalkerEpisode,
};
pub use crate::walking::{gait::End, gait::Footfall, gait::Gait, gait::Rules};
pub use crate::walking::{walker::Legs, walker::Posture, walker::Walker, walker::WalkerParts};
pub use crate::worlds::Engine;

use farsa_body::Recorder;
use farsa_body::robot::Robot;
use farsa_models::mjcf::MjcfOptions;
use farsa_num::{Real, Scalar};
use farsa_physics::articulated::{Model, Options, World};

use crate::walking::schema::{drawn, exported, schema};
use crate::walking::settings::{engine, mjcf_options, on_contacts, outcome, walk};
use crate::walking::simplest_model::{ModelGait, SLOPES, WalkingModel};
use farsa_lab::advanced::{Bodies, Description, ENGINE, Rollout, mean_of_trials};
use farsa_lab::exports::Exports;
use farsa_lab::{
    Combination, Episode, EpisodeId, Error, Evaluation, Evaluator, Experiment, InWorld, Note, Outcome, Parameter,
    Setting, Settings, Task, TaskInfo,
};
use farsa_view::Schema;

/// Tests if a rigid body with light feet walks like the simplest walking model \[Garcia1998\].
///
/// A biped with two stiff pairs of legs is launched down a slope. The initial state is that of the walking model for
/// this slope, with a small disturbance. Nothing evolves in this experiment. A run consists of one generation with one
/// walker. It has one gene without effect, so that `farsa run`, `test`, `replay`, `draw` and `report` can be used as
/// usual. The fitness is the distance in meters. The world uses double precision.
///
/// In contrast to the source, the feet have a mass and a radius, the ground is compliant, and the walker is a rigid
/// body with contacts. The results are compared in `docs/results/walking.md`.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Default)]
pub struct PassiveWalker;

/// The configuration of `passive-walker`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Config {
    /// Number of trials in an evaluation.
    pub trials: u32,
    /// Number of dynamics steps in each tick.
    pub substeps: u32,
    /// Environment in which the walker moves.
    pub walk: Walk,
    /// Body of the walker.
    pub walker: Walker,
    /// Physics engine that simulates the walker.
    pub engine: Engine,
}

impl Default for Config {
    fn default() -> Self {
        let rules = Rules { settling: 0.02, ..Rules::default() };
        let walk = Walk { slope: 0.009, gravity: 9.81, time_step: 0.002, steps: 15_000, noise: 0.01, rules };
        Self {
            trials: 5,
            substeps: 16,
            walk,
            walker: Walker { stiffness: 1e6, damping_ratio: 5.0, ..Walker::default() },
            engine: Engine::default(),
        }
    }
}

impl Config {
    /// Builds a model of the walker for the articulated world, and returns the identifiers of its parts.
    ///
    /// # Errors
    /// Returns [`Error::Other`] if the body is invalid.
    pub fn model<R: Real>(&self) -> Result<(Model<R>, WalkerParts), Error> {
        let (robot, parts) = self.walker.robot();
        let options = Options {
            time_step: self.walk.time_step,
            substeps: self.substeps,
            gravity: Walker::gravity(self.walk.gravity, self.walk.slope),
            sweeps: 20,
            friction_compliance: 1e-6,
            margin: 1e-6 * self.walker.legs[0].length,
            ..Options::default()
        };
        let model = Model::new(&robot, &options).map_err(|error| Error::Other(format!("passive-walker: {error}")))?;
        Ok((model, parts))
    }

    /// Returns the options for simulations in rapier. Note that contacts are much harder there than the stiffness of
    /// the ground suggests.
    #[cfg(feature = "rapier")]
    pub fn rapier_options(&self) -> farsa_physics::rapier::Options {
        crate::walking::settings::rapier_options(&self.walk, &self.walker, self.substeps, 200)
    }

    /// Computes the gait of the walking model on this slope.
    ///
    /// # Errors
    /// Returns [`Error::Setting`] if there is no gait for the slope.
    pub fn gait(&self) -> Result<ModelGait, Error> {
        let model = WalkingModel::new(self.walk.slope).map_err(|error| Error::setting("world.slope", error))?;
        let none = || Error::setting("world.slope", "the walking model has no gait on it; 0.009 has one");
        model.gait().ok_or_else(none)
    }

    /// Returns the initial state of a gait, with rates converted to radians per second.
    pub fn launch(&self, gait: &ModelGait) -> Launch {
        let per_second = Scalar::sqrt(self.walk.gravity / self.walker.legs[0].length);
        // The swing leg's own angle is theta - phi.
        let rates = [gait.rate, gait.rate - gait.swing_rate].map(|rate| rate * per_second);
        Launch { angles: [gait.angle, -gait.angle], rates }
    }
}

impl Experiment for PassiveWalker {
    fn name(&self) -> &'static str {
        "passive-walker"
    }

    // 2: sweeps of contacts that settle.
    fn values_version(&self) -> u32 {
        2
    }

    fn summary(&self) -> &'static str {
        "two legs walk down a slope by themselves, compared with the simplest walking model; nothing evolves"
    }

    fn settings(&self, _: &str) -> Vec<Setting> {
        let Config { trials, substeps, walk, walker, engine: _ } = Config::default();
        let [low, high] = SLOPES;
        let legs = walker.legs[0];
        let only_one = |key: &str, doc: &str| Setting::whole(key, 1, 1..=1).derived().doc(doc);
        vec![
            only_one("evolution.generations", "Nothing evolves: one generation."),
            only_one("evolution.population", "Nothing evolves: one walker."),
            only_one("evolution.parents", "Nothing evolves: one walker."),
            engine(),
            Setting::number("world.slope", walk.slope, low..=high)
                .unit("rad")
                .given()
                .doc("Slope, falling ahead. Gaits of the walking model are stable up to about 0.015."),
            Setting::number("world.gravity", walk.gravity, 0.1..=100.0).unit("m/s2").doc("Gravity."),
            Setting::number("world.time_step", walk.time_step, 1e-6..=0.01)
                .unit("s")
                .doc("Tick: so often feet are looked at and ground is given and taken."),
            Setting::whole("world.substeps", i64::from(substeps), 1..=1000)
                .doc("Dynamics steps of a tick. A footfall needs some within its shortest time, stiffness/damping."),
            Setting::whole("trial.count", i64::from(trials), 1..=100_000).doc("Trials, each with its own launch."),
            Setting::whole("trial.steps", i64::from(walk.steps), 1..=10_000_000).doc("Most ticks of a trial."),
            Setting::number("start.noise", walk.noise, 0.0..=1.0)
                .doc("By how much the launch's rates differ from the walking model's at most, in parts of them."),
            Setting::number("walker.leg_length", legs.length, 0.05..=10.0).unit("m").doc("From hip to sole."),
            Setting::number("walker.hip_mass", walker.hip_mass, 0.01..=1000.0).unit("kg").doc("Mass at the hip."),
            Setting::number("walker.leg_mass", legs.mass, 0.0..=100.0).unit("kg").doc("Mass spread along each pair of legs."),
            Setting::number("walker.foot_mass", legs.foot_mass, 1e-6..=100.0)
                .unit("kg")
                .doc("Mass at the soles of each pair. The walking model is the limit of none."),
            Setting::number("walker.foot_radius", legs.foot_radius, 1e-6..=10.0)
                .unit("m")
                .doc("Radius of the soles. The walking model is the limit of points."),
            Setting::number("walker.hip_range", walker.hip_range, 0.1..=3.0)
                .unit("rad")
                .doc("Largest turn of the legs against each other, to each side."),
            Setting::number("contact.friction", walker.friction, 0.0..=10.0).doc("Coefficient of friction."),
            Setting::number("contact.stiffness", walker.stiffness, 1.0..=1e12).unit("N/m").doc("Stiffness of a footfall."),
            Setting::number("contact.damping_ratio", walker.damping_ratio, 0.0..=1000.0).doc(
                "Damping ratio of the walker's mass on that stiffness. Below about 3 the walker bounces off its footfalls.",
            ),
        ]
    }

    fn gene_bits(&self) -> u32 {
        1
    }

    fn prepare(&self, _: &str, settings: &Settings) -> Result<Box<dyn Evaluator>, Error> {
        let plain = Config::default();
        let number = |key: &str| settings.number(key);
        let legs = Legs {
            length: number("walker.leg_length")?,
            mass: number("walker.leg_mass")?,
            foot_mass: number("walker.foot_mass")?,
            foot_radius: number("walker.foot_radius")?,
        };
        if legs.foot_radius > legs.length {
            let why = format!("{} m: at most a leg, {} m", legs.foot_radius, legs.length);
            return Err(Error::setting("walker.foot_radius", why));
        }
        let config = Config {
            trials: settings.count("trial.count")? as u32,
            substeps: settings.count("world.substeps")? as u32,
            walk: walk(settings, plain.walk)?,
            walker: Walker {
                legs: [legs; 2],
                hip_mass: number("walker.hip_mass")?,
                hip_range: number("walker.hip_range")?,
                ..on_contacts(settings, plain.walker)?
            },
            engine: settings.word(ENGINE)?.parse()?,
        };
        match config.engine {
            Engine::Articulated => Ok(Box::new(evaluator(config)?)),
            #[cfg(feature = "rapier")]
            Engine::Rapier => Ok(Box::new(evaluator_in_rapier(config)?)),
            #[cfg(not(feature = "rapier"))]
            Engine::Rapier => Err(config.engine.missing()),
        }
    }
}

/// Creates an evaluator that simulates a walker in the articulated world.
///
/// # Errors
/// Returns [`Error::Setting`] if there is no gait for the slope, or [`Error::Other`] if the body is invalid.
pub fn evaluator(config: Config) -> Result<InWorld<World<f64>, PassiveTrial>, Error> {
    let (model, parts) = config.model()?;
    Ok(InWorld::new(World::new(model), PassiveTrial::new(config, parts)?).with_displacements().with_pushes())
}

/// Creates an evaluator that simulates a walker in rapier.
///
/// # Errors
/// Returns the same errors as [`evaluator`].
#[cfg(feature = "rapier")]
pub fn evaluator_in_rapier(config: Config) -> Result<InWorld<farsa_physics::rapier::World, PassiveTrial>, Error> {
    let (robot, parts) = config.walker.robot();
    let world = farsa_physics::rapier::World::new(&robot, &config.rapier_options());
    let world = world.map_err(|error| Error::Other(format!("passive-walker: {error}")))?;
    Ok(InWorld::new(world, PassiveTrial::new(config, parts)?).with_displacements().with_pushes())
}

/// A walk down the slope that starts with the gait of the simplest walking model.
pub struct PassiveTrial {
    config: Config,
    episode: WalkerEpisode,
    gait: ModelGait,
}

impl PassiveTrial {
    fn new(config: Config, parts: WalkerParts) -> Result<Self, Error> {
        let gait = config.gait()?;
        let episode = WalkerEpisode::new(config.walker, parts, config.walk, config.launch(&gait), None);
        Ok(Self { config, episode, gait })
    }
}

impl<W> Episode<W> for PassiveTrial
where
    WalkerEpisode: Episode<W>,
{
    fn start(&mut self, world: &mut W, id: EpisodeId) {
        self.episode.start(world, id);
    }
    fn act(&mut self, world: &mut W) {
        self.episode.act(world);
    }
    fn judge(&mut self, world: &mut W) -> Option<f64> {
        self.episode.judge(world)
    }
    fn record(&self, world: &W, recorder: &mut dyn Recorder) {
        self.episode.record(world, recorder);
    }
}

impl PassiveTrial {
    fn description(&self) -> Description {
        let Walk { steps, time_step, .. } = self.config.walk;
        Description {
            network: "none: gravity and footfalls".into(),
            steps: steps as usize,
            step_seconds: time_step,
            ..Description::default()
        }
    }
}

impl Task for PassiveTrial {
    /// Nothing evolves: one parameter that nothing depends on.
    fn info(&self) -> TaskInfo {
        TaskInfo {
            combination: Some(Combination::Mean),
            description: self.description(),
            trials: self.config.trials as usize,
            terms: vec!["distance [m]".into()],
            ..TaskInfo::new(vec![Parameter::new("none", [0.0, 1.0])], schema(&exported(&self.config.walker)))
        }
    }

    /// The mean over the trials.
    fn fitness(&self, trials: &[Outcome]) -> f64 {
        mean_of_trials(trials)
    }

    fn exports(&self) -> Option<&dyn Exports> {
        Some(self)
    }

    fn bodies(&self) -> Option<&dyn Bodies> {
        Some(self)
    }
}

impl Exports for PassiveTrial {
    fn mjcf_options(&self) -> Option<MjcfOptions> {
        Some(mjcf_options(&self.config.walk))
    }

    /// With soles that touch, where a recording has those that are drawn.
    fn robot(&self, _: Option<&[f32]>) -> Option<Robot> {
        Some(exported(&self.config.walker))
    }
}

impl Bodies for PassiveTrial {
    fn schema_with(&self, _: &[f32]) -> Schema {
        schema(&drawn(&self.config.walker))
    }
}

impl Rollout for PassiveTrial {
    fn load(&mut self, _: &Evaluation<'_>) -> bool {
        true
    }

    fn outcome(&self) -> Outcome {
        let mut outcome = outcome(&self.episode);
        // A walk of fewer steps has a pace of zeros, so that every trial has the same notes.
        let pace = self.episode.pace().unwrap_or_default();
        let unit = self.episode.unit_of_time();
        let of_model = |found: f64, known: f64| 100.0 * (found / known - 1.0);
        outcome.notes.extend([
            ("step angle off the model's [%]", Note::from(of_model(pace.angle, self.gait.angle))),
            ("step rate off the model's [%]", Note::from(of_model(pace.rate * unit, self.gait.rate))),
            ("step period off the model's [%]", Note::from(of_model(pace.period / unit, self.gait.period))),
        ]);
        outcome
    }
}
