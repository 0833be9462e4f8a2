//! Registration of `double-pole` as an experiment of the `farsa` command.

use farsa_body::ports::BodyId;
use farsa_body::{Pose, Recorder};
use farsa_lab::advanced::{
    Anatomy, ChannelGroup, Description, Interventions, NoWorld, Rollout, mean_of_trials, seconds,
};
use farsa_lab::exports::{ControllerExport, Exports, MotorExport, NetworkExport, SensorExport};
use farsa_lab::{
    Combination, Episode, EpisodeId, Error, Evaluation, Evaluator, Experiment, InWorld, Note, Outcome, Parameter,
    Setting, Settings, Task, TaskInfo,
};
use farsa_num::sin_cos;
use farsa_view::shape::{Color, Geometry, OKABE_ITO, Role, SceneObject};
use farsa_view::{Channel, Links, Schema, View};

use crate::double_pole::cart::CartState;
use crate::double_pole::config::Config;
use crate::double_pole::episode::CartEpisode;

/// Balances two poles of different lengths on a cart, with or without access to the velocities.
///
/// This is the common benchmark of neuroevolution \[Wieland1991\] with the constants, steps and networks of
/// \[Gomez2008\]. An evaluation consists of a single trial. The fitness is the number of steps in balance. Without
/// velocities it is the function of \[Gruau1996\], which also rewards rest (see `fitness.damping`). A trial is
/// successful after 100 000 steps in balance. With the second function, an evaluation continues until then.
///
/// The source does not specify the biases, the activation function and the scales of the inputs. This implementation
/// uses no biases and the hyperbolic tangent. Positions, angles and velocities are divided by 4.8 m, 0.52 rad and 2 m/s
/// or rad/s. Note that all trials of `farsa test` are identical, because they have the same initial state.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Default)]
pub struct DoublePole;

/// The defaults of a condition: sensed velocities, or a fitness that rewards rest.
fn defaults(condition: &str) -> Config {
    let velocities = condition != "no-velocities";
    Config { damping: !velocities, ..Config::new(velocities) }
}

impl Experiment for DoublePole {
    fn name(&self) -> &'static str {
        "double-pole"
    }

    fn summary(&self) -> &'static str {
        "a network pushes a cart so that two poles stay upright"
    }

    fn conditions(&self) -> &'static [&'static str] {
        &["velocities", "no-velocities"]
    }

    fn settings(&self, condition: &str) -> Vec<Setting> {
        defaults(condition).table()
    }

    fn prepare(&self, condition: &str, settings: &Settings) -> Result<Box<dyn Evaluator>, Error> {
        Ok(Box::new(evaluator(Config::read(defaults(condition).velocities, settings)?)?))
    }
}

const CART: BodyId = BodyId(0);
const POLES: [BodyId; 2] = [BodyId(1), BodyId(2)];
/// Half the width of the cart, half its height, and half the thickness of the poles as they are drawn \[m\].
const DRAWN: [f64; 3] = [0.2, 0.06, 0.015];
const PAPER: Color = [244, 243, 238];

/// Creates an evaluator for the given configuration.
///
/// # Errors
/// Returns [`Error::Other`] if no network can be built from these values.
pub fn evaluator(config: Config) -> Result<InWorld<NoWorld, Balancing>, Error> {
    Ok(InWorld::new(NoWorld, Balancing::new(config)?))
}

/// The task of keeping the poles in balance.
#[derive(Clone, Debug)]
pub struct Balancing {
    episode: CartEpisode,
    interventions: Interventions,
}

impl Balancing {
    /// Creates the task for a configuration. All weights are initially zero.
    ///
    /// # Errors
    /// Returns [`Error::Other`] if no network can be built from these values.
    pub fn new(config: Config) -> Result<Self, Error> {
        let neurons = config.neurons();
        let parameters = vec![0.0; neurons * (config.inputs() + neurons)];
        let episode = CartEpisode::new(config, parameters)?;
        let mut task = Self { episode, interventions: Interventions::default() };
        task.interventions = task.interventions();
        Ok(task)
    }

    /// `lesions`, of each sensor and each hidden neuron, and `noise`.
    fn interventions(&self) -> Interventions {
        let Schema { sensors, neurons, .. } = self.schema();
        let inputs = sensors.len();
        let sensors = sensors.iter().enumerate().map(|(number, sensor)| (&sensor.name, number..number + 1));
        let neurons = neurons.iter().enumerate().map(|(number, neuron)| (neuron.name.clone(), inputs + number));
        Interventions::default().with_lesions(sensors, neurons).with_noise(&Interventions::NOISE)
    }

