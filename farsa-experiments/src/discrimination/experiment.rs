//! The experiment `discrimination`, and what it shares with `discrimination-cylinders`.

use std::path::PathBuf;

use farsa_body::{
    Actuated, ActuatorId, Arrange, BodyId, Contacts, Handles, JointId, Joints, Kinematics, Planar, Pose, Rays, Recorder,
};
use farsa_nn::Perceptron;
use farsa_physics::arena::World;

use crate::discrimination::life::CylinderLife;
use crate::discrimination::{config::Config, config::EYES, config::ROBOTS};
use crate::infrared::settings::InfraredModel;
use crate::worlds::PlanarEngine;
use farsa_lab::{
    ChannelGroup, Description, Error, Experiment, Job, Life as _, Note, Outcome, Search, Setting, Settings, Setup, Tape,
};
use farsa_view::{Channel, Links, NodeParameters, Stage};

/// Does a robot that sees walls and a cylinder alike stay near the cylinder? \[FARSA2\]
///
/// A robot with six infrared sensors and a layer of two logistic units, which drive its wheels, evolves to find a small
/// cylinder in a walled arena and to stay near it. One parent makes one mutant a generation. The condition is the robot, a
/// Khepera or an e-puck, with the source's numbers for each ([`Config::e_puck`]). Sources and choices are in the settings; deviations: random numbers are our own, and so is the analytic model of the sensors, which is the default
/// because it needs no measured tables.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Default)]
pub struct Discrimination;

impl Experiment for Discrimination {
    fn name(&self) -> &'static str {
        "discrimination"
    }

    fn summary(&self) -> &'static str {
        "a robot finds a small cylinder among walls and stays near it, by its infrared sensors alone"
    }

    fn conditions(&self) -> &'static [&'static str] {
        &ROBOTS
    }

    fn search(&self, _: &str) -> Search {
        Search::SteadyState
    }

    fn settings(&self, condition: &str) -> Vec<Setting> {
        Config::of_condition(condition).table()
    }

    fn files(&self, _: &str, settings: &Settings) -> Result<Vec<PathBuf>, Error> {
        InfraredModel::files(settings)
    }

    fn prepare(&self, condition: &str, settings: &Settings) -> Result<Box<dyn Setup>, Error> {
        in_its_world(Config::of_condition(condition).read(settings)?)
    }
}

/// Lives in the world that a configuration names.
pub(crate) fn in_its_world(config: Config) -> Result<Box<dyn Setup>, Error> {
    match config.engine {
        PlanarEngine::Arena => Ok(Box::new(Lives::new(config)?)),
        #[cfg(feature = "rapier")]
        PlanarEngine::Rapier => Ok(Box::new(Lives::in_rapier(config)?)),
        #[cfg(not(feature = "rapier"))]
        PlanarEngine::Rapier => Err(crate::worlds::missing(config.engine.name())),
    }
}

/// Bits of a gene.
const GENE_BITS: u32 = 8;

/// The layer of two logistic units that genes are decoded into.
type Layer = Perceptron<Vec<f32>>;

/// The arena with the robot's life in it: everything that a thread needs to live lives.
pub struct Lives<W = World> {
    world: W,
    life: CylinderLife<Layer>,
}

impl Lives {
    /// Lives under a configuration, in the kinematic arena.
    ///
    /// # Errors
    /// [`Error::Other`] for values that make no world, and [`Error::Setting`] for an arena without room for all.
    pub fn new(config: Config) -> Result<Self, Error> {
        let world = config.world()?;
        Self::assemble(config, world)
    }
}

#[cfg(feature = "rapier")]
impl Lives<farsa_physics::rapier::ArenaWorld> {
    /// Lives under a configuration, in rapier.
    ///
    /// # Errors
    /// [`Error::Other`] for values that make no world, and [`Error::Setting`] for an arena without room for all.
    pub fn in_rapier(config: Config) -> Result<Self, Error> {
        let world = config.rapier_world()?;
        Self::assemble(config, world)
    }
}

