//! The experiment `body-evolution`. It evolves the body of a walker and optionally a network at its hip.

use farsa_body::Recorder;
use farsa_body::robot::Robot;
use farsa_models::mjcf::MjcfOptions;
use farsa_nn::{Leak, LeakyLayout};
use farsa_num::Scalar;
use farsa_physics::articulated::{Model, Options, World};

use crate::walking::episode::{Brain, FULL, Launch, SENSES, Walk, WalkerEpisode};
use crate::walking::gait::Rules;
use crate::walking::schema::{drawn, exported, schema};
#[cfg(feature = "rapier")]
use crate::walking::settings::rapier_options;
use crate::walking::settings::{engine, mjcf_options, on_contacts, outcome, walk};
use crate::walking::walker::{Legs, Walker};
use crate::worlds::Engine;
use farsa_lab::advanced::{
    Behavior, Bodies, ChannelGroup, Description, ENGINE, Genotype, mean_of_note, mean_of_trials, network_parameters,
    run_episode,
};
use farsa_lab::exports::{ControllerExport, Exports, MotorExport, NetworkExport, SensorExport};
use farsa_lab::{
    Combination, Episode, EpisodeId, Error, Evaluation, Evaluator, Experiment, Note, Outcome, Parameter, Setting,
    Settings, Task, TaskInfo,
};
use farsa_view::Schema;

/// Evolves walkers that cover a large distance `[McGeer1990]`.
///
/// The genes determine the legs, the masses, the soles and the initial push of a walker. Its fitness is the distance
/// that it walks. With the condition `passive`, it walks down a slope without a motor or a controller. With `powered`,
/// it walks on flat ground, and additional genes encode a small network that drives a motor at the hip. Since distance
/// is measured at footfalls, a body gains nothing if it rolls, slides, hops or exploits errors of the simulation (see
/// [`Rules`]).
///
/// Unlike here, the walkers in the source were built and not evolved. The spacing of the hips is a gene without effect,
/// because the walker moves in a plane. It demonstrates genetic drift in the absence of selection.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Default)]
pub struct BodyEvolution;

/// The meaning of one gene of a body, and its range.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Part {
    key: &'static str,
    unit: &'static str,
    range: [f64; 2],
    doc: &'static str,
}

const fn part(key: &'static str, unit: &'static str, range: [f64; 2], doc: &'static str) -> Part {
    Part { key, unit, range, doc }
}

/// The genes of a body in their order.
const BODY: [Part; 10] = [
    part("body.leg_length", "m", [0.6, 1.0], "Length of the outer legs: a gene."),
    part("body.leg_ratio", "", [0.97, 1.03], "Length of the inner legs in outer ones: a gene."),
    part("body.hip_mass", "kg", [1.0, 20.0], "Mass at the hip: a gene."),
    part("body.leg_mass", "kg", [0.1, 5.0], "Mass along each pair of legs: a gene."),
    part("body.foot_mass", "kg", [0.05, 2.0], "Mass at the soles of each pair: a gene."),
    part("body.foot_radius", "m", [0.01, 0.3], "Radius of the soles: a gene."),
    part(
        "body.hip_spacing",
        "m",
        [0.1, 0.5],
        "Distance of the outer feet: a gene, without effect in the plane of motion.",
    ),
    part("start.angle", "rad", [0.1, 0.4], "Angle of the legs ahead and behind at the launch: a gene."),
    part("start.rate", "sqrt(g/l)", [-0.6, -0.1], "Rate of the stance leg at the launch: a gene."),
    part("start.swing_rate", "sqrt(g/l)", [-0.5, 0.5], "Rate of the swing leg at the launch: a gene."),
];

/// Parameters of a body.
const BODY_PARAMETERS: usize = BODY.len();

/// The configuration of `body-evolution`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Config {
    /// Number of trials in an evaluation.
    pub trials: u32,
    /// Number of dynamics steps in each tick.
    pub substeps: u32,
    /// Environment in which the walkers move.
    pub walk: Walk,
    /// Properties that are the same for all bodies.
    pub walker: Walker,
    /// Lowest and highest value of each kind of gene.
    pub ranges: [[f64; 2]; 10],
    /// Number of hidden neurons of the network. If there is no motor, there is no network.
    pub hidden: u32,
    /// Largest absolute value of a weight.
    pub weights: f64,
    /// Physics engine that simulates the walkers.
    pub engine: Engine,
}