    /// Where the middle of a pole is, and how it is turned, seen from the side.
    fn pose(&self, pole: usize) -> Pose<f32> {
        let CartState { position, angles, .. } = *self.episode.state();
        let half_length = self.episode.config().cart.poles[pole].half_length;
        let (sine, cosine) = sin_cos(angles[pole]);
        let middle = [position + half_length * sine, DRAWN[1] + half_length * cosine];
        Pose::planar(middle.map(|x| x as f32), -angles[pole] as f32)
    }
}

impl Balancing {
    fn parameters(&self) -> Vec<Parameter> {
        let config = self.episode.config();
        let (inputs, neurons) = (config.inputs(), config.neurons());
        let named = |node: usize| {
            if node < inputs { format!("input {}", node + 1) } else { format!("neuron {}", node - inputs + 1) }
        };
        let ends = [-config.weight_range, config.weight_range];
        let weight = |index: usize| {
            let name = format!("weight of {} on neuron {}", named(index / neurons), index % neurons + 1);
            Parameter::new(name, ends)
        };
        (0..neurons * (inputs + neurons)).map(weight).collect()
    }

    fn schema(&self) -> Schema {
        let config = self.episode.config();
        let (inputs, neurons) = (config.inputs(), config.neurons());
        let [width, height, thick] = DRAWN;
        let track = Geometry::Rectangle { half: [config.most_position + width, 1.25] };
        let block = |half: [f64; 2]| Geometry::Box { half: [half[0], half[1], thick] };
        let thing = |name: &str, half, body: BodyId| {
            SceneObject::new(name, block(half), Pose::at([0.0; 3]), Role::Robot).on_body(body)
        };
        let pole = |number: usize| [thick, config.cart.poles[number].half_length];
        let wide = block([2.0 * thick, config.cart.poles[1].half_length]);
        let objects = vec![
            SceneObject::new("track", track, Pose::at([0.0, 0.5, 0.0]), Role::Ground).with_color(PAPER),
            thing("cart", [width, height], CART),
            thing("long pole", pole(0), POLES[0]).with_color(OKABE_ITO[2]),
            // Wider and in front of the long pole, so that both are visible where they cover each other.
            SceneObject::new("short pole", wide, Pose::at([0.0, 0.0, 2.0 * thick]), Role::Robot)
                .on_body(POLES[1])
                .with_color(OKABE_ITO[5]),
        ];
        let names = ["position", "angle 1", "angle 2", "velocity", "angular velocity 1", "angular velocity 2"];
        let mut schema =
            Schema { bodies: ["cart", "long pole", "short pole"].map(Into::into).into(), objects, ..Schema::default() }
                .with_sensors(names.into_iter().take(inputs))
                .with_outputs(["push"]);
        schema.sensors.iter_mut().for_each(|channel| channel.range = Some([-1.5, 1.5]));
        schema.outputs.iter_mut().for_each(|channel| channel.range = Some([-1.0, 1.0]));
        let in_group = |group: &'static str| move |name: &str| Channel::new(name).group(group);
        let state = in_group("state");
        let [most, angle] = [config.most_position, config.most_angle];
        let nodes = [inputs, inputs + neurons];
        Schema {
            neurons: (1..neurons).map(|i| in_group("neuron")(&format!("hidden {i}")).range(-1.0, 1.0)).collect(),
            scalars: vec![
                state("position [m]").range(-most, most),
                state("velocity [m/s]"),
                state("angle of the long pole [deg]").range(-angle, angle),
                state("angle of the short pole [deg]").range(-angle, angle),
                in_group("force")("force [N]").range(-config.force, config.force),
            ],
            links: vec![
                Links { from: [0, inputs], to: nodes, first: 0 },
                Links { from: nodes, to: nodes, first: inputs * neurons },
            ],
            view: View::Top,
            ..schema
        }
    }

    fn description(&self) -> Description {
        let config = self.episode.config();
        let [of_position, of_angle, of_velocity] = config.scales;
        let mut sensors = vec![
            ChannelGroup::new("position", 1, &format!("of the cart, 1 at {of_position} m")),
            ChannelGroup::new("angles", 2, &format!("of both poles, 1 at {of_angle} rad")),
        ];
        if config.velocities {
            sensors.push(ChannelGroup::new("velocities", 3, &format!("of all three, 1 at {of_velocity} m/s or rad/s")));
        }
        let push = format!("-1 is {} N to the left, 1 as much to the right", config.force);
        Description {
            sensors,
            motors: vec![ChannelGroup::new("push", 1, &push)],
            network: format!("fully recurrent, {} hidden neurons and an output, without biases", config.hidden),
            parameters: self.parameters().len(),
            steps: config.steps as usize,
            step_seconds: config.time_step * f64::from(config.substeps),
        }
    }

    /// Neurons of the network are counted from its inputs.
    fn anatomy(&self) -> Anatomy {
        let schema = self.schema();
        let (inputs, neurons) = (schema.sensors.len(), schema.neurons.len());
        Anatomy::new(&schema, &self.description()).with_first(inputs, inputs + neurons)
    }
}

