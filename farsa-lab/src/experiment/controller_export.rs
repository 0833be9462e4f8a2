//! A controller, its body's channels and its starts as plain data, for `farsa export`.

use farsa_body::actuators::Law;
use farsa_body::sensors::Axes;
use farsa_nn::bytes::channel_hash;
use serde::Serialize;

use crate::experiment::network_export::NetworkExport;

/// A controller with everything that another program needs to run it in a different world.
///
/// It refers to bodies, joints and actuators by their names in the model that `farsa export robot` writes.
///
/// Units are SI unless a channel states otherwise. Single-precision numbers are written with the digits that single
/// precision needs.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct ControllerExport {
    /// Network of the controller.
    pub network: NetworkExport,
    /// Sensors, in the same order as the inputs of the network.
    pub sensors: Vec<SensorExport>,
    /// Motors, in the same order as the outputs of the network.
    pub motors: Vec<MotorExport>,
    /// Laws of the actuators that motors command, in the order of the robot description.
    pub actuators: Vec<ActuatorExport>,
    /// Surfaces of all pairs of shapes that may touch, in the order of the robot description.
    pub surfaces: Vec<SurfaceExport>,
    /// Judgement of a trial. This is `None` unless sensors depend on it.
    pub judge: Option<JudgeExport>,
    /// Control step \[s\].
    pub time_step: f64,
    /// Maximum number of control steps in a trial.
    pub steps: u32,
}

impl ControllerExport {
    /// Creates a controller without actuators, surfaces or a judge. Set these fields afterwards if you need them.
    pub fn new(
        network: NetworkExport,
        sensors: Vec<SensorExport>,
        motors: Vec<MotorExport>,
        time_step: f64,
        steps: u32,
    ) -> Self {
        let (actuators, surfaces) = (Vec::new(), Vec::new());
        Self { network, sensors, motors, actuators, surfaces, judge: None, time_step, steps }
    }

    /// Computes the [`channel_hash`](farsa_nn::bytes::channel_hash) of the names of all channels.
    pub fn channels(&self) -> u64 {
        let sensors = self.sensors.iter().map(|sensor| &sensor.name);
        channel_hash(sensors, self.motors.iter().map(|motor| &motor.name))
    }
}

/// A sensor channel of a controller.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct SensorExport {
    /// Name of the channel.
    pub name: String,
    /// Quantity that the channel reads.
    #[serde(flatten)]
    pub reads: SensorReading,
}

impl SensorExport {
    /// Creates a channel that reads a quantity.
    ///
    /// It reads 0 at `ends[0]` and 1 at `ends[1]`, and is linear in between.
    pub fn quantity(name: impl Into<String>, quantity: impl Into<String>, unit: &'static str, ends: [f64; 2]) -> Self {
        let [zero, one] = ends;
        let reads = SensorReading::Quantity { quantity: quantity.into(), unit, zero, one, linear: true };
        Self { name: name.into(), reads }
    }
}

impl MotorExport {
    /// Creates a channel that drives a quantity.
    ///
    /// Its value is `ends[0]` at 0 and `ends[1]` at 1.
    pub fn quantity(name: impl Into<String>, quantity: impl Into<String>, unit: &'static str, ends: [f64; 2]) -> Self {
        let [zero, one] = ends;
        Self { name: name.into(), drives: MotorDrive::Quantity { quantity: quantity.into(), unit, zero, one } }
    }
}

/// Spring and damper between a pair of shapes.
///
/// At the end of a step, the normal force is stiffness * depth - damping * the speed at which the shapes separate.
/// Negative forces are set to 0. A pair touches while its depth is positive and exceeds damping / stiffness times
/// this speed.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct SurfaceExport {
    /// Names of both shapes.
    pub pair: [String; 2],
    /// Stiffness \[N/m\].
    pub stiffness: f64,
    /// Damping \[N s/m\].
    pub damping: f64,
}