impl Config {
    /// Returns the default configuration. If `powered` is true, the walker has a motor and moves on flat ground.
    /// Otherwise it walks down a slope.
    pub fn new(powered: bool) -> Self {
        let rules = Rules { settling: 0.05, ..Rules::default() };
        let slope = if powered { 0.0 } else { 0.03 };
        let torque = if powered { 10.0 } else { 0.0 };
        Self {
            trials: 2,
            substeps: 3,
            walk: Walk { slope, gravity: 9.81, time_step: 0.005, steps: 5000, noise: 0.01, rules },
            walker: Walker { stiffness: 5e4, damping_ratio: 3.0, torque, ..Walker::default() },
            ranges: BODY.map(|part| part.range),
            hidden: 3,
            weights: 8.0,
            engine: Engine::default(),
        }
    }

    fn powered(&self) -> bool {
        self.walker.torque > 0.0
    }

    fn layout(&self) -> Option<LeakyLayout> {
        self.powered().then(|| LeakyLayout::new(SENSES, self.hidden as usize, 1).with_slope(1.0))
    }

    /// The body and the launch that parameters are for.
    fn body(&self, parameters: &[f32]) -> Option<(Walker, Launch)> {
        let values: &[f32; BODY_PARAMETERS] = parameters.first_chunk()?;
        let [length, ratio, hip, mass, foot_mass, foot_radius, spacing, angle, rate, swing] = values.map(f64::from);
        let legs = [length, length * ratio].map(|length| Legs { length, mass, foot_mass, foot_radius });
        // Genes are rates in units of sqrt(g / l), those of a pendulum of the outer legs.
        let per_second = Scalar::sqrt(self.walk.gravity / length);
        let launch = Launch { angles: [angle, -angle], rates: [rate * per_second, swing * per_second] };
        Some((Walker { legs, hip_mass: hip, hip_spacing: spacing, ..self.walker }, launch))
    }

    /// A walker with these parameters, and its episode.
    fn episode(&self, evaluation: &Evaluation<'_>) -> Option<(Robot, WalkerEpisode)> {
        let parameters = evaluation.parameters;
        let (walker, launch) = self.body(parameters)?;
        let (robot, parts) = walker.robot();
        let brain = match self.layout() {
            Some(layout) => {
                let mut brain =
                    Brain::new(&walker, &parts, layout, parameters.get(BODY_PARAMETERS..)?.to_vec()).ok()?;
                brain.normalise(evaluation.normalisation).then_some(())?;
                Some(brain)
            }
            None => None,
        };
        Some((robot, WalkerEpisode::new(walker, parts, self.walk, launch, brain)))
    }

    /// A walker in our articulated world.
    fn world(&self, robot: &Robot) -> Option<World<f32>> {
        let options = Options {
            time_step: self.walk.time_step,
            substeps: self.substeps,
            gravity: Walker::gravity(self.walk.gravity, self.walk.slope),
            ..Options::default()
        };
        Some(World::new(Model::new(robot, &options).ok()?))
    }
}

const CONDITIONS: [&str; 2] = ["passive", "powered"];

