//! The experiment `discrimination`, and what it shares with `discrimination-cylinders`.

use std::path::PathBuf;

use farsa_body::Recorder;
use farsa_body::ports::{Arrange, BodyId, Handles, JointId, Kinematics, Planar};
use farsa_body::robot::Robot;
use farsa_nn::Perceptron;
use farsa_physics::arena::World;

use crate::discrimination::config::{Config, EYES, ROBOTS};
use crate::discrimination::episode::CylinderEpisode;
use crate::infrared::settings::InfraredModel;
use crate::wheeled::{applied, infrared_exports, layer_protocols, wheel_exports};
use crate::worlds::PlanarEngine;
use farsa_lab::{
    Anatomy, Behaviour, ChannelGroup, ControllerExport, Description, EpisodeId, Error, Evaluation, Evaluator,
    Experiment, Exports, InWorld, NetworkExport, NormalisedController, Note, NotedBehaviour, OnePlusOne, Outcome,
    Parameter, Rollout, SensorExport, Setting, Settings, StrategyDefinition, Task, TaskInfo, mean_of_trials,
};
use farsa_view::{Channel, Links, NodeParameters, Schema};

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

    fn strategy(&self, _: &str) -> &'static dyn StrategyDefinition {
        &OnePlusOne
    }

    fn settings(&self, condition: &str) -> Vec<Setting> {
        Config::for_condition(condition).table()
    }

    fn files(&self, _: &str, settings: &Settings) -> Result<Vec<PathBuf>, Error> {
        InfraredModel::files(settings)
    }

    fn gene_bits(&self) -> u32 {
        GENE_BITS
    }

    fn prepare(&self, condition: &str, settings: &Settings) -> Result<Box<dyn Evaluator>, Error> {
        in_its_world(Config::for_condition(condition).read(settings)?)
    }
}

/// Evaluates in the world that a configuration names.
pub(crate) fn in_its_world(config: Config) -> Result<Box<dyn Evaluator>, Error> {
    match config.engine {
        PlanarEngine::Arena => Ok(Box::new(evaluator(config)?)),
        #[cfg(feature = "rapier")]
        PlanarEngine::Rapier => Ok(Box::new(evaluator_in_rapier(config)?)),
        #[cfg(not(feature = "rapier"))]
        PlanarEngine::Rapier => Err(crate::worlds::missing(config.engine.name())),
    }
}

/// Bits of a gene.
pub(crate) const GENE_BITS: u32 = 8;

/// The layer of two logistic units that parameters are for.
pub type Layer = NormalisedController<Perceptron<Vec<f32>>>;

/// Evaluates under a configuration, in the kinematic arena.
///
/// # Errors
/// [`Error::Other`] for values that make no world, and [`Error::Setting`] for an arena without room for all.
pub fn evaluator(config: Config) -> Result<InWorld<World, CylinderEpisode<Layer>>, Error> {
    let (mut world, parked) = (config.world()?, config.parked());
    let episode = episode(config, &mut world)?;
    InWorld::in_arena(&parked, episode)
}

/// Evaluates under a configuration, in rapier.
///
/// # Errors
/// As [`evaluator`].
#[cfg(feature = "rapier")]
pub fn evaluator_in_rapier(
    config: Config,
) -> Result<InWorld<farsa_physics::rapier::ArenaWorld, CylinderEpisode<Layer>>, Error> {
    let mut world = config.rapier_world()?;
    let episode = episode(config, &mut world)?;
    Ok(InWorld::new(world, episode))
}

/// The episode of a configuration, for whose objects the world has room.
fn episode<W>(config: Config, world: &mut W) -> Result<CylinderEpisode<Layer>, Error>
where
    W: Planar + Kinematics + Arrange + Handles<Body = BodyId, Joint = JointId>,
{
    let inputs = config.inputs();
    let layer = layer(inputs, vec![0.0; Perceptron::parameter_count(inputs, 2)])?;
    let mut episode = CylinderEpisode::new(config, NormalisedController::new(layer))?;
    // Seeds of this kind are neither a run's nor a test's.
    for trial in 0..8 {
        let id = EpisodeId { seed: u64::MAX, trial, ..EpisodeId::default() };
        episode.arrange(world, id).map_err(|error| Error::setting("world.size", error))?;
    }
    Ok(episode)
}

