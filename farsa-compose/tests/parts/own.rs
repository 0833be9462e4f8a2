//! A part of each kind, as a user's crate has them.

use farsa_body::Pose;
use farsa_body::ports::{Actuated, ActuatorId, BodyId, Channels, Handles, Kinematics, Motor, Sensor};
use farsa_body::robot::{Joint, MassProperties, Robot, Segment};
use farsa_body::robots::MobileRobot;
use farsa_compose::document::{Object, Shape};
use farsa_compose::part::{
    self, End, EndPart, Filter, Moment, MotorPart, NetworkEnds, NetworkPart, PartNetwork, PartScene, Quantity,
    SensorPart, Spot, Start, StartPart, Term, TermPart, ThingPart, WrapperPart,
};
use farsa_lab::advanced::Part;
use farsa_lab::{Error, Parameter};
use farsa_nn::{Ablatable, Controller, Lesion, Perceptron};
use farsa_num::{Scalar, Stream};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// Way to a thing in the axes of the robot, in two channels.
#[derive(Clone, Serialize, Deserialize, JsonSchema)]
pub(crate) struct Bearing {
    /// Name of the thing.
    to: String,
    /// Distance that reads 1 [m].
    #[serde(default = "one")]
    #[schemars(range(min = 0.1, max = 10.0))]
    reach: f64,
}

fn one() -> f64 {
    1.0
}

#[derive(Clone)]
pub(crate) struct BearingSensor {
    pub(crate) from: BodyId,
    pub(crate) to: BodyId,
    pub(crate) scale: f32,
}

impl Channels for BearingSensor {
    fn channels(&self) -> usize {
        2
    }
}

impl<W: Kinematics + Handles<Body = BodyId>> Sensor<W> for BearingSensor {
    fn read(&mut self, world: &W, out: &mut [f32]) {
        let way = world.pose(self.from).transform_back(world.pose(self.to).position);
        out.iter_mut().zip(&way[..2]).for_each(|(out, x)| *out = x * self.scale);
    }
}

impl SensorPart for Bearing {
    type Sensor = BearingSensor;
    fn sensor(&self, scene: &PartScene<'_>) -> Result<BearingSensor, Error> {
        Ok(BearingSensor { from: scene.body(None)?, to: scene.thing(&self.to)?, scale: 1.0 / self.reach as f32 })
    }
    fn quantity(&self, channel: usize, _: &PartScene<'_>) -> Quantity {
        let text = format!("{} of the way to {}", ["x", "y"][channel % 2], self.to);
        Quantity::new(text, "m", [0.0, self.reach])
    }
}

/// One channel that drives two actuators in opposite directions.
#[derive(Clone, Serialize, Deserialize, JsonSchema)]
pub(crate) struct Twist {
    /// Largest command.
    #[schemars(range(min = 0.0, max = 100.0))]
    largest: f64,
}

#[derive(Clone)]
pub(crate) struct TwistMotor(pub(crate) Vec<ActuatorId>, pub(crate) f32);

impl Channels for TwistMotor {
    fn channels(&self) -> usize {
        1
    }
}

impl<W: Actuated + Handles<Actuator = ActuatorId>> Motor<W> for TwistMotor {
    fn drive(&mut self, y: &[f32], world: &mut W) {
        let Some(&y) = y.first() else { return };
        let y = if y.is_nan() { 0.5 } else { y.clamp(0.0, 1.0) };
        for (index, actuator) in self.0.iter().enumerate() {
            let sign = if index % 2 == 0 { 1.0 } else { -1.0 };
            world.command(*actuator, [sign * self.1 * (2.0 * y - 1.0), 0.0]);
        }
    }
}

impl MotorPart for Twist {
    type Motor = TwistMotor;
    fn motor(&self, scene: &PartScene<'_>) -> Result<TwistMotor, Error> {
        let actuators = scene.actuators(&[])?;
        if actuators.is_empty() {
            return Err(scene.error("drives a robot without actuators"));
        }
        Ok(TwistMotor(actuators, self.largest as f32))
    }
}

/// A first-order filter with noise.
#[derive(Clone, Serialize, Deserialize, JsonSchema)]
pub(crate) struct Smooth {
    /// Share of the new value.
    #[schemars(range(min = 0.0, max = 1.0))]
    rate: f64,
    /// Largest added number.
    #[serde(default)]
    #[schemars(range(min = 0.0, max = 1.0))]
    noise: f64,
}

#[derive(Clone)]
pub(crate) struct SmoothFilter(Smooth, Vec<f32>);

impl Filter for SmoothFilter {
    fn reset(&mut self) {
        self.1.fill(0.0);
    }
    fn pass(&mut self, values: &mut [f32], noise: &mut Stream) {
        let (rate, largest) = (self.0.rate as f32, self.0.noise as f32);
        for (value, held) in values.iter_mut().zip(&mut self.1) {
            *held += rate * (*value - *held);
            *value = *held + noise.range(-largest, largest);
        }
    }
}

