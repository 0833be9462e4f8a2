//! The task of `push-box`. It runs and records episodes of evolved controllers.

use farsa_body::robot::Robot;
use farsa_body::{Pose, Recorder};
use farsa_nn::Perceptron;

use crate::push_box::episode::{OUTPUTS, PushEpisode};
use crate::push_box::layer::{applied, layer_protocols, wheel_exports};
use farsa_lab::advanced::{
    Anatomy, Behavior, ChannelGroup, Description, NormalizedController, NotedBehavior, Rollout, mean_of_trials,
};
use farsa_lab::exports::{ControllerExport, Exports, NetworkExport, SensorExport, SensorReading};
use farsa_lab::{Combination, Error, Evaluation, Note, Outcome, Parameter, Task, TaskInfo};
use farsa_view::shape::{Geometry, Role, SceneObject, screen_color};
use farsa_view::{Channel, Links, NodeParameters, Schema};

/// The layer of two logistic units that parameters are for.
pub(crate) type Layer = NormalizedController<Perceptron<Vec<f32>>>;

/// Two logistic units over these parameters.
pub(crate) fn layer(inputs: usize, parameters: Vec<f32>) -> Result<Layer, Error> {
    let layer = Perceptron::new(inputs, OUTPUTS, 1.0, parameters);
    layer.map(NormalizedController::new).map_err(|error| Error::Other(format!("push-box: {error}")))
}

/// Objectives and measures of an individual, for strategies that use more than its fitness.
static BEHAVIOUR: NotedBehavior = NotedBehavior {
    objectives: &[("way of the box [m]", -1.0)],
    measures: &[("way of the box [m]", [0.0, 2.0]), ("share of time touching", [0.0, 1.0])],
};

impl PushEpisode<Layer> {
    /// In the layer's order, from +range to -range.
    fn parameters(&self) -> Vec<Parameter> {
        let (inputs, range) = (self.config().inputs(), self.config().weight_range);
        let wheels = ["left", "right"];
        let weights =
            (1..=inputs).flat_map(|input| wheels.map(|wheel| format!("weight of sensor {input} on the {wheel} wheel")));
        let biases = wheels.map(|wheel| format!("bias of the {wheel} wheel"));
        weights.chain(biases).map(|name| Parameter::new(name, [range, -range])).collect()
    }

    fn schema(&self) -> Schema {
        let config = self.config();
        let (inputs, scene) = (config.inputs(), config.scene());
        let in_group = |group: &'static str| move |name: &str| Channel::new(name).group(group);
        let largest = config.robot.max_wheel_speed;
        let places = ["x [m]", "y [m]", "heading [rad]"];
        let of_box = places.map(|place| format!("box {place}"));
        let wheels = ["left wheel [rad/s]", "right wheel [rad/s]"].map(in_group("actuator"));
        let eyes = (1..=inputs).map(|number| format!("infrared {number}"));
        let mut schema =
            Schema::from_arena(&scene.arena).with_sensors(eyes).with_outputs(["left wheel", "right wheel"]);
        schema.outputs.iter_mut().chain(&mut schema.sensors).for_each(|channel| channel.range = Some([0.0, 1.0]));
        for block in &scene.blocks {
            let half = block.size.map(|x| 0.5 * x);
            let middle = Pose::at([0.0, 0.0, half[2]]);
            let object = SceneObject::new("box", Geometry::Box { half }, middle, Role::Object).on_body(self.cube());
            schema.objects.push(object.with_color(screen_color(block.color)));
            schema.bodies.push("box".into());
        }
        Schema {
            scalars: places
                .into_iter()
                .chain(of_box.iter().map(String::as_str))
                .map(in_group("place"))
                .chain(wheels.map(|wheel| wheel.range(-largest, largest)))
                .chain([Channel::new("box moved [m]").group("fitness")])
                .collect(),
            links: vec![Links { from: [0, inputs], to: [inputs, inputs + OUTPUTS], first: 0 }],
            node_parameters: vec![NodeParameters {
                name: "bias".into(),
                nodes: [inputs, inputs + OUTPUTS],
                first: OUTPUTS * inputs,
            }],
            ..schema
        }
    }

    fn description(&self) -> Description {
        let config = self.config();
        let (inputs, speed) = (config.inputs(), config.speed());
        let wheels = format!("left and right, 0 backwards .. 1/2 at rest .. 1 ahead, {:.0} mm/s", 1e3 * speed);
        Description {
            sensors: vec![ChannelGroup::new("infrared", inputs, "all around, by rays, 0 nothing .. 1 at the hull")],
            motors: vec![ChannelGroup::new("wheels", OUTPUTS, &wheels)],
            network: format!("{inputs}-{OUTPUTS}, one layer of logistic units without memory"),
            parameters: Perceptron::parameter_count(inputs, OUTPUTS),
            steps: config.steps as usize,
            step_seconds: config.time_step,
        }
    }
}

impl Task for PushEpisode<Layer> {
    fn info(&self) -> TaskInfo {
        TaskInfo {
            combination: Some(Combination::Mean),
            description: self.description(),
            trials: self.config().trials as usize,
            terms: vec!["moved [m]".into()],
            observations: self.config().inputs(),
            protocols: layer_protocols(&self.schema()).protocols(),
            anatomy: Some(Anatomy::new(&self.schema(), &self.description())),
            ..TaskInfo::new(self.parameters(), self.schema())
        }
    }