/// Two logistic units over these parameters.
fn layer(inputs: usize, parameters: Vec<f32>) -> Result<Perceptron<Vec<f32>>, Error> {
    Perceptron::new(inputs, 2, 1.0, parameters).map_err(|error| Error::Other(format!("discrimination: {error}")))
}

/// The layer's parameters in its own order, from the order in which the original has them: the two biases come first, then
/// the weights target by target, where a layer has the weights source by source and then the biases.
fn in_order_of_layer(parameters: &[f32], inputs: usize) -> Vec<f32> {
    let weights = (0..inputs).flat_map(|input| [0, 1].map(|output| parameters[2 + output * inputs + input]));
    weights.chain([parameters[0], parameters[1]]).collect()
}

/// What an individual did, for strategies that want more than its fitness: with one cylinder in a trial, and with two.
static NEAR_ONE: NotedBehaviour = NotedBehaviour {
    objectives: &[("collisions", -1.0)],
    descriptors: &[("steps near", [0.0, 600.0]), ("collisions", [0.0, 1.0])],
};
static NEAR_TWO: NotedBehaviour = NotedBehaviour {
    objectives: &[("share of time near the other", -1.0)],
    descriptors: &[("share of time near the first", [0.0, 1.0]), ("share of time near the other", [0.0, 1.0])],
};

impl CylinderEpisode<Layer> {
    /// As the original wrote them, w = range - gene/255 * 2 range.
    fn parameters(&self) -> Vec<Parameter> {
        let (inputs, range) = (self.config().inputs(), self.config().weight_range);
        let wheels = ["left", "right"];
        let biases = wheels.map(|wheel| format!("bias of the {wheel} wheel"));
        let weights = wheels
            .into_iter()
            .flat_map(|wheel| (1..=inputs).map(move |input| format!("weight of sensor {input} on the {wheel} wheel")));
        biases.into_iter().chain(weights).map(|name| Parameter::new(name, [range, -range])).collect()
    }

    fn schema(&self) -> Schema {
        let config = self.config();
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
        let mut schema = Schema::from_arena(&config.arena()).with_sensors(eyes.chain(speeds));
        schema = schema.with_outputs(["left wheel", "right wheel"]);
        schema.outputs.iter_mut().chain(&mut schema.sensors).for_each(|channel| channel.range = Some([0.0, 1.0]));
        Schema {
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
            ..schema
        }
    }

    fn description(&self) -> Description {
        let config = self.config();
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
            parameters: Perceptron::parameter_count(config.inputs(), 2),
            steps: config.steps as usize,
            step_seconds: config.time_step,
        }
    }

    fn terms(&self) -> Vec<String> {
        let several = self.cylinders().len() > 1;
        let terms = if several { &["near the first", "near the other"][..] } else { &["near"] };
        terms.iter().map(|&term| term.into()).collect()
    }
}

impl Task for CylinderEpisode<Layer> {
    fn info(&self) -> TaskInfo {
        TaskInfo {
            description: self.description(),
            trials: self.config().trials as usize,
            terms: self.terms(),
            observations: self.config().inputs(),
            protocols: layer_protocols(&self.schema()).protocols(),
            anatomy: Some(Anatomy::new(&self.schema(), &self.description())),
            ..TaskInfo::new(self.parameters(), self.schema())
        }
    }

    fn behaviour(&self) -> Option<&dyn Behaviour> {
        Some(if self.config().radii.len() == 1 { &NEAR_ONE } else { &NEAR_TWO })
    }

