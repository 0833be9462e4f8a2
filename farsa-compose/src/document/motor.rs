//! Motors.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};
use serde_json::{Map, Value};

use crate::document::wrapper::Wrapper;
use crate::document::yes;
use crate::name::NAME;

/// A motor of each robot.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct Motor {
    /// Name for settings, drawings and recordings, by default the kind.
    #[schemars(regex(pattern = NAME))]
    pub name: Option<String>,
    /// Names of the channels, in the order of the network's outputs, by default the name with a number.
    pub channels: Option<Vec<String>>,
    /// Enables the motor. The network has no outputs for a disabled one.
    #[serde(default = "yes")]
    pub enabled: bool,
    /// Wrappers of the values, of which the last is applied first.
    #[serde(default)]
    #[schemars(length(max = 32))]
    pub wrappers: Vec<Wrapper>,
    /// The kind of motor.
    #[serde(flatten)]
    pub kind: MotorKind,
}

/// The kinds of motors.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(tag = "kind", rename_all = "kebab-case")]
pub enum MotorKind {
    /// Left and right wheel: 0 backwards .. 1/2 at rest .. 1 ahead.
    Wheels {},
    /// Speed, 0 backwards .. 1 ahead, and turn, 0 right .. 1/2 straight on .. 1 left.
    SpeedAndTurn {
        /// Never drives backwards: 0 is at rest.
        #[serde(default)]
        forwards: bool,
    },
    /// LEDs, 0 dark .. 1.
    Leds {
        /// LEDs by color.
        colors: Vec<Led>,
        /// Accepts robots without LEDs, which then show no light.
        #[serde(default)]
        optional: bool,
    },
    /// Signal strength, 0 to 1.
    Signal {},
    /// The attachment device. Above 1/2 it holds the robot in front.
    Attachment {},
    /// Speeds of joints, one channel each: 0 down .. 1/2 at rest .. 1 up.
    JointVelocity {
        /// Names of joints, by default all of the robot.
        #[serde(default)]
        joints: Vec<String>,
        /// Greatest speed [rad/s or m/s].
        #[schemars(range(min = 1e-6, max = 1e6))]
        largest: f64,
        /// Torque per missing speed [N m s/rad or N s/m], by default that of the model's own motor.
        #[schemars(range(min = 1e-9, max = 1e9))]
        gain: Option<f64>,
        /// Largest torque of a motor with this `gain` [N m or N], by default unlimited.
        #[schemars(range(min = 1e-9, max = 1e9))]
        limit: Option<f64>,
    },
    /// Torques of joints, one channel each: 0 down .. 1/2 none .. 1 up.
    JointTorque {
        /// Names of joints, by default all of the robot.
        #[serde(default)]
        joints: Vec<String>,
        /// Largest torque [N m or N], by default that of the model's own motor.
        #[schemars(range(min = 1e-9, max = 1e9))]
        largest: Option<f64>,
    },
    /// Target positions of servos, one channel each: 0 `from` .. 1 `to`.
    Servo {
        /// Names of joints, by default all of the robot.
        #[serde(default)]
        joints: Vec<String>,
        /// Drives all joints by one channel.
        #[serde(default)]
        together: bool,
        /// Position at 0 [rad or m], by default the lowest of the joint.
        #[schemars(range(min = -1e6, max = 1e6))]
        from: Option<f64>,
        /// Position at 1 [rad or m], by default the highest of the joint.
        #[schemars(range(min = -1e6, max = 1e6))]
        to: Option<f64>,
        /// Stiffness of the servo [N m/rad or N/m], by default that of the model's own servo.
        #[schemars(range(min = 1e-9, max = 1e9))]
        stiffness: Option<f64>,
        /// Damping of the servo [N m s/rad or N s/m].
        #[schemars(range(min = 0.0, max = 1e9))]
        damping: Option<f64>,
        /// Largest effort of the servo [N m or N].
        #[schemars(range(min = 1e-9, max = 1e9))]
        limit: Option<f64>,
    },
    /// Two muscles on each joint, one channel each: 0 slack .. 1 full tension.
    Muscles {
        /// Names of joints, by default all of the robot.
        #[serde(default)]
        joints: Vec<String>,
        /// Largest tension [N], by default that of the robot's own muscles.
        #[schemars(range(min = 1e-6, max = 1e9))]
        tension: Option<f64>,
        /// Lever arm of the tension about the joint [m].
        #[schemars(range(min = 1e-6, max = 1e3))]
        moment_arm: Option<f64>,
    },
    /// A motor of the user's program, with its keys.
    #[serde(untagged)]
    #[schemars(skip)]
    Registered {
        /// Registered name.
        kind: String,
        /// Keys.
        #[serde(flatten)]
        keys: Map<String, Value>,
    },
}

/// An LED of a robot.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub enum Led {
    /// The red one.
    Red,
    /// The green one.
    Green,
    /// The blue one.
    Blue,
}