    fn behavior(&self) -> Option<&dyn Behavior> {
        Some(&BEHAVIOUR)
    }

    /// The mean over the trials.
    fn fitness(&self, trials: &[Outcome]) -> f64 {
        mean_of_trials(trials)
    }

    fn exports(&self) -> Option<&dyn Exports> {
        Some(self)
    }
}

impl Exports for PushEpisode<Layer> {
    fn robot(&self, _: Option<&[f32]>) -> Option<Robot> {
        Some(self.config().robot.description())
    }

    fn controller(&self, parameters: &[f32]) -> Option<ControllerExport> {
        let (config, inputs) = (self.config(), self.config().inputs());
        if parameters.len() != Perceptron::parameter_count(inputs, OUTPUTS) {
            return None;
        }
        let (robot, parameters) = (&config.robot, parameters.into());
        let network = NetworkExport::Perceptron { inputs, outputs: OUTPUTS, slope: 1.0, parameters };
        let range = robot.infrared.range;
        let sensor = |(place, angle): (usize, &f64)| {
            let degrees = angle.to_degrees();
            let quantity = format!("distance of a wall from the hull at {degrees:+.1} degrees, left positive");
            SensorExport {
                name: format!("infrared {}", place + 1),
                reads: SensorReading::Quantity { quantity, unit: "m", zero: range, one: 0.0, linear: true },
            }
        };
        let sensors = robot.infrared.angles.iter().take(inputs).enumerate().map(sensor).collect();
        let motors = wheel_exports(robot.max_wheel_speed);
        Some(ControllerExport::new(network, sensors, motors, config.time_step, config.steps))
    }
}

impl Rollout for PushEpisode<Layer> {
    fn load(&mut self, evaluation: &Evaluation<'_>) -> bool {
        let inputs = self.config().inputs();
        if evaluation.parameters.len() != Perceptron::parameter_count(inputs, OUTPUTS) {
            return false;
        }
        let change = applied(self, evaluation);
        let Ok(mut layer) = layer(inputs, change.edited(evaluation.parameters).into_owned()) else { return false };
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
        Outcome {
            terms: vec![self.fitness()],
            steps: trial.steps,
            success: trial.moved >= config.far,
            notes: vec![
                ("way of the box [m]", Note::from(trial.way)),
                ("share of time touching", Note::from(f64::from(trial.touched) / f64::from(config.steps))),
                ("fastest of the box [m/s]", Note::from(trial.fastest)),
            ],
            observed: self.controller().observed().cloned(),
            ..Outcome::default()
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::push_box::config::PushConfig;
    use crate::push_box::experiment::evaluator;
    use farsa_lab::advanced::Genotype;
    use farsa_lab::{EpisodeId, Evaluator};
    use farsa_view::Recording;

    #[test]
    fn genes_are_decoded_over_the_whole_range() {
        let task = evaluator(PushConfig::default()).unwrap();
        let first = Genotype::new(&task.info().parameters[..2], 16);
        assert_eq!(first.decode(&[0, u16::MAX]).unwrap(), [5.0, -5.0]);
        assert!(first.decode(&[u16::MAX / 2; 2]).unwrap()[0].abs() < 1e-3);
        // To the last bit as values 2 of this experiment computed it.
        for gene in (0..=u16::MAX).step_by(13) {
            let as_before = (5.0 - f64::from(gene) / f64::from(u16::MAX) * 2.0 * 5.0) as f32;
            assert_eq!(first.decode(&[gene; 2]).unwrap()[0], as_before);
        }
    }

    #[test]
    fn an_episode_can_be_repeated_and_recorded() {
        let mut evaluator = evaluator(PushConfig { steps: 40, ..PushConfig::default() }).unwrap();
        let genes: Vec<u16> = (0..18_u32).map(|i| (i * 40503) as u16).collect();
        let parameters = Genotype::new(&evaluator.info().parameters, 16).decode(&genes).unwrap();
        let id = EpisodeId { seed: 3, generation: 2, individual: 7, trial: 1 };
        let of = |id| Evaluation::new(&parameters, id);
        let plain = evaluator.evaluate(of(id), None);
        evaluator.evaluate(of(EpisodeId { trial: 3, ..id }), None);
        let mut recording = Recording::new(evaluator.info().schema);
        assert_eq!(evaluator.evaluate(of(id), Some(&mut recording)), plain);
        assert!(plain.is_finite() && plain.steps == 40, "{plain:?}");
        assert_eq!(recording.times().len(), 40);
        let columns = evaluator.info().schema.columns();
        let moved = columns.iter().position(|column| column == "box moved [m]").unwrap();
        assert_eq!(recording.row(39).nth(moved), Some(plain.terms[0]));
        // Shared by the generation's individuals.
        assert_eq!(evaluator.evaluate(of(EpisodeId { individual: 8, ..id }), None), plain);
        let short = Evaluation { parameters: &parameters[1..], ..of(id) };
        assert!(!evaluator.evaluate(short, None).is_finite());
    }
}