impl Experiment for BodyEvolution {
    fn name(&self) -> &'static str {
        "body-evolution"
    }

    // 2: sweeps of contacts that settle.
    fn values_version(&self) -> u32 {
        2
    }

    fn summary(&self) -> &'static str {
        "legs, masses and soles of a walker evolve for the distance it walks, alone or with a small network at its hip"
    }

    fn conditions(&self) -> &'static [&'static str] {
        &CONDITIONS
    }

    fn settings(&self, condition: &str) -> Vec<Setting> {
        let powered = condition == CONDITIONS[1];
        let Config { trials, substeps, walk, walker, hidden, weights, .. } = Config::new(powered);
        let mut table = vec![
            Setting::whole("evolution.generations", if powered { 60 } else { 30 }, 1..=i64::from(u32::MAX) - 1)
                .doc("Generations that are evaluated. A resumed run may change it, and nothing else."),
            Setting::whole("evolution.population", 60, 1..=1_000_000)
                .doc("Individuals of a generation, a multiple of the parents. With no more than them nothing is ever mutated."),
            Setting::whole("evolution.parents", 12, 1..=1_000_000)
                .doc("The best individuals, which make population / parents copies each. The first copy is unchanged."),
            Setting::number("evolution.mutation_rate", 0.03, 0.0..=1.0).doc("Probability that mutation hits a bit."),
            engine(),
            Setting::number("world.slope", walk.slope, -0.2..=0.2).unit("rad").doc("Slope, falling ahead."),
            Setting::number("world.gravity", walk.gravity, 0.1..=100.0).unit("m/s2").doc("Gravity."),
            Setting::number("world.time_step", walk.time_step, 1e-4..=0.02)
                .unit("s")
                .doc("Tick: so often the network thinks, feet are looked at and ground is given and taken."),
            Setting::whole("world.substeps", i64::from(substeps), 1..=1000).doc("Dynamics steps of a tick."),
            Setting::whole("trial.count", i64::from(trials), 1..=100_000).doc("Trials, each with its own launch."),
            Setting::whole("trial.steps", i64::from(walk.steps), 1..=10_000_000).doc("Most ticks of a trial."),
            Setting::number("start.noise", walk.noise, 0.0..=1.0)
                .doc("By how much the launch's rates differ from the genes' at most, in parts of them."),
            Setting::number("contact.friction", walker.friction, 0.0..=10.0).doc("Coefficient of friction."),
            Setting::number("contact.stiffness", walker.stiffness, 1.0..=1e9).unit("N/m").doc("Stiffness of a footfall."),
            Setting::number("contact.damping_ratio", walker.damping_ratio, 0.0..=1000.0)
                .doc("Damping ratio of the walker's mass on that stiffness. Below about 3 walkers bounce off their footfalls."),
        ];
        for part in BODY {
            let lowest = if part.range[0] > 0.0 { 1e-3 } else { -10.0 };
            table.push(Setting::numbers(part.key, &part.range, lowest..=100.0).unit(part.unit).doc(part.doc));
        }
        if powered {
            table.push(
                Setting::number("motor.torque", walker.torque, 1e-3..=1e4)
                    .unit("N m")
                    .doc("Largest torque at the hip."),
            );
            table.push(
                Setting::whole("network.hidden", i64::from(hidden), 1..=1000).doc("Hidden neurons, all linked to all."),
            );
            table.push(
                Setting::number("network.range", weights, 0.0..=1000.0)
                    .doc("Weights and biases lie from minus this to this."),
            );
        }
        table
    }

    fn prepare(&self, condition: &str, settings: &Settings) -> Result<Box<dyn Evaluator>, Error> {
        let powered = condition == CONDITIONS[1];
        let plain = Config::new(powered);
        let number = |key: &str| settings.number(key);
        let mut config = Config {
            trials: settings.count("trial.count")? as u32,
            substeps: settings.count("world.substeps")? as u32,
            walk: walk(settings, plain.walk)?,
            walker: on_contacts(settings, plain.walker)?,
            engine: settings.word(ENGINE)?.parse()?,
            ..plain
        };
        #[cfg(not(feature = "rapier"))]
        if config.engine == Engine::Rapier {
            return Err(config.engine.missing());
        }
        for (range, part) in config.ranges.iter_mut().zip(BODY) {
            let values = settings.numbers(part.key)?;
            let (low, high) = (values[0], values[1]);
            if low > high {
                return Err(Error::setting(part.key, format!("from {low} to {high}: must rise")));
            }
            *range = [low, high];
        }
        let [[outer, _], [ratio, _], .., [_, widest], _, _, _, _] = config.ranges;
        // The shortest leg of all genotypes. A larger radius would put the center of a sole above the hip.
        let shortest = outer * ratio.min(1.0);
        if widest > shortest {
            let why = format!("up to {widest} m: at most the shortest leg, {shortest} m");
            return Err(Error::setting("body.foot_radius", why));
        }
        if powered {
            config.walker.torque = number("motor.torque")?;
            config.hidden = settings.count("network.hidden")? as u32;
            config.weights = number("network.range")?;
        }
        Ok(Box::new(Walkers::new(config)))
    }
}

/// Notes that behaviors are described by.
const WORK: &str = "work of the motor [J]";
const LEGS: &str = "outer legs [m]";
const SOLES: &str = "soles [m]";

/// Evaluates walkers. Every individual is simulated in a different world, because the bodies differ.
pub struct Walkers {
    config: Config,
}

impl Walkers {
    /// Creates an evaluator for the given configuration.
    pub fn new(config: Config) -> Self {
        Self { config }
    }

    fn body(&self, parameters: &[f32]) -> Walker {
        self.config.body(parameters).map_or(self.config.walker, |(walker, _)| walker)
    }

