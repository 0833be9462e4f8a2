//! A controller, its body's channels and its starts as plain data, for `farsa export`.

use farsa_body::{Axes, Law};
use farsa_nn::{CtrnnLayout, Leak, LeakyLayout, LeakyParts};
use serde::Serialize;

/// A controller with all that another program needs to run it in another world: numbers, and names of the model that
/// `farsa export robot` writes.
///
/// Units are SI unless a channel says otherwise. Numbers are those that trials here use: what is single precision here is
/// written with the digits that single precision needs.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct ControllerExport {
    /// The network.
    pub network: NetworkExport,
    /// The sensors in the order of the network's inputs.
    pub sensors: Vec<SensorExport>,
    /// The motors in the order of the network's outputs.
    pub motors: Vec<MotorExport>,
    /// The laws of the actuators that motors command, in the order of the robot's description.
    pub actuators: Vec<ActuatorExport>,
    /// The surfaces of all pairs of shapes that may touch, in the order of the robot's description.
    pub surfaces: Vec<SurfaceExport>,
    /// How a trial is judged, where sensors depend on it.
    pub judge: Option<JudgeExport>,
    /// Control step \[s\].
    pub time_step: f64,
    /// Most control steps of a trial.
    pub steps: u32,
}

/// A leaky recurrent network, [`farsa_nn::LeakyNetwork`].
#[derive(Clone, Debug, PartialEq, Serialize)]
#[non_exhaustive]
pub struct NetworkExport {
    /// Number of inputs.
    pub inputs: usize,
    /// Number of hidden neurons.
    pub hidden: usize,
    /// Number of outputs.
    pub outputs: usize,
    /// Slope s of sigma(x) = 1 / (1 + exp(-s x)).
    pub slope: f32,
    /// Which reading of the leak d, with y = sigma(net): `filter` is H = d y + (1-d) H(t-1), `two-tap` d y + (1-d) y(t-1),
    /// `evonet` d H(t-1) + (1-d) y.
    pub leak: &'static str,
    /// From input j to hidden neuron i, at j * hidden + i.
    pub sensor_weights: Vec<f32>,
    /// From hidden neuron k, one step ago, to hidden neuron i, at k * hidden + i.
    pub recurrent_weights: Vec<f32>,
    /// From hidden neuron j to output i, at j * outputs + i.
    pub output_weights: Vec<f32>,
    /// Biases of the hidden neurons.
    pub biases: Vec<f32>,
    /// Leaks of the hidden neurons.
    pub leaks: Vec<f32>,
}

/// A continuous-time network, [`farsa_nn::Ctrnn`], with what its channels are called: all that its bytes hold.
#[derive(Clone, Debug, PartialEq)]
pub struct CtrnnExport {
    /// The layout.
    pub layout: CtrnnLayout,
    /// Time step \[s\].
    pub time_step: f32,
    /// The parameters in the order of the layout.
    pub parameters: Vec<f32>,
    /// What the inputs are called.
    pub sensors: Vec<String>,
    /// What the outputs are called.
    pub motors: Vec<String>,
}

/// A sensor channel.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct SensorExport {
    /// What it is called here.
    pub name: String,
    /// What it reads.
    #[serde(flatten)]
    pub reads: SensorReading,
}

/// What lies between a pair of shapes: a spring and a damper.
///
/// The normal force at the end of a step is stiffness * depth - damping * the speed at which the shapes part, and none where
/// that is not positive: a pair touches while its depth is more than 0 and more than damping / stiffness times that speed.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct SurfaceExport {
    /// Names of the two shapes.
    pub pair: [String; 2],
    /// Stiffness \[N/m\].
    pub stiffness: f64,
    /// Damping \[N s/m\].
    pub damping: f64,
}

