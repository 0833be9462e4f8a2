//! Axes of a vector.

use farsa_body::sensors::Axes;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// Axes of a vector.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub(super) enum AxesName {
    /// Axes of the robot.
    #[default]
    Body,
    /// Axes of the world.
    World,
}

impl From<AxesName> for Axes {
    fn from(name: AxesName) -> Self {
        match name {
            AxesName::Body => Self::Body,
            AxesName::World => Self::World,
        }
    }
}
