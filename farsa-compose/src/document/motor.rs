//! Motors.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use crate::document::registered::{MotorKind, Wrapper};
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
