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

/// A sensor channel.
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
    /// Creates a channel that drives a quantity, which is `ends[0]` at 0 and `ends[1]` at 1.
    pub fn quantity(name: impl Into<String>, quantity: impl Into<String>, unit: &'static str, ends: [f64; 2]) -> Self {
        let [zero, one] = ends;
        Self { name: name.into(), drives: MotorDrive::Quantity { quantity: quantity.into(), unit, zero, one } }
    }
}

/// The spring and damper between a pair of shapes.
///
/// The normal force at the end of a step is stiffness * depth - damping * the separation speed of the shapes. Negative
/// forces are 0. A pair touches while its depth is positive and exceeds damping / stiffness times that speed.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct SurfaceExport {
    /// Names of the two shapes.
    pub pair: [String; 2],
    /// Stiffness \[N/m\].
    pub stiffness: f64,
    /// Damping \[N s/m\].
    pub damping: f64,
}

/// The reading of a sensor channel.
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
    /// min(1, n / saturation), with n pairs of shapes that touch under a normal force > 0. See [`SurfaceExport`].
    Touch {
        /// Names of the pairs' two shapes.
        pairs: Vec<[String; 2]>,
        /// Number of pairs that reads 1.
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
    /// A quantity by what is read at two values of it.
    Quantity {
        /// Which.
        quantity: String,
        /// Unit. `1` for none.
        unit: &'static str,
        /// Its value that reads 0.
        zero: f64,
        /// Its value that reads 1.
        one: f64,
        /// True if readings in between are (q - zero) / (one - zero). Otherwise they follow a curve or a table.
        linear: bool,
    },
    /// The sensor channel of this number, from 0, as the experiment's own program reads it.
    Channel {
        /// Its number.
        channel: usize,
    },
    /// `amplitude` in the phase of this name, else 0. The phase is that after the previous step, and the first phase at
    /// the start.
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

/// A motor channel. Its value is clamped into \[0, 1\] first unless stated otherwise.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct MotorExport {
    /// Name of the channel.
    pub name: String,
    /// Quantity that the channel drives.
    #[serde(flatten)]
    pub drives: MotorDrive,
}

/// The effect of a motor channel.
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
    /// A quantity, zero + (one - zero) y, without clamping y.
    Quantity {
        /// Which.
        quantity: String,
        /// Unit. `1` for none.
        unit: &'static str,
        /// Its value at 0.
        zero: f64,
        /// Its value at 1.
        one: f64,
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

/// The judgement of `reach-grasp-lift` trials, on which phases and success depend.
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
    /// Number of final steps during which the object must be held.
    pub success_steps: u32,
}

/// Where a trial starts, at rest: every joint, and every free body by its place.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct StartExport {
    /// Position of every joint \[rad or m\], by name.
    pub joints: Vec<(String, f32)>,
    /// Position of every free body's origin \[m\], by name, without rotation.
    pub bodies: Vec<(String, [f32; 3])>,
}