impl<W> Lives<W>
where
    W: Planar + Kinematics + Arrange + Handles<Body = BodyId, Joint = JointId>,
{
    fn assemble(config: Config, mut world: W) -> Result<Self, Error> {
        let inputs = config.inputs();
        let layer = layer(inputs, vec![0.0; Perceptron::parameter_count(inputs, 2)])?;
        let mut life = CylinderLife::new(config, layer)?;
        // Seeds of this kind are neither a run's nor a test's.
        for trial in 0..8 {
            let job = Job { seed: u64::MAX, trial, ..Job::default() };
            life.arrange(&mut world, job).map_err(|error| Error::setting("world.size", error))?;
        }
        Ok(Self { world, life })
    }

    /// Tells what was sensed, computed and done before the step that has just been judged, and what it led to.
    fn tell(&self, was: Pose, recorder: &mut dyn Recorder) {
        let Self { world, life } = self;
        let (trial, parts) = (life.trial(), life.parts());
        recorder.sensors(life.sensed());
        recorder.outputs(life.done());
        life.infrared().tell(was, life.sensed(), recorder);
        // No contacts: their forces are nominal.
        let bodies = core::iter::once(parts.body).chain(life.cylinders().iter().copied());
        bodies.for_each(|body| recorder.pose(body, world.pose(body)));
        let pose = world.pose(parts.body);
        let [x, y, _] = pose.position.map(f64::from);
        let mut scalars = vec![x, y, f64::from(pose.heading())];
        let count = life.cylinders().len();
        scalars.extend(&trial.distance[..count]);
        let largest = life.config().robot.max_wheel_speed;
        scalars.extend(life.done().iter().map(|y| (2.0 * f64::from(*y) - 1.0) * largest));
        scalars.push(life.fitness());
        recorder.scalars(&scalars);
        // Rounded to the nanosecond: 201 steps of 0.05 s print as 10.05.
        recorder.tick((f64::from(trial.steps) * life.config().time_step * 1e9).round() / 1e9);
    }

    fn outcome(&self) -> Outcome {
        let (trial, config) = (self.life.trial(), self.life.config());
        if trial.failed {
            return Outcome::failed();
        }
        let share = |i: usize| f64::from(trial.near[i]) / f64::from(config.steps);
        let mean = |i: usize| if trial.near[i] > 0 { trial.spun[i] / f64::from(trial.near[i]) } else { 0.0 };
        let mut notes = vec![
            ("collisions", Note::from(if trial.collided { 1.0 } else { 0.0 })),
            ("end", Note::from(if trial.collided { "collision" } else { "time" })),
        ];
        let mut terms = vec![share(0)];
        if config.radii.len() == 1 {
            notes.push(("steps near", Note::from(f64::from(trial.near[0]))));
        } else {
            terms.push(-config.cost * share(1));
            notes.push(("share of time near the first", Note::from(share(0))));
            notes.push(("share of time near the other", Note::from(share(1))));
            notes.push(("wheels' difference near the first [rad/s]", Note::from(mean(0))));
            notes.push(("wheels' difference near the other [rad/s]", Note::from(mean(1))));
        }
        Outcome { terms, steps: trial.steps, success: !trial.collided && trial.distance[0] < config.near, notes }
    }
}

/// Two logistic units over these parameters.
fn layer(inputs: usize, parameters: Vec<f32>) -> Result<Layer, Error> {
    Perceptron::new(inputs, 2, 1.0, parameters).map_err(|error| Error::Other(format!("discrimination: {error}")))
}

/// The parameters that genes stand for: w = range - gene/255 * 2 range; the two biases come first, then the weights target
/// by target, where a layer has the weights source by source and then the biases.
fn decode(genes: &[u16], inputs: usize, range: f64) -> Vec<f32> {
    let value = |gene: u16| (range - f64::from(gene) / 255.0 * 2.0 * range) as f32;
    let weights = (0..inputs).flat_map(|input| [0, 1].map(|output| genes[2 + output * inputs + input]));
    weights.chain([genes[0], genes[1]]).map(value).collect()
}