    /// The mean over the trials.
    fn fitness(&self, trials: &[Outcome]) -> f64 {
        mean_of_trials(trials)
    }

    fn exports(&self) -> Option<&dyn Exports> {
        Some(self)
    }
}

impl Exports for CylinderEpisode<Layer> {
    fn robot(&self, _: Option<&[f32]>) -> Option<Robot> {
        Some(self.config().robot.description())
    }

    fn controller(&self, parameters: &[f32]) -> Option<ControllerExport> {
        let (config, inputs) = (self.config(), self.config().inputs());
        if parameters.len() != Perceptron::parameter_count(inputs, 2) {
            return None;
        }
        let robot = &config.robot;
        let largest = robot.max_wheel_speed;
        let parameters = in_order_of_layer(parameters, inputs);
        let network = NetworkExport::Perceptron { inputs, outputs: 2, slope: 1.0, parameters };
        let eyes = (1..=EYES).map(|number| format!("infrared {number}"));
        let eyes = infrared_exports(eyes, &robot.infrared.angles, robot, &config.infrared);
        let speeds = ["left", "right"].into_iter().filter(|_| config.wheel_speeds).map(|side| {
            let quantity = format!("speed of the {side} wheel");
            SensorExport::quantity(format!("{side} wheel"), quantity, "rad/s", [-largest, largest])
        });
        let sensors = eyes.chain(speeds).collect();
        Some(ControllerExport::new(network, sensors, wheel_exports(largest), config.time_step, config.steps))
    }
}

impl Rollout for CylinderEpisode<Layer> {
    fn load(&mut self, evaluation: &Evaluation<'_>) -> bool {
        let inputs = self.config().inputs();
        if evaluation.parameters.len() != Perceptron::parameter_count(inputs, 2) {
            return false;
        }
        let (change, own) = (applied(self, evaluation), in_order_of_layer(evaluation.parameters, inputs));
        let Ok(layer) = layer(inputs, change.edited(&own).into_owned()) else { return false };
        let mut layer = NormalisedController::new(layer);
        let loaded = layer.load(evaluation.normalisation);
        layer.intervene(&change, evaluation.id, 0);
        self.set_controller(layer);
        loaded
    }

    fn record_parameters(&self, recorder: &mut dyn Recorder) {
        recorder.parameters(self.controller().controller().parameters());
    }

    fn outcome(&self) -> Outcome {
        let (trial, config) = (self.trial(), self.config());
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
        Outcome {
            terms,
            steps: trial.steps,
            success: !trial.collided && trial.distance[0] < config.near,
            notes,
            observed: self.controller().observed().cloned(),
            ..Outcome::default()
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use farsa_lab::Genotype;
    use farsa_nn::Controller as _;

    #[test]
    fn genes_are_read_as_the_original_wrote_them() {
        // Biases +5 and -5; of each wheel the weights of sensors 0 to 5.
        let genes = [0, 255, 10, 20, 30, 40, 50, 60, 110, 120, 130, 140, 150, 160];
        let task = evaluator(Config::default()).unwrap();
        let parameters = Genotype::new(&task.info().parameters, GENE_BITS).decode(&genes).unwrap();
        let mut layer = layer(6, in_order_of_layer(&parameters, 6)).unwrap();
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
        // To the last bit: the same products in another order.
        for gene in 0..=255 {
            let found = Genotype::new(&task.info().parameters[..1], GENE_BITS).decode(&[gene]).unwrap();
            assert_eq!(found[0], (5.0 - f64::from(gene) / 255.0 * 2.0 * 5.0) as f32);
        }
    }

    #[test]
    fn fitness_is_the_mean_of_the_trials() {
        let task = evaluator(Config::default()).unwrap();
        let trial = |near| Outcome { terms: vec![near], ..Outcome::default() };
        assert_eq!(task.fitness(&[trial(0.25), trial(0.75), trial(0.5)]), 0.5);
        assert!(task.fitness(&[trial(0.25), Outcome::failed()]).is_nan());
    }
}
