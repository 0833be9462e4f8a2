//! The robots.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// A robot on two wheels; what is not given is the named robot's own.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct Robot {
    /// Which one.
    pub kind: RobotKind,
    /// How many there are, all alike and with one genome.
    #[serde(default = "one")]
    #[schemars(range(min = 1, max = 1000))]
    pub count: u32,
    /// Radius of the hull [m].
    #[serde(default, skip_serializing_if = "Option::is_none")]
    #[schemars(range(min = 0.001, max = 10.0))]
    pub radius: Option<f64>,
    /// The fastest that it drives [m/s].
    #[serde(default, skip_serializing_if = "Option::is_none")]
    #[schemars(range(min = 0.0001, max = 10.0))]
    pub speed: Option<f64>,
    /// How far its infrared sensors see from the hull [m].
    #[serde(default, skip_serializing_if = "Option::is_none")]
    #[schemars(range(min = 0.001, max = 10.0))]
    pub infrared_range: Option<f64>,
}

fn one() -> u32 {
    1
}

/// The robots that FARSA knows.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub enum RobotKind {
    /// 35 mm, eight infrared sensors.
    Khepera,
    /// 35 mm, eight infrared sensors, three of the ground, LEDs, a signal.
    EPuck,
    /// 85 mm, 24 infrared sensors, twelve of the ground, LEDs, a signal, an attachment device.
    Marxbot,
}
