//! The experiment `minimal-cognition`. It studies categorical perception.

use core::f64::consts::FRAC_PI_4;

use farsa_body::ports::BodyId;
use farsa_body::{Pose, Recorder};
use farsa_nn::block::Span;
use farsa_nn::{CtrnnParameter, CtrnnParts};

use crate::minimal_cognition::config::Config;
use crate::minimal_cognition::episode::AgentEpisode;
use crate::minimal_cognition::network::{INNER, LAYOUT, LINKED, MOTOR_ONES, MOTORS, NEURONS, RAYS, Wiring};
use crate::minimal_cognition::object::Object;
use farsa_lab::advanced::{
    Anatomy, ChannelGroup, Description, Interventions, NoWorld, Protocol, Rollout, mean_of_trials, seconds,
};
use farsa_lab::exports::{ControllerExport, Exports, MotorExport, NetworkExport, SensorExport};
use farsa_lab::{
    Combination, Episode, EpisodeId, Error, Evaluation, Evaluator, Experiment, InWorld, Note, Outcome, Setting,
    Settings, Task, TaskInfo,
};
use farsa_num::{Domain, Stream};
use farsa_view::shape::{Color, Geometry, OKABE_ITO, Role, SceneObject};
use farsa_view::{Channel, Links, NodeParameters, Schema, View};

/// An agent with seven rays and a small dynamical network has to catch circles and avoid diamonds \[Beer2003\].
///
/// The agent moves along a line under a falling object. Its continuous-time recurrent network has one sensory neuron
/// for each ray, five inner neurons and two motor neurons. The weights are symmetric with respect to left and right
/// (see [`Wiring`]).
///
/// The search is a genetic algorithm with truncation selection and genes of 16 bits, whereas the source uses real
/// numbers. Starts are drawn in every generation from equal parts of the range, so that no start can be learned by
/// heart. A trial ends when a circle would touch the agent. The settings mark all values that had to be chosen,
/// including the ranges of the parameters.
///
/// Note that a mirrored trial leads to the mirrored path only as long as rounding errors do not matter. The order of
/// the neurons determines the order of additions in the kernel. If the two sides of a network compete, the last bit of
/// a sum can decide between them before the object is in view.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Default)]
pub struct MinimalCognition;

impl Experiment for MinimalCognition {
    fn name(&self) -> &'static str {
        "minimal-cognition"
    }

    fn summary(&self) -> &'static str {
        "an agent with a continuous-time network catches circles and avoids diamonds that fall"
    }

    // 2: genes have the order of `CtrnnSymmetry`.
    fn values_version(&self) -> u32 {
        2
    }

    fn settings(&self, _: &str) -> Vec<Setting> {
        Config::default().table()
    }

    fn prepare(&self, _: &str, settings: &Settings) -> Result<Box<dyn Evaluator>, Error> {
        Ok(Box::new(evaluator(Config::read(settings)?)?))
    }
}

const AGENT: BodyId = BodyId(0);
/// The circle and the diamond, of which one falls.
const OBJECTS: [BodyId; 2] = [BodyId(1), BodyId(2)];
/// Half the thickness that things are drawn with.
const THICK: f64 = 2.0;
/// Depth below the ground of the object that does not fall in a trial.
const AWAY: f64 = -20.0;
const PAPER: Color = [244, 243, 238];

/// Creates an evaluator for the given configuration.
///
/// # Errors
/// Returns [`Error::Other`] if no network can be built from these values.
pub fn evaluator(config: Config) -> Result<InWorld<NoWorld, Agent>, Error> {
    Ok(InWorld::new(NoWorld, Agent::new(config)?))
}

/// The task of the agent, and the mapping from genes to the parameters of its network.
#[derive(Clone, Debug)]
pub struct Agent {
    wiring: Wiring,
    episode: AgentEpisode,
    interventions: Interventions,
    /// Falling shape and the part of the line where it starts, in a case of `psychophysics`.
    falling: Option<(Object, [f64; 2])>,
}