/// What a sensor channel reads.
#[derive(Clone, Debug, PartialEq, Serialize)]
#[serde(tag = "reads", rename_all = "kebab-case")]
#[non_exhaustive]
pub enum SensorReading {
    /// (q - from) / (to - from), not clamped.
    JointPosition {
        /// The joint.
        joint: String,
        /// Position that reads 0 \[rad\].
        from: f32,
        /// Position that reads 1 \[rad\].
        to: f32,
    },
    /// min(1, n / saturation), n pairs of shapes that touch under a normal force > 0; see [`SurfaceExport`].
    Touch {
        /// Names of the pairs' two shapes.
        pairs: Vec<[String; 2]>,
        /// How many pairs read 1.
        saturation: f32,
    },
    /// One component of scale * (target - from).
    Way {
        /// Where it leads to.
        target: PointExport,
        /// Where it begins.
        from: PointExport,
        /// Whose axes the components are of: `world`'s, or those of the `body` of `from`.
        axes: Axes,
        /// 0, 1, 2 for x, y, z.
        component: usize,
        /// Units per metre.
        scale: f32,
    },
    /// The sensor channel of this number, from 0, as the experiment's own program reads it.
    Channel {
        /// Its number.
        channel: usize,
    },
    /// `amplitude` in the phase of this name, else 0; the phase is that after the step before, the first one at the start.
    Label {
        /// The phase.
        phase: &'static str,
        /// The value that names it.
        amplitude: f32,
    },
}

/// A point of a body.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct PointExport {
    /// The body.
    pub body: String,
    /// Where it is in the body's frame \[m\].
    pub at: [f64; 3],
}

/// A motor channel; its value is clamped into \[0, 1\] first.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct MotorExport {
    /// What it is called here.
    pub name: String,
    /// What it drives.
    #[serde(flatten)]
    pub drives: MotorDrive,
}

/// What a motor channel drives.
#[derive(Clone, Debug, PartialEq, Serialize)]
#[serde(tag = "drives", rename_all = "kebab-case")]
#[non_exhaustive]
pub enum MotorDrive {
    /// The activation of one of an actuator's two muscles.
    Muscle {
        /// The actuator.
        actuator: String,
        /// 0 the agonist, which pulls towards the joint's lower limit, 1 the antagonist.
        muscle: usize,
    },
    /// The motor channel of this number, from 0, as the experiment's own program drives it.
    Channel {
        /// Its number.
        channel: usize,
    },
    /// The desired positions of servos, from + (to - from) y each.
    Servos {
        /// The servos.
        servos: Vec<ServoExport>,
    },
}

/// A servo and its positions at both ends of a motor channel.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct ServoExport {
    /// The actuator.
    pub actuator: String,
    /// Desired position at 0 \[rad\].
    pub from: f32,
    /// Desired position at 1 \[rad\].
    pub to: f32,
}

/// An actuator and its law.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct ActuatorExport {
    /// The actuator.
    pub name: String,
    /// Its joint.
    pub joint: String,
    /// Its law.
    pub law: Law<f64>,
}

/// How trials of `reach-grasp-lift` are judged: what phases and success depend on.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct JudgeExport {
    /// The phases in their order.
    pub phases: Vec<&'static str>,
    /// The body that is to be lifted.
    pub target: String,
    /// The palm's centre.
    pub palm: PointExport,
    /// The fingers' tips.
    pub fingertips: Vec<PointExport>,
    /// Pairs of the target and the fingers.
    pub on_fingers: Vec<[String; 2]>,
    /// The pair of the target and the table.
    pub on_table: [String; 2],
    /// Height of the target's centre above the world's origin from which it counts as held \[m\].
    pub success_height: f64,
    /// How many of the last steps it must have been held in, all of them.
    pub success_steps: u32,
}

/// Where a trial starts, at rest: every joint, and every free body by its place.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct StartExport {
    /// Position of every joint \[rad or m\], by name.
    pub joints: Vec<(String, f32)>,
    /// Place of every free body's origin \[m\], by name; none is turned.
    pub bodies: Vec<(String, [f32; 3])>,
}

impl NetworkExport {
    /// A network of these parameters.
    pub fn new(layout: &LeakyLayout, leak: Leak, parameters: &[f32]) -> Self {
        let LeakyParts { sensor_weights, recurrent_weights, output_weights, biases, leaks, .. } =
            layout.split(parameters);
        Self {
            inputs: layout.sensors(),
            hidden: layout.hidden(),
            outputs: layout.outputs(),
            slope: layout.slope(),
            leak: leak.name(),
            sensor_weights: sensor_weights.into(),
            recurrent_weights: recurrent_weights.into(),
            output_weights: output_weights.into(),
            biases: biases.into(),
            leaks: leaks.into(),
        }
    }
}
