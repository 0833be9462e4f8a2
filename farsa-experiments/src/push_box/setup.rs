//! `push-box` ready to be lived.

use farsa_body::{Kinematics as _, Pose, Recorder, World as _};
use farsa_nn::Perceptron;
use farsa_physics::rapier::ArenaWorld;

use crate::push_box::config::PushConfig;
use crate::push_box::{life::OUTPUTS, life::PushLife};
use farsa_lab::{ChannelGroup, Description, Error, Job, Life as _, Note, Outcome, Setup, Tape};
use farsa_view::{Channel, Form, Links, NodeParameters, Prop, Role, Stage, screen_color};

/// The layer of two logistic units that genes are decoded into.
type Layer = Perceptron<Vec<f32>>;

/// The plane with the robot's life on it: everything that a thread needs to live lives.
pub(crate) struct Lives {
    world: ArenaWorld,
    life: PushLife<Layer>,
}

/// Two logistic units over these parameters.
fn layer(inputs: usize, parameters: Vec<f32>) -> Result<Layer, Error> {
    Perceptron::new(inputs, OUTPUTS, 1.0, parameters).map_err(|error| Error::Other(format!("push-box: {error}")))
}

/// The parameters that genes stand for, in their order: from +range to -range.
fn decode(genes: &[u16], range: f64) -> Vec<f32> {
    genes.iter().map(|gene| (range - f64::from(*gene) / f64::from(u16::MAX) * 2.0 * range) as f32).collect()
}

impl Lives {
    /// Lives under a configuration.
    ///
    /// # Errors
    /// [`Error::Other`] for values that make no world.
    pub(crate) fn new(config: PushConfig) -> Result<Self, Error> {
        let inputs = config.inputs();
        let layer = layer(inputs, vec![0.0; Perceptron::parameter_count(inputs, OUTPUTS)])?;
        Ok(Self { world: config.world()?, life: PushLife::new(config, layer)? })
    }

    /// Tells what was sensed, computed and done before the step that has just been judged, and what it led to.
    fn tell(&self, was: Pose, recorder: &mut dyn Recorder) {
        let Self { world, life } = self;
        let (trial, parts) = (life.trial(), life.parts());
        recorder.sensors(life.sensed());
        recorder.outputs(life.done());
        life.infrared().tell(was, life.sensed(), recorder);
        let mut scalars = Vec::with_capacity(9);
        for body in [parts.body, life.cube()] {
            let pose = world.pose(body);
            recorder.pose(body, pose);
            let [x, y, _] = pose.position.map(f64::from);
            scalars.extend([x, y, f64::from(pose.heading())]);
        }
        let largest = life.config().robot.max_wheel_speed;
        scalars.extend(life.done().iter().map(|y| (2.0 * f64::from(*y) - 1.0) * largest));
        scalars.push(trial.moved);
        recorder.scalars(&scalars);
        // Rounded to the nanosecond: 201 steps of 0.05 s print as 10.05.
        recorder.tick((f64::from(trial.steps) * life.config().time_step * 1e9).round() / 1e9);
    }
}

impl Setup for Lives {
    fn genes(&self) -> usize {
        Perceptron::parameter_count(self.life.config().inputs(), OUTPUTS)
    }

    fn trials(&self) -> usize {
        self.life.config().trials as usize
    }

    fn terms(&self) -> Vec<String> {
        vec!["moved [m]".into()]
    }

    fn stage(&self) -> Stage {
        let config = self.life.config();
        let (inputs, scene) = (config.inputs(), config.scene());
        let in_group = |group: &'static str| move |name: &str| Channel::new(name).group(group);
        let largest = config.robot.max_wheel_speed;
        let places = ["x [m]", "y [m]", "heading [rad]"];
        let of_box = places.map(|place| format!("box {place}"));
        let wheels = ["left wheel [rad/s]", "right wheel [rad/s]"].map(in_group("actuator"));
        let eyes = (1..=inputs).map(|number| format!("infrared {number}"));
        let mut stage = Stage::of_arena(&scene.arena).with_sensors(eyes).with_outputs(["left wheel", "right wheel"]);
        stage.outputs.iter_mut().chain(&mut stage.sensors).for_each(|channel| channel.range = Some([0.0, 1.0]));
        for block in &scene.blocks {
            let half = block.size.map(|x| 0.5 * x);
            let middle = Pose::at([0.0, 0.0, half[2]]);
            let prop = Prop::new("box", Form::Box { half }, middle, Role::Thing).on(self.life.cube());
            stage.props.push(prop.with_color(screen_color(block.color)));
            stage.bodies.push("box".into());
        }
        Stage {
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
            ..stage
        }
    }

    fn description(&self) -> Description {
        let config = self.life.config();
        let (inputs, speed) = (config.inputs(), config.speed());
        let wheels = format!("left and right, 0 backwards .. 1/2 at rest .. 1 ahead, {:.0} mm/s", 1e3 * speed);
        Description {
            sensors: vec![ChannelGroup::new("infrared", inputs, "all around, by rays, 0 nothing .. 1 at the hull")],
            motors: vec![ChannelGroup::new("wheels", OUTPUTS, &wheels)],
            network: format!("{inputs}-{OUTPUTS}, one layer of logistic units without memory"),
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
        let parameters = decode(genes, range);
        if let Some(recorder) = tape.recorder() {
            recorder.parameters(&parameters);
        }
        let Ok(layer) = layer(inputs, parameters) else { return Outcome::failed() };
        self.life.set_controller(layer);
        self.life.start(&mut self.world, job);
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

impl Lives {
    fn outcome(&self) -> Outcome {
        let (trial, config) = (self.life.trial(), self.life.config());
        if trial.failed {
            return Outcome::failed();
        }
        Outcome {
            terms: vec![self.life.fitness()],
            steps: trial.steps,
            success: trial.moved >= config.far,
            notes: vec![
                ("way of the box [m]", Note::from(trial.way)),
                ("share of time touching", Note::from(f64::from(trial.touched) / f64::from(config.steps))),
                ("fastest of the box [m/s]", Note::from(trial.fastest)),
            ],
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use farsa_view::Recording;

    #[test]
    fn genes_are_decoded_over_the_whole_range() {
        assert_eq!(decode(&[0, u16::MAX], 5.0), [5.0, -5.0]);
        assert!(decode(&[u16::MAX / 2], 5.0)[0].abs() < 1e-3);
    }

    #[test]
    fn a_life_can_be_repeated_and_taped() {
        let mut lives = Lives::new(PushConfig { steps: 40, ..PushConfig::default() }).unwrap();
        let genes: Vec<u16> = (0..18_u32).map(|i| (i * 40503) as u16).collect();
        let job = Job { seed: 3, generation: 2, individual: 7, trial: 1 };
        let plain = lives.live(&genes, job, &mut Tape::off());
        lives.live(&genes, Job { trial: 3, ..job }, &mut Tape::off());
        let mut recording = Recording::new(lives.stage());
        assert_eq!(lives.live(&genes, job, &mut Tape::to(&mut recording)), plain);
        assert!(plain.is_finite() && plain.steps == 40, "{plain:?}");
        assert_eq!(recording.times().len(), 40);
        let columns = lives.stage().columns();
        let moved = columns.iter().position(|column| column == "box moved [m]").unwrap();
        assert_eq!(recording.row(39).nth(moved), Some(plain.terms[0]));
        // Shared by the generation's individuals.
        assert_eq!(lives.live(&genes, Job { individual: 8, ..job }, &mut Tape::off()), plain);
        assert!(!lives.live(&genes[1..], job, &mut Tape::off()).is_finite());
    }
}