impl Agent {
    /// Creates the task for a configuration.
    ///
    /// # Errors
    /// Returns [`Error::Other`] if no network can be built from these values.
    pub fn new(config: Config) -> Result<Self, Error> {
        let wiring = Wiring::new(&config).map_err(|error| Error::Other(format!("minimal-cognition: {error}")))?;
        let first: Vec<f32> = wiring.parameters().iter().map(|parameter| parameter.ends[0] as f32).collect();
        let parameters = wiring.expand(&first).unwrap_or_default();
        let (interventions, episode) = (interventions(&config), AgentEpisode::new(config, parameters)?);
        Ok(Self { wiring, episode, interventions, falling: None })
    }
}

/// Parts of the line in which objects start, in `psychophysics`.
const PARTS: usize = 11;

/// The protocols: each shape from each part of the line, each ray cut or inner neuron silent, and noise on the rays.
fn interventions(config: &Config) -> Interventions {
    let middle = |part: usize| {
        let [low, high] = part_of_line(config, part);
        format!("{}", (5.0 * (low + high)).round() / 10.0)
    };
    let summary = "does the agent catch circles and avoid diamonds that fall from each part of the line";
    let falling = Protocol::from_table("psychophysics", summary, ["circle", "diamond"], (0..PARTS).map(middle))
        .with_axes("shape", "offset at the start")
        .with_trials(50);
    let inner = (0..INNER).map(|neuron| (format!("inner neuron {}", neuron + 1), RAYS + neuron));
    let rays = (0..RAYS).map(|ray| (format!("ray {}", ray + 1), ray..ray + 1));
    let gain = config.input_gain as f32;
    Interventions::default()
        .with_protocol(falling, Vec::new())
        .with_lesions(rays, inner)
        .with_noise(&[0.0, 0.05, 0.1, 0.2, 0.4].map(|part| part * gain))
}

/// Where one of the [`PARTS`] of the line begins and ends: as wide as the parts of the range in which objects start.
fn part_of_line(config: &Config, part: usize) -> [f64; 2] {
    let width = 2.0 * config.offset / PARTS as f64;
    let low = width * part as f64 - config.offset;
    [low, low + width]
}

/// Records a step that has just passed.
fn record(episode: &AgentEpisode, recorder: &mut dyn Recorder) {
    let Config { body, time_step, input_gain, ray_length, .. } = *episode.config();
    let ([object, agent], height) = (episode.places(), episode.height());
    recorder.sensors(episode.sensed());
    recorder.neurons(&episode.network().neuron_outputs()[..MOTOR_ONES.first]);
    recorder.outputs(episode.done());
    let at = |place: [f64; 3]| place.map(|x| x as f32);
    recorder.pose(AGENT, Pose::at(at([agent, 0.0, 0.0])));
    let falling = usize::from(matches!(episode.object(), Object::Diamond { .. }));
    recorder.pose(OBJECTS[falling], Pose::at(at([object, height, 0.0])));
    recorder.pose(OBJECTS[1 - falling], Pose::at(at([0.0, 0.0, AWAY])));
    for ([sine, cosine], free) in episode.rays().iter().zip(episode.free()) {
        let end = |distance: f64| {
            let distance = 0.5 * body + distance;
            at([agent + distance * sine, distance * cosine, THICK])
        };
        recorder.ray(end(0.0), end(free), free < ray_length && input_gain > 0.0);
    }
    recorder.scalars(&[agent, object, height, object - agent, episode.score()]);
    recorder.tick(seconds(episode.steps(), time_step));
}

/// The parameters in the order of [`TaskInfo::schema`]: weights between the layers, biases, gains, time constants.
fn in_schema_order(parameters: &[f32]) -> Vec<f32> {
    let CtrnnParts { weights, biases, gains, time_constants, .. } = LAYOUT.split(parameters);
    let linked = LINKED.into_iter().flat_map(|(sources, targets)| {
        let row = move |from| (targets.first..targets.end()).map(move |to| weights[from * NEURONS + to]);
        (sources.first..sources.end()).flat_map(row)
    });
    linked.chain([biases, gains, time_constants].into_iter().flatten().copied()).collect()
}