    fn with_network(&self, schema: Schema) -> Schema {
        let Some(layout) = self.config.layout() else { return schema };
        let senses = ["outer legs", "inner legs against outer", "speed of the outer legs", "speed of the inner legs"];
        let mut schema = schema.with_sensors(senses.into_iter().chain(["outer touch", "inner touch"]));
        schema = schema.with_outputs(["hip torque"]).with_network(&layout);
        schema.outputs.iter_mut().for_each(|output| output.range = Some([0.0, 1.0]));
        schema
    }
}

impl Walkers {
    fn parameters(&self) -> Vec<Parameter> {
        let of_body = BODY.iter().zip(self.config.ranges);
        // Bodies are computed from numbers that f32 holds.
        let of_body = of_body.map(|(part, ends)| Parameter::new(part.key, ends.map(|end| f64::from(end as f32))));
        let to_network = self
            .config
            .layout()
            .and_then(|layout| network_parameters(&layout, self.config.weights, [0.0, 1.0], "network.range").ok());
        of_body.chain(to_network.into_iter().flatten()).collect()
    }

    /// The schema of the middle of all bodies.
    fn schema(&self) -> Schema {
        let genotype = Genotype::new(&self.parameters()[..BODY_PARAMETERS], u16::BITS);
        let middle = genotype.decode(&[u16::MAX / 2; BODY_PARAMETERS]).unwrap_or_default();
        self.with_network(schema(&exported(&self.body(&middle))))
    }

    fn description(&self) -> Description {
        let Walk { steps, time_step, .. } = self.config.walk;
        let plain = Description { steps: steps as usize, step_seconds: time_step, ..Description::default() };
        let Some(layout) = self.config.layout() else {
            return Description { network: "none: gravity and footfalls".into(), ..plain };
        };
        Description {
            sensors: vec![
                ChannelGroup::new(
                    "angles",
                    2,
                    "outer legs from the ground's normal, inner legs against them, 1 at 0.6 rad",
                ),
                ChannelGroup::new("speeds", 2, "the same, 1 at 3 rad/s"),
                ChannelGroup::new("touches", 2, "outer and inner feet, 0 off the ground .. 1 on it"),
            ],
            motors: vec![ChannelGroup::new("hip torque", 1, "on the inner legs, 0 ahead .. 1/2 none .. 1 back")],
            network: format!("{SENSES}-{}-1, recurrent hidden layer, leak filter", layout.hidden()),
            parameters: layout.parameter_count(),
            ..plain
        }
    }
}

impl Task for Walkers {
    fn info(&self) -> TaskInfo {
        TaskInfo {
            combination: Some(Combination::Mean),
            description: self.description(),
            trials: self.config.trials as usize,
            terms: vec!["distance [m]".into()],
            observations: if self.config.powered() { SENSES } else { 0 },
            ..TaskInfo::new(self.parameters(), self.schema())
        }
    }

    /// The mean over the trials.
    fn fitness(&self, trials: &[Outcome]) -> f64 {
        mean_of_trials(trials)
    }

    fn behavior(&self) -> Option<&dyn Behavior> {
        Some(self)
    }

    fn exports(&self) -> Option<&dyn Exports> {
        Some(self)
    }

    fn bodies(&self) -> Option<&dyn Bodies> {
        Some(self)
    }
}

/// The work of a walk, and its body: legs and soles.
impl Behavior for Walkers {
    fn objectives(&self) -> Vec<String> {
        vec![format!("minus {WORK}")]
    }

    fn measures(&self) -> Vec<Parameter> {
        let [legs, _, _, _, _, soles, ..] = self.config.ranges;
        vec![Parameter::new(LEGS, legs), Parameter::new(SOLES, soles)]
    }

    fn describe(&self, trials: &[Outcome]) -> Vec<f64> {
        vec![-mean_of_note(trials, WORK), mean_of_note(trials, LEGS), mean_of_note(trials, SOLES)]
    }
}

impl Exports for Walkers {
    fn mjcf_options(&self) -> Option<MjcfOptions> {
        Some(mjcf_options(&self.config.walk))
    }

    /// The robot of parameters for other programs: ball soles, as in the [`schema`](TaskInfo::schema) of the middle of
    /// all bodies.
    fn robot(&self, parameters: Option<&[f32]>) -> Option<Robot> {
        parameters.map(|parameters| exported(&self.body(parameters)))
    }