/// Reading of a sensor channel.
#[derive(Clone, Debug, PartialEq, Serialize)]
#[serde(tag = "reads", rename_all = "kebab-case")]
#[non_exhaustive]
pub enum SensorReading {
    /// Position q of a joint. This reads (q - from) / (to - from), and is not clamped.
    JointPosition {
        /// Name of the joint.
        joint: String,
        /// Position that reads 0 \[rad\].
        from: f32,
        /// Position that reads 1 \[rad\].
        to: f32,
    },
    /// Number n of touching pairs of shapes, relative to a saturation. This reads min(1, n / saturation). Only pairs
    /// with a normal force > 0 count. See [`SurfaceExport`].
    Touch {
        /// Names of both shapes, for each pair.
        pairs: Vec<[String; 2]>,
        /// Number of pairs at which the sensor reads 1.
        saturation: f32,
    },
    /// Component of the vector between two points. This reads scale * (target - from).
    Way {
        /// End point of the vector.
        target: PointExport,
        /// Start point of the vector.
        from: PointExport,
        /// Axes for the components. They belong either to the `world` or to the `body` of `from`.
        axes: Axes,
        /// Index of the component, where 0, 1 and 2 are x, y and z.
        component: usize,
        /// Scale of the reading, in units per meter.
        scale: f32,
    },
    /// Any other quantity, given by its values at readings of 0 and 1.
    Quantity {
        /// Description of the quantity.
        quantity: String,
        /// Unit of the quantity. This is `1` for pure numbers.
        unit: &'static str,
        /// Quantity at a reading of 0.
        zero: f64,
        /// Quantity at a reading of 1.
        one: f64,
        /// If this is `true`, readings in between are (q - zero) / (one - zero). Otherwise they follow a curve or a
        /// table.
        linear: bool,
    },
    /// A channel that only the experiment's own program can read.
    Channel {
        /// Number of the sensor channel, from 0.
        channel: usize,
    },
    /// Indicator of a phase. It reads `amplitude` during this phase, and 0 otherwise.
    ///
    /// Note that this uses the phase after the previous step. In the first step, it is the first phase.
    Label {
        /// Name of the phase.
        phase: &'static str,
        /// Value of the sensor during this phase.
        amplitude: f32,
    },
    /// Output of the network in the previous step. It reads scale * output, and 0 in the first step.
    PreviousOutput {
        /// Number of the output, from 0.
        channel: usize,
        /// Reading at an output of 1.
        scale: f32,
    },
}

/// A point that is fixed to a body.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct PointExport {
    /// Name of the body.
    pub body: String,
    /// Position in the frame of the body \[m\].
    pub at: [f64; 3],
}

/// A motor channel of a controller.
///
/// Unless stated otherwise, its value is first clamped to \[0, 1\].
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct MotorExport {
    /// Name of the channel.
    pub name: String,
    /// Quantity that the channel drives.
    #[serde(flatten)]
    pub drives: MotorDrive,
}

/// Effect of a motor channel.
#[derive(Clone, Debug, PartialEq, Serialize)]
#[serde(tag = "drives", rename_all = "kebab-case")]
#[non_exhaustive]
pub enum MotorDrive {
    /// Activation of one of the two muscles of an actuator.
    Muscle {
        /// Name of the actuator.
        actuator: String,
        /// Index of the muscle. The agonist is 0, and pulls towards the lower limit of the joint. The antagonist is
        /// 1.
        muscle: usize,
    },
    /// Any other quantity, which is set to zero + (one - zero) y. Note that y is not clamped here.
    Quantity {
        /// Description of the quantity.
        quantity: String,
        /// Unit of the quantity. This is `1` for pure numbers.
        unit: &'static str,
        /// Quantity at a channel value of 0.
        zero: f64,
        /// Quantity at a channel value of 1.
        one: f64,
    },
    /// A channel that only the experiment's own program can drive.
    Channel {
        /// Number of the motor channel, from 0.
        channel: usize,
    },
    /// Input of the network in the next step, which is not clamped. Its scale is in [`SensorReading::PreviousOutput`].
    NextInput {
        /// Number of the input, from 0.
        channel: usize,
    },
    /// Desired positions of several servos. Each is set to from + (to - from) y.
    Servos {
        /// Servos that follow the channel.
        servos: Vec<ServoExport>,
    },
}

/// A servo, with its positions at both ends of a motor channel.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct ServoExport {
    /// Name of the actuator.
    pub actuator: String,
    /// Desired position at 0 \[rad\].
    pub from: f32,
    /// Desired position at 1 \[rad\].
    pub to: f32,
}

/// An actuator with its joint and its law.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct ActuatorExport {
    /// Name of the actuator.
    pub name: String,
    /// Name of the joint that it moves.
    pub joint: String,
    /// Law that maps commands to efforts.
    pub law: Law<f64>,
}

/// Judgement of `reach-grasp-lift` trials. Phases and success of a trial depend on it.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct JudgeExport {
    /// Names of all phases, in their order.
    pub phases: Vec<&'static str>,
    /// Name of the body to lift.
    pub target: String,
    /// Center of the palm.
    pub palm: PointExport,
    /// Tips of all fingers.
    pub fingertips: Vec<PointExport>,
    /// Pairs of the target with each finger.
    pub on_fingers: Vec<[String; 2]>,
    /// Pair of the target with the table.
    pub on_table: [String; 2],
    /// Minimum height at which the target counts as held \[m\]. This is measured from the world's origin to the
    /// center of the target.
    pub success_height: f64,
    /// Number of final steps during which the object must be held.
    pub success_steps: u32,
}

/// Initial state of a trial, in which everything is at rest.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct StartExport {
    /// Position of every joint \[rad or m\], together with its name.
    pub joints: Vec<(String, f32)>,
    /// Position of every free body \[m\], together with its name. Bodies start without any rotation.
    pub bodies: Vec<(String, [f32; 3])>,
}
