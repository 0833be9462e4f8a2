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
    },
    /// What it signals, 0 to 1.
    Signal {},
    /// The attachment device: above 1/2 it holds what is in front.
    Attachment {},
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
