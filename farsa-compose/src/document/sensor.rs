//! Sensors.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use crate::document::registered::{SensorKind, Wrapper};
use crate::document::yes;
use crate::name::NAME;

/// A sensor of each robot.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct Sensor {
    /// Name for settings, drawings and recordings, by default the kind.
    #[schemars(regex(pattern = NAME))]
    pub name: Option<String>,
    /// Names of the channels, in the order of the network's inputs, by default the name with a number.
    pub channels: Option<Vec<String>>,
    /// Enables the sensor. The network has no inputs for a disabled one.
    #[serde(default = "yes")]
    pub enabled: bool,
    /// Wrappers of the values, of which the first is applied first.
    #[serde(default)]
    #[schemars(length(max = 32))]
    pub wrappers: Vec<Wrapper>,
    /// The kind of sensor.
    #[serde(flatten)]
    pub kind: SensorKind,
}
