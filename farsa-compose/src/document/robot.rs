//! The robots.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use crate::name::NAME;

/// A robot on two wheels or with joints; what is not given is the named robot's own.
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
    /// The URDF or MJCF file of a `model`, in the folder of the experiment's file or below it.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub file: Option<String>,
    /// Whether the first link of a URDF moves freely instead of standing in the world.
    #[serde(default)]
    pub floating: bool,
    /// Where the origin of a robot with joints is [m].
    #[serde(default)]
    #[schemars(inner(range(min = -1000.0, max = 1000.0)))]
    pub base: [f64; 3],
}

/// Robots that are alike.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct RobotGroup {
    /// What other parts of the file call them; if they evolve by themselves, their population.
    #[schemars(regex(pattern = NAME))]
    pub name: String,
    /// The colour of their hulls, as cameras see it: red, green and blue.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    #[schemars(inner(range(min = 0.0, max = 1.0)))]
    pub color: Option<[f64; 3]>,
    /// What they are.
    #[serde(flatten)]
    pub robot: Robot,
}

/// Whose genomes robots have.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(default)]
pub struct Team {
    /// Whether each group of `robots` evolves as a population of its own; else all robots have one genome.
    pub coevolution: bool,
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
    /// An arm of seven joints that muscles move, and a hand of twenty.
    ArmAndHand,
    /// One from a URDF or MJCF file.
    Model,
}

impl RobotKind {
    /// Whether it has joints instead of wheels in a plane.
    pub(crate) fn has_joints(self) -> bool {
        matches!(self, Self::ArmAndHand | Self::Model)
    }
}