impl WrapperPart for Smooth {
    type Filter = SmoothFilter;
    fn filter(&self, channels: usize) -> Result<SmoothFilter, Error> {
        Ok(SmoothFilter(self.clone(), vec![0.0; channels]))
    }
}

/// One layer with its last output as a further input of each unit.
#[derive(Clone, Serialize, Deserialize, JsonSchema)]
pub(crate) struct Echo {
    /// Range of the weights, from minus to plus this.
    #[schemars(range(min = 0.0, max = 100.0))]
    largest: f64,
}

#[derive(Clone, Debug)]
pub(crate) struct EchoNetwork {
    inputs: usize,
    parameters: Vec<f32>,
    state: Vec<f32>,
}

impl Controller for EchoNetwork {
    fn inputs(&self) -> usize {
        self.inputs
    }
    fn outputs(&self) -> usize {
        self.state.len()
    }
    fn reset(&mut self) {
        self.state.fill(0.0);
    }
    fn step(&mut self, x: &[f32], y: &mut [f32]) {
        self.step_ablated(&[], x, y);
    }
}

impl Ablatable for EchoNetwork {
    fn neurons(&self) -> usize {
        self.state.len()
    }
    fn step_ablated(&mut self, lesions: &[Lesion], x: &[f32], y: &mut [f32]) {
        let size = self.inputs + 1;
        for (unit, weights) in self.parameters.chunks_exact(size).enumerate() {
            let sum: f32 = x.iter().zip(weights).map(|(x, w)| x * w).sum();
            let value = farsa_num::tanh(sum + weights[size - 1] * self.state[unit]);
            let lesion = lesions.iter().find(|lesion| lesion.neuron == unit);
            self.state[unit] = lesion.map_or(value, |lesion| lesion.activation);
            y[unit] = 0.5 + 0.5 * self.state[unit];
        }
    }
}

impl PartNetwork for EchoNetwork {
    fn copy_parameters(&mut self, parameters: &[f32]) -> bool {
        let fits = parameters.len() == self.parameters.len();
        if fits {
            self.parameters.copy_from_slice(parameters);
        }
        fits
    }
    fn parameters(&self) -> &[f32] {
        &self.parameters
    }
    fn activations(&self) -> &[f32] {
        &self.state
    }
}

impl NetworkPart for Echo {
    type Network = EchoNetwork;
    fn network(&self, ends: &NetworkEnds<'_>) -> Result<EchoNetwork, Error> {
        let [inputs, outputs] = ends.shape();
        Ok(EchoNetwork { inputs, parameters: vec![0.0; (inputs + 1) * outputs], state: vec![0.0; outputs] })
    }
    fn parameters(&self, _: &EchoNetwork, ends: &NetworkEnds<'_>) -> Vec<Parameter> {
        let [inputs, outputs] = ends.shape();
        let names = (0..(inputs + 1) * outputs).map(|number| format!("weight {}", number + 1));
        names.map(|name| Parameter::new(name, [-self.largest, self.largest])).collect()
    }
}

/// One layer with another slope.
#[derive(Clone, Serialize, Deserialize, JsonSchema)]
pub(crate) struct Steep {
    /// Slope of the logistic function.
    #[schemars(range(min = 0.1, max = 100.0))]
    slope: f64,
}

impl NetworkPart for Steep {
    type Network = Perceptron<Vec<f32>>;
    fn network(&self, ends: &NetworkEnds<'_>) -> Result<Self::Network, Error> {
        let [inputs, outputs] = ends.shape();
        let parameters = vec![0.0; Perceptron::parameter_count(inputs, outputs)];
        Ok(Perceptron::new(inputs, outputs, self.slope as f32, parameters)?)
    }
    fn parameters(&self, network: &Self::Network, ends: &NetworkEnds<'_>) -> Vec<Parameter> {
        let names = (1..=network.parameters().len()).map(|number| format!("weight {number}"));
        names.map(|name| Parameter::new(name, ends.weights)).collect()
    }
}

/// The robot crosses the line x = 0.5 m.
#[derive(Clone, Serialize, Deserialize, JsonSchema)]
pub(crate) struct Across {}

#[derive(Clone)]
pub(crate) struct AcrossEnd(BodyId);

impl<W: Kinematics + Handles<Body = BodyId>> End<W> for AcrossEnd {
    fn ends(&self, world: &W, _: &Moment<'_>, _: bool) -> bool {
        world.pose(self.0).position[0] > 0.5
    }
}

impl EndPart for Across {
    type End = AcrossEnd;
    fn end(&self, scene: &PartScene<'_>) -> Result<AcrossEnd, Error> {
        Ok(AcrossEnd(scene.body(None)?))
    }
}

/// Distance between the robot and a thing [m].
#[derive(Clone, Serialize, Deserialize, JsonSchema)]
pub(crate) struct Away {
    /// Name of the thing.
    from: String,
}