impl Episode<NoWorld> for Agent {
    fn start(&mut self, _: &mut NoWorld, id: EpisodeId) {
        match self.falling {
            None => self.episode.arrange(id),
            Some((object, [low, high])) => {
                let mut stream = Stream::new(id.seed, Domain::Start, id.trial, 0, id.generation);
                self.episode.place(object, stream.range_f64(low, high));
            }
        }
    }
    fn act(&mut self, _: &mut NoWorld) {
        self.episode.step();
    }
    fn judge(&mut self, _: &mut NoWorld) -> Option<f64> {
        self.episode.ended().then(|| self.episode.score())
    }
    fn record(&self, _: &NoWorld, recorder: &mut dyn Recorder) {
        record(&self.episode, recorder);
    }
}

impl Agent {
    fn schema(&self) -> Schema {
        let Config { width, body, diameter, side, start_height, input_gain, clip, .. } = *self.episode.config();
        let in_group = |group: &'static str| move |name: &str| Channel::new(name).group(group);
        let numbered = |name: &str, count: usize| (1..=count).map(|i| format!("{name} {i}")).collect::<Vec<_>>();
        let standing = |place: [f64; 2], turned: f64| {
            let planar = Pose::planar(place, turned);
            Pose { position: [place[0], place[1], THICK], ..planar }
        };
        let round = |diameter: f64| Geometry::Cylinder { radius: 0.5 * diameter, half_length: THICK };
        let square = Geometry::Box { half: [0.5 * side, 0.5 * side, THICK] };
        let paper = Geometry::Rectangle { half: [0.5 * width, 0.5 * (start_height + 2.0 * body)] };
        let thing = |name: &str, geometry, turned, role, body: BodyId| {
            SceneObject::new(name, geometry, standing([0.0; 2], turned), role).on_body(body)
        };
        let objects = vec![
            SceneObject::new("ground", paper, Pose::at([0.0, 0.5 * start_height, 0.0]), Role::Ground).with_color(PAPER),
            thing("agent", round(body), 0.0, Role::Robot, AGENT),
            thing("circle", round(diameter), 0.0, Role::Object, OBJECTS[0]).with_color(OKABE_ITO[2]),
            thing("diamond", square, FRAC_PI_4, Role::Object, OBJECTS[1]).with_color(OKABE_ITO[5]),
        ];
        let mut schema =
            Schema { bodies: ["agent", "circle", "diamond"].map(Into::into).into(), objects, ..Schema::default() }
                .with_sensors(numbered("ray", RAYS))
                .with_outputs(["right", "left"]);
        schema.sensors.iter_mut().for_each(|ray| ray.range = Some([0.0, input_gain]));
        schema.outputs.iter_mut().for_each(|motor| motor.range = Some([0.0, 1.0]));
        let names = numbered("sensory", RAYS).into_iter().chain(numbered("inner", INNER));
        // Nodes are the rays, then the neurons.
        let node = |neuron: usize| RAYS + neuron;
        let mut first = 0;
        let mut links = Vec::new();
        for (sources, targets) in LINKED {
            let nodes = |span: Span| [node(span.first), node(span.end())];
            links.push(Links { from: nodes(sources), to: nodes(targets), first });
            first += sources.count * targets.count;
        }
        let of_neurons = ["bias", "gain", "time constant"].into_iter().enumerate().map(|(i, name)| NodeParameters {
            name: name.into(),
            nodes: [node(0), node(NEURONS)],
            first: first + i * NEURONS,
        });
        let half = 0.5 * width;
        let place = in_group("place");
        Schema {
            neurons: names.map(|name| in_group("neuron")(&name).range(0.0, 1.0)).collect(),
            scalars: vec![
                place("agent").range(-half, half),
                place("object"),
                place("height").range(0.0, start_height),
                place("object from agent").range(-clip, clip),
                in_group("fitness")("score so far").range(0.0, 1.0),
            ],
            links,
            direct_links: (0..RAYS).map(|input| [input, node(input)]).collect(),
            node_parameters: of_neurons.collect(),
            view: View::Top,
            ..schema
        }
    }