    fn controller(&self, parameters: &[f32]) -> Option<ControllerExport> {
        let layout = self.config.layout()?;
        let to_network = parameters.get(BODY_PARAMETERS..).filter(|rest| rest.len() == layout.parameter_count())?;
        let [angle, speed] = FULL.map(f64::from);
        let legs = ["outer legs from the ground's normal", "inner legs from the outer ones"];
        let angles = legs.map(|legs| (format!("angle of the {legs}"), "rad", angle));
        let speeds = legs.map(|legs| (format!("angular velocity of the {legs}"), "rad/s", speed));
        let touches = ["outer", "inner"].map(|feet| (format!("whether the {feet} feet touch the ground"), "1", 1.0));
        let named = self.schema().sensors.into_iter().map(|channel| channel.name);
        let sensors = named.zip(angles.into_iter().chain(speeds).chain(touches));
        let sensors = sensors.map(|(name, (what, unit, one))| SensorExport::quantity(name, what, unit, [0.0, one]));
        let torque = self.body(parameters).torque;
        let motor = MotorExport::quantity("hip torque", "torque on the inner legs, back", "N m", [-torque, torque]);
        let network = NetworkExport::leaky(&layout, Leak::Filter, to_network);
        let Walk { steps, time_step, .. } = self.config.walk;
        Some(ControllerExport::new(network, sensors.collect(), vec![motor], time_step, steps))
    }
}

impl Bodies for Walkers {
    fn schema_with(&self, parameters: &[f32]) -> Schema {
        self.with_network(schema(&drawn(&self.body(parameters))))
    }
}

impl Evaluator for Walkers {
    fn record_start(&mut self, evaluation: Evaluation<'_>, recorder: &mut dyn Recorder) -> bool {
        // Both engines start from the same state.
        let Some((robot, mut episode)) = self.config.episode(&evaluation) else { return false };
        let Some(mut world) = self.config.world(&robot) else { return false };
        episode.start(&mut world, evaluation.id);
        episode.record(&world, recorder);
        true
    }

    /// Success is ten strides, twenty steps, without a fall.
    fn evaluate(&mut self, evaluation: Evaluation<'_>, recorder: Option<&mut dyn Recorder>) -> Outcome {
        let Some((robot, episode)) = self.config.episode(&evaluation) else { return Outcome::failed() };
        match self.config.engine {
            Engine::Articulated => walk_in(self.config.world(&robot), episode, evaluation.id, recorder),
            #[cfg(feature = "rapier")]
            Engine::Rapier => {
                let options = rapier_options(&self.config.walk, episode.gait().walker(), self.config.substeps, 40);
                walk_in(farsa_physics::rapier::World::new(&robot, &options).ok(), episode, evaluation.id, recorder)
            }
            #[cfg(not(feature = "rapier"))]
            Engine::Rapier => Outcome::failed(),
        }
    }
}

/// A walk in a world, or `None` for a body that cannot be built.
fn walk_in<W>(
    world: Option<W>,
    mut episode: WalkerEpisode,
    id: EpisodeId,
    mut recorder: Option<&mut dyn Recorder>,
) -> Outcome
where
    W: farsa_body::ports::World,
    WalkerEpisode: Episode<W>,
{
    let Some(mut world) = world else { return Outcome::failed() };
    if let (Some(recorder), Some(brain)) = (&mut recorder, episode.brain()) {
        recorder.parameters(brain.parameters());
    }
    run_episode(&mut episode, &mut world, id, recorder);
    let mut outcome = outcome(&episode);
    outcome.observed = episode.brain().and_then(Brain::observed).cloned();
    let gait = episode.gait();
    let walker = gait.walker();
    outcome.notes.push((WORK, Note::from(gait.energies()[0])));
    outcome.notes.push(("energy gained [J]", Note::from(gait.energies()[1])));
    let [outer, inner] = walker.legs;
    outcome.notes.extend([
        (LEGS, Note::from(outer.length)),
        ("inner legs [m]", Note::from(inner.length)),
        ("hip [kg]", Note::from(walker.hip_mass)),
        ("shanks [kg]", Note::from(outer.mass)),
        ("feet [kg]", Note::from(outer.foot_mass)),
        (SOLES, Note::from(outer.foot_radius)),
        ("hip spacing [m]", Note::from(walker.hip_spacing)),
    ]);
    outcome
}