#[derive(Clone)]
pub(crate) struct AwayTerm(pub(crate) [BodyId; 2]);

impl<W: Kinematics + Handles<Body = BodyId>> Term<W> for AwayTerm {
    fn value(&self, world: &W, _: &Moment<'_>) -> f64 {
        let [p, q] = self.0.map(|body| world.pose(body).position.map(f64::from));
        Scalar::sqrt((0..3).map(|k| (p[k] - q[k]) * (p[k] - q[k])).sum::<f64>())
    }
}

impl TermPart for Away {
    type Term = AwayTerm;
    fn term(&self, scene: &PartScene<'_>) -> Result<AwayTerm, Error> {
        Ok(AwayTerm([scene.body(None)?, scene.thing(&self.from)?]))
    }
}

/// Way of the robot since the start [m].
#[derive(Clone, Serialize, Deserialize, JsonSchema)]
pub(crate) struct Path {}

#[derive(Clone)]
pub(crate) struct PathTerm {
    body: BodyId,
    at: [f32; 3],
    way: f64,
}

impl<W: Kinematics + Handles<Body = BodyId>> Term<W> for PathTerm {
    fn start(&mut self, world: &W, _: &Moment<'_>) {
        (self.at, self.way) = (world.pose(self.body).position, 0.0);
    }
    fn step(&mut self, world: &W, _: &Moment<'_>) {
        let now = world.pose(self.body).position;
        let squares = (0..3).map(|k| f64::from(now[k] - self.at[k])).map(|x| x * x);
        self.way += Scalar::sqrt(squares.sum::<f64>());
        self.at = now;
    }
    fn value(&self, _: &W, _: &Moment<'_>) -> f64 {
        self.way
    }
}

impl TermPart for Path {
    type Term = PathTerm;
    fn term(&self, scene: &PartScene<'_>) -> Result<PathTerm, Error> {
        Ok(PathTerm { body: scene.body(None)?, at: [0.0; 3], way: 0.0 })
    }
}

/// Uniformly on a line.
#[derive(Clone, Serialize, Deserialize, JsonSchema)]
pub(crate) struct OnLine {
    /// First end [m].
    from: [f64; 3],
    /// Second end [m].
    to: [f64; 3],
}

impl<W> Start<W> for OnLine {
    fn pose(&self, _: &W, _: &mut Spot<'_>, stream: &mut Stream) -> Option<Pose> {
        let share = stream.range_f64(0.0, 1.0);
        Some(Pose::at([0, 1, 2].map(|k| (self.from[k] + share * (self.to[k] - self.from[k])) as f32)))
    }
}

impl StartPart for OnLine {
    type Start = Self;
    fn start(&self, _: &PartScene<'_>) -> Result<Self, Error> {
        Ok(self.clone())
    }
}

/// Two posts with a gap between them.
#[derive(Clone, Serialize, Deserialize, JsonSchema)]
pub(crate) struct Gate {
    /// Distance between the posts' centers [m].
    #[schemars(range(min = 0.1, max = 10.0))]
    width: f64,
}

impl ThingPart for Gate {
    fn things(&self, object: &Object) -> Result<Vec<Object>, Error> {
        let Some([x, y, ..]) = object.at.as_deref() else { return Err(Error::Other("lacks the key `at`".into())) };
        let post = |name: String, sign: f64| Object {
            name,
            at: Some(vec![*x, y + sign * 0.5 * self.width]),
            shape: Some(Shape::Cylinder { radius: 0.02, height: 0.1, color: [1.0, 0.0, 0.0], lamp: 0.0 }),
            ..object.clone()
        };
        Ok(vec![post(object.name.clone(), 1.0), post(format!("{}-right", object.name), -1.0)])
    }
}

/// A bar that turns about the vertical, with a motor.
fn turntable() -> Robot {
    use farsa_body::actuators::{Law, Torque};
    let mut robot = Robot::default();
    let hinge = Joint::revolute("hinge", [0.0, 0.0, 1.0], Pose::identity(), [-3.0, 3.0]);
    robot.add_segment(Segment::new("bar", None, hinge, MassProperties::sphere(1.0, 0.2)));
    let joint = robot.joints().next().expect("a joint");
    robot.add_actuator("motor", joint, Law::Torque(Torque { limit: 2.0 }));
    robot
}

/// All of them under their names.
pub(crate) fn parts() -> Vec<Part> {
    vec![
        part::sensor::<Bearing>("bearing"),
        part::motor::<Twist>("twist"),
        part::wrapper::<Smooth>("smooth"),
        part::network::<Echo>("echo"),
        part::network::<Steep>("steep"),
        part::end::<Across>("across"),
        part::term::<Away>("away"),
        part::term::<Path>("path"),
        part::start::<OnLine>("on-line"),
        part::thing::<Gate>("gate"),
        part::robot_on_wheels("mini", MobileRobot { radius: 0.02, ..MobileRobot::e_puck() }),
        part::robot_with_joints("turntable", turntable()),
    ]
}