impl<W> Setup for Lives<W>
where
    W: farsa_body::World
        + Planar
        + Rays
        + Kinematics
        + Joints
        + Actuated
        + Contacts
        + Arrange
        + Handles<Body = BodyId, Joint = JointId, Actuator = ActuatorId>
        + Send,
{
    fn genes(&self) -> usize {
        Perceptron::parameter_count(self.life.config().inputs(), 2)
    }

    fn gene_bits(&self) -> u32 {
        GENE_BITS
    }

    fn trials(&self) -> usize {
        self.life.config().trials as usize
    }

    fn terms(&self) -> Vec<String> {
        let several = self.life.cylinders().len() > 1;
        let terms = if several { &["near the first", "near the other"][..] } else { &["near"] };
        terms.iter().map(|&term| term.into()).collect()
    }

    fn stage(&self) -> Stage {
        let config = self.life.config();
        let inputs = config.inputs();
        let in_group = |group: &'static str| move |name: &str| Channel::new(name).group(group);
        let distances: &[&str] = match config.radii.len() {
            1 => &["distance [m]"],
            _ => &["distance of the first [m]", "distance of the other [m]"],
        };
        let largest = config.robot.max_wheel_speed;
        let wheels = ["left wheel [rad/s]", "right wheel [rad/s]"].map(in_group("actuator"));
        let scalars = ["x [m]", "y [m]", "heading [rad]"].map(in_group("place")).into_iter();
        let eyes = (1..=EYES).map(|number| format!("infrared {number}"));
        let speeds = ["left wheel", "right wheel"].map(String::from).into_iter().filter(|_| config.wheel_speeds);
        let mut stage = Stage::of_arena(&config.arena()).with_sensors(eyes.chain(speeds));
        stage = stage.with_outputs(["left wheel", "right wheel"]);
        stage.outputs.iter_mut().chain(&mut stage.sensors).for_each(|channel| channel.range = Some([0.0, 1.0]));
        Stage {
            scalars: scalars
                .chain(distances.iter().map(|name| in_group("fitness")(name)))
                .chain(wheels.map(|wheel| wheel.range(-largest, largest)))
                .chain([Channel::new("fitness so far").group("fitness")])
                .collect(),
            links: vec![Links { from: [0, inputs], to: [inputs, inputs + 2], first: 0 }],
            node_parameters: vec![NodeParameters {
                name: "bias".into(),
                nodes: [inputs, inputs + 2],
                first: 2 * inputs,
            }],
            ..stage
        }
    }

    fn description(&self) -> Description {
        let config = self.life.config();
        let model = config.infrared.name();
        let speed = config.robot.max_wheel_speed * config.robot.wheel_radius;
        let mut sensors = vec![ChannelGroup::new(
            "infrared",
            EYES,
            &format!("the six in front, left to right, 0 nothing .. 1 at the hull; model: {model}"),
        )];
        if config.wheel_speeds {
            sensors.push(ChannelGroup::new("wheel speeds", 2, "left and right, 0 backwards .. 1/2 at rest .. 1 ahead"));
        }
        Description {
            sensors,
            motors: vec![ChannelGroup::new(
                "wheels",
                2,
                &format!("left and right, 0 backwards .. 1/2 at rest .. 1 ahead, {:.0} mm/s", 1e3 * speed),
            )],
            network: format!("{}-2, one layer of logistic units without memory", config.inputs()),
            parameters: self.genes(),
            steps: config.steps as usize,
            step_seconds: config.time_step,
        }
    }

    fn live(&mut self, genes: &[u16], job: Job, tape: &mut Tape<'_>) -> Outcome {
        let config = self.life.config();
        let (inputs, range) = (config.inputs(), config.weight_range);
        if genes.len() != self.genes() {
            return Outcome::failed();
        }
        let parameters = decode(genes, inputs, range);
        if let Some(recorder) = tape.recorder() {
            recorder.parameters(&parameters);
        }
        let Ok(layer) = layer(inputs, parameters) else { return Outcome::failed() };
        self.life.set_controller(layer);
        self.life.start(&mut self.world, job);
        if self.life.trial().failed {
            return Outcome::failed();
        }
        loop {
            self.life.act(&mut self.world);
            let was = tape.recorder().map(|_| self.world.pose(self.life.parts().body));
            self.world.step();
            let end = self.life.judge(&self.world);
            if let (Some(recorder), Some(was)) = (tape.recorder(), was) {
                self.tell(was, recorder);
            }
            if end.is_some() {
                return self.outcome();
            }
        }
    }

    /// The mean over the trials.
    fn fitness(&self, trials: &[Outcome]) -> f64 {
        let sum: f64 = trials.iter().flat_map(|outcome| &outcome.terms).sum();
        sum / trials.len().max(1) as f64
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use farsa_nn::Controller as _;

    #[test]
    fn genes_are_read_as_the_original_wrote_them() {
        // Biases +5 and -5; of each wheel the weights of sensors 0 to 5.
        let genes = [0, 255, 10, 20, 30, 40, 50, 60, 110, 120, 130, 140, 150, 160];
        let mut layer = layer(6, decode(&genes, 6, 5.0)).unwrap();
        let weight = |gene: u16| 5.0 - f64::from(gene) / 255.0 * 10.0;
        for (wheel, bias) in [(0, 5.0), (1, -5.0)] {
            for sensor in 0..6 {
                let (mut x, mut y) = ([0.0; 6], [0.0; 2]);
                x[sensor] = 0.7;
                layer.step(&x, &mut y);
                let net = bias + 0.7 * weight(genes[2 + 6 * wheel + sensor]);
                let expected: f64 = farsa_num::logistic(net);
                assert!((f64::from(y[wheel]) - expected).abs() < 1e-6, "{wheel} {sensor}");
            }
        }
    }

    #[test]
    fn fitness_is_the_mean_of_the_trials() {
        let lives = Lives::new(Config::default()).unwrap();
        let trial = |near| Outcome { terms: vec![near], ..Outcome::default() };
        assert_eq!(lives.fitness(&[trial(0.25), trial(0.75), trial(0.5)]), 0.5);
        assert!(lives.fitness(&[trial(0.25), Outcome::failed()]).is_nan());
    }
}