    fn description(&self) -> Description {
        let config = self.episode.config();
        let Config { input_gain, velocity_gain, time_step, .. } = *config;
        Description {
            sensors: vec![ChannelGroup::new(
                "rays",
                RAYS,
                &format!("left to right, 0 nothing .. {input_gain} at the agent's outline"),
            )],
            motors: vec![ChannelGroup::new(
                "right, left",
                MOTORS,
                &format!("0 .. 1; {velocity_gain} times the difference is the velocity"),
            )],
            network: format!(
                "continuous-time recurrent, {RAYS} sensory, {INNER} inner, {MOTORS} motor neurons, the same on both sides"
            ),
            parameters: LAYOUT.range(CtrnnParameter::Weight).len() + 3 * NEURONS,
            steps: config.steps() as usize,
            step_seconds: time_step,
        }
    }

    fn anatomy(&self) -> Anatomy {
        let anatomy = Anatomy::new(&self.schema(), &self.description());
        anatomy.with_parameter_order(LAYOUT.parameter_count(), in_schema_order)
    }
}

impl Task for Agent {
    fn info(&self) -> TaskInfo {
        TaskInfo {
            combination: Some(Combination::Mean),
            description: self.description(),
            trials: self.episode.config().trials as usize,
            terms: vec!["score".into()],
            observations: RAYS,
            protocols: self.interventions.protocols(),
            anatomy: Some(self.anatomy()),
            ..TaskInfo::new(self.wiring.parameters().to_vec(), self.schema())
        }
    }

    /// The mean over the trials.
    fn fitness(&self, trials: &[Outcome]) -> f64 {
        mean_of_trials(trials)
    }

    fn exports(&self) -> Option<&dyn Exports> {
        Some(self)
    }
}

impl Exports for Agent {
    fn controller(&self, parameters: &[f32]) -> Option<ControllerExport> {
        let (config, network) = (self.episode.config(), self.episode.network());
        let (length, gain, speed) = (config.ray_length, config.input_gain, config.velocity_gain);
        let one = if gain > 0.0 { length - length / gain } else { length };
        let ray = |channel: Channel| SensorExport::quantity(channel.name, "free length of the ray", "1", [length, one]);
        let motor = |channel: Channel| {
            let to_the_right = if channel.name == "right" { speed } else { -speed };
            let quantity = "part of the velocity to the right, of which both are added, per s";
            MotorExport::quantity(channel.name, quantity, "1", [0.0, to_the_right])
        };
        let (layout, time_step) = (network.layout(), network.time_step());
        let network = NetworkExport::Ctrnn { layout, time_step, parameters: self.wiring.expand(parameters)? };
        let schema = self.schema();
        let sensors = schema.sensors.into_iter().map(ray).collect();
        let motors = schema.outputs.into_iter().map(motor).collect();
        Some(ControllerExport::new(network, sensors, motors, config.time_step, config.steps()))
    }
}

impl Rollout for Agent {
    fn load(&mut self, evaluation: &Evaluation<'_>) -> bool {
        let Some(parameters) = self.wiring.expand(evaluation.parameters) else { return false };
        let Config { diameter, side, .. } = *self.episode.config();
        self.falling =
            self.interventions.named(evaluation.case).filter(|(name, _)| *name == "psychophysics").map(|(_, case)| {
                let object = if case < PARTS { Object::circle(diameter) } else { Object::diamond(side) };
                (object, part_of_line(self.episode.config(), case % PARTS))
            });
        let change = self.interventions.applied(evaluation);
        let loaded = self.episode.normalise(evaluation.normalisation)
            && self.episode.set_parameters(&change.edited(&parameters)).is_ok();
        self.episode.intervene(&change, evaluation.id);
        loaded
    }

    fn record_parameters(&self, recorder: &mut dyn Recorder) {
        recorder.parameters(&in_schema_order(self.episode.parameters()));
    }

    /// Success is a circle nearer, or a diamond farther, than half of `fitness.clip`.
    fn outcome(&self) -> Outcome {
        let (score, steps) = (self.episode.score(), self.episode.steps());
        let notes = vec![
            ("object", Note::from(self.episode.object().name())),
            ("distance at the end", Note::from(self.episode.distance())),
        ];
        let observed = self.episode.observed().cloned();
        Outcome { terms: vec![score], steps, success: score > 0.5, notes, observed, ..Outcome::default() }
    }
}