impl Task for Balancing {
    fn info(&self) -> TaskInfo {
        TaskInfo {
            combination: Some(Combination::Mean),
            description: self.description(),
            terms: if self.episode.config().damping {
                vec!["balance".into(), "rest".into()]
            } else {
                vec!["steps".into()]
            },
            observations: self.episode.sensed().len(),
            protocols: self.interventions.protocols(),
            anatomy: Some(self.anatomy()),
            ..TaskInfo::new(self.parameters(), self.schema())
        }
    }

    /// The mean over the trials. All trials are the same.
    fn fitness(&self, trials: &[Outcome]) -> f64 {
        mean_of_trials(trials)
    }

    fn exports(&self) -> Option<&dyn Exports> {
        Some(self)
    }
}

impl Exports for Balancing {
    fn controller(&self, parameters: &[f32]) -> Option<ControllerExport> {
        let (config, network) = (self.episode.config(), self.episode.network());
        if parameters.len() != network.parameters().len() {
            return None;
        }
        let [of_position, of_angle, of_velocity] = config.scales;
        let units = ["m", "rad", "rad", "m/s", "rad/s", "rad/s"];
        let scales = [of_position, of_angle, of_angle, of_velocity, of_velocity, of_velocity];
        let quantities = [
            "position of the cart",
            "angle of the long pole",
            "angle of the short pole",
            "velocity of the cart",
            "angular velocity of the long pole",
            "angular velocity of the short pole",
        ];
        let sensor = |((channel, quantity), (unit, scale)): ((Channel, &str), (&'static str, f64))| {
            SensorExport::quantity(channel.name, quantity, unit, [0.0, scale])
        };
        let named = self.schema().sensors.into_iter().zip(quantities);
        let sensors = named.zip(units.into_iter().zip(scales)).map(sensor).collect();
        let quantity =
            format!("force on the cart to the right; one of less than {} N is made so large", config.least_force);
        let motors = vec![MotorExport::quantity("push", quantity, "N", [0.0, config.force])];
        let (layout, leak, parameters) = (network.layout().into(), network.leak(), parameters.into());
        let network = NetworkExport::Blocks { layout, leak, parameters };
        let time_step = config.time_step * f64::from(config.substeps);
        Some(ControllerExport::new(network, sensors, motors, time_step, config.steps))
    }
}

impl Episode<NoWorld> for Balancing {
    fn start(&mut self, _: &mut NoWorld, _: EpisodeId) {
        self.episode.place(self.episode.config().start());
    }

    fn act(&mut self, _: &mut NoWorld) {
        self.episode.step();
    }

    fn judge(&mut self, _: &mut NoWorld) -> Option<f64> {
        self.episode.ended().then(|| f64::from(self.episode.steps()))
    }

    fn record(&self, _: &NoWorld, recorder: &mut dyn Recorder) {
        let (config, state) = (self.episode.config(), self.episode.state());
        let (inputs, hidden) = (config.inputs(), config.hidden as usize);
        recorder.sensors(self.episode.sensed());
        recorder.neurons(&self.episode.network().activations()[inputs..inputs + hidden]);
        recorder.outputs(self.episode.output());
        recorder.pose(CART, Pose::planar([state.position as f32, 0.0], 0.0));
        for (number, body) in POLES.into_iter().enumerate() {
            recorder.pose(body, self.pose(number));
        }
        let degrees = state.angles.map(f64::to_degrees);
        recorder.scalars(&[state.position, state.velocity, degrees[0], degrees[1], self.episode.force()]);
        // The step in which a pole falls is not in balance, but it takes time.
        let steps = self.episode.steps() + u32::from(!self.episode.in_balance());
        recorder.tick(seconds(steps, config.time_step * f64::from(config.substeps)));
    }
}

impl Rollout for Balancing {
    fn load(&mut self, evaluation: &Evaluation<'_>) -> bool {
        let change = self.interventions.applied(evaluation);
        let loaded = self.episode.normalise(evaluation.normalisation)
            && self.episode.set_parameters(&change.edited(evaluation.parameters)).is_ok();
        self.episode.intervene(&change, evaluation.id);
        loaded
    }

    fn record_parameters(&self, recorder: &mut dyn Recorder) {
        recorder.parameters(self.episode.network().parameters());
    }

    /// Success is balance to the end.
    fn outcome(&self) -> Outcome {
        let steps = self.episode.steps();
        let terms = if self.episode.config().damping { self.episode.damping().into() } else { vec![f64::from(steps)] };
        let notes = vec![("steps in balance", Note::from(f64::from(steps)))];
        let observed = self.episode.observed().cloned();
        Outcome { terms, steps, success: self.episode.succeeded(), notes, observed, ..Outcome::default() }
    }
}
