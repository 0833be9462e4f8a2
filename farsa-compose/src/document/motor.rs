//! What robots do.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use crate::document::wrapper::Wrapper;
use crate::document::yes;
use crate::name::NAME;

/// Something that each robot does.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct Motor {
    /// What settings, drawings and recordings call it; by default its kind.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    #[schemars(regex(pattern = NAME))]
    pub name: Option<String>,
    /// Whether it is there; if not, the network has no outputs for it.
    #[serde(default = "yes")]
    pub enabled: bool,
    /// What happens to its values on their way, the last one first.
    #[serde(default)]
    #[schemars(length(max = 32))]
    pub wrappers: Vec<Wrapper>,
    /// What it is.
    #[serde(flatten)]
    pub kind: MotorKind,
}

/// The kinds of motors.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(tag = "kind", rename_all = "kebab-case")]
pub enum MotorKind {
    /// The left and the right wheel: 0 backwards .. 1/2 at rest .. 1 ahead.
    Wheels {},
    /// Speed, 0 backwards .. 1 ahead, and turn, 0 right .. 1/2 straight on .. 1 left.
    SpeedAndTurn {
        /// Whether it never drives backwards: a speed of 0 stands still.
        #[serde(default)]
        forwards: bool,
    },
    /// LEDs, 0 dark .. 1.
    Leds {
        /// Which.
        colors: Vec<Led>,
        /// Whether a robot without LEDs is taken, too: nothing shines then.
        #[serde(default)]
        optional: bool,
    },
    /// What it signals, 0 to 1.
    Signal {},
    /// The attachment device: above 1/2 it holds what is in front.
    Attachment {},
    /// Speeds of joints, a channel for each: 0 down .. 1/2 at rest .. 1 up.
    JointVelocity {
        /// Which; none is all of the robot.
        #[serde(default)]
        joints: Vec<String>,
        /// The fastest [rad/s or m/s].
        #[schemars(range(min = 1e-6, max = 1e6))]
        largest: f64,
        /// Torque for what is lacking of the speed [N m s/rad or N s/m]; by default that of the model's own motor.
        #[serde(default, skip_serializing_if = "Option::is_none")]
        #[schemars(range(min = 1e-9, max = 1e9))]
        gain: Option<f64>,
        /// The largest torque of a motor with this `gain` [N m or N]; by default there is none.
        #[serde(default, skip_serializing_if = "Option::is_none")]
        #[schemars(range(min = 1e-9, max = 1e9))]
        limit: Option<f64>,
    },
    /// Torques of joints, a channel for each: 0 down .. 1/2 none .. 1 up.
    JointTorque {
        /// Which; none is all of the robot.
        #[serde(default)]
        joints: Vec<String>,
        /// The largest [N m or N]; by default that of the model's own motor.
        #[serde(default, skip_serializing_if = "Option::is_none")]
        #[schemars(range(min = 1e-9, max = 1e9))]
        largest: Option<f64>,
    },
    /// Positions that servos turn joints to, a channel for each: 0 `from` .. 1 `to`.
    Servo {
        /// Which; none is all of the robot.
        #[serde(default)]
        joints: Vec<String>,
        /// Whether one channel turns all of them.
        #[serde(default)]
        together: bool,
        /// Position at 0 [rad or m]; by default the lowest that the joint allows.
        #[serde(default, skip_serializing_if = "Option::is_none")]
        #[schemars(range(min = -1e6, max = 1e6))]
        from: Option<f64>,
        /// Position at 1 [rad or m]; by default the highest that the joint allows.
        #[serde(default, skip_serializing_if = "Option::is_none")]
        #[schemars(range(min = -1e6, max = 1e6))]
        to: Option<f64>,
        /// Of the servo [N m/rad or N/m]; by default that of the model's own servo.
        #[serde(default, skip_serializing_if = "Option::is_none")]
        #[schemars(range(min = 1e-9, max = 1e9))]
        stiffness: Option<f64>,
        /// Of the servo [N m s/rad or N s/m].
        #[serde(default, skip_serializing_if = "Option::is_none")]
        #[schemars(range(min = 0.0, max = 1e9))]
        damping: Option<f64>,
        /// The largest effort of the servo [N m or N].
        #[serde(default, skip_serializing_if = "Option::is_none")]
        #[schemars(range(min = 1e-9, max = 1e9))]
        limit: Option<f64>,
    },
    /// Two muscles on each joint, a channel for each: 0 slack .. 1 as tense as can be.
    Muscles {
        /// Which joints; none is all of the robot.
        #[serde(default)]
        joints: Vec<String>,
        /// The largest tension [N]; by default those of the robot's own muscles.
        #[serde(default, skip_serializing_if = "Option::is_none")]
        #[schemars(range(min = 1e-6, max = 1e9))]
        tension: Option<f64>,
        /// Of the tension about the joint [m].
        #[serde(default, skip_serializing_if = "Option::is_none")]
        #[schemars(range(min = 1e-6, max = 1e3))]
        moment_arm: Option<f64>,
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
