//! Robots.

use std::borrow::Cow;

use schemars::{JsonSchema, Schema, SchemaGenerator, json_schema};
use serde::{Deserialize, Serialize};

use crate::name::NAME;

/// A robot on two wheels or with joints. Defaults are those of the named robot.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct Robot {
    /// The kind of robot.
    pub kind: RobotKind,
    /// Number of robots, all equal and with one genome.
    #[serde(default = "one")]
    #[schemars(range(min = 1, max = 1000))]
    pub count: u32,
    /// Radius of the hull [m].
    #[schemars(range(min = 0.001, max = 10.0))]
    pub radius: Option<f64>,
    /// Greatest speed [m/s].
    #[schemars(range(min = 0.0001, max = 10.0))]
    pub speed: Option<f64>,
    /// Range of the infrared sensors, from the hull [m].
    #[schemars(range(min = 0.001, max = 10.0))]
    pub infrared_range: Option<f64>,
    /// The URDF or MJCF file of a `model`, in the folder of the experiment's file or below it.
    pub file: Option<String>,
    /// Lets the first link of a URDF move freely instead of fixing it to the world.
    #[serde(default)]
    pub floating: bool,
    /// Origin of a robot with joints [m].
    #[serde(default)]
    #[schemars(inner(range(min = -1000.0, max = 1000.0)))]
    pub base: [f64; 3],
}

/// A group of equal robots.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct RobotGroup {
    /// Name for other parts of the file, and of the population if groups evolve separately.
    #[schemars(regex(pattern = NAME))]
    pub name: String,
    /// Color of the hulls for cameras: red, green and blue.
    #[schemars(inner(range(min = 0.0, max = 1.0)))]
    pub color: Option<[f64; 3]>,
    /// The robots of the group.
    #[serde(flatten)]
    pub robot: Robot,
}

/// Assignment of genomes to robots.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(default)]
pub struct Team {
    /// Evolves each group of `robots` as a separate population. Otherwise all robots have one genome.
    pub coevolution: bool,
    /// Gives the individuals of the same number in each population the same starts.
    #[serde(skip_serializing_if = "std::ops::Not::not")]
    pub common_starts: bool,
}

fn one() -> u32 {
    1
}

/// Name of a registered robot.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(from = "String", into = "String")]
pub struct RobotKind {
    /// Registered name.
    pub name: String,
    /// True for joints instead of wheels.
    pub(crate) joints: bool,
}

impl From<String> for RobotKind {
    fn from(name: String) -> Self {
        Self { name, joints: false }
    }
}

impl From<RobotKind> for String {
    fn from(robot: RobotKind) -> Self {
        robot.name
    }
}

impl JsonSchema for RobotKind {
    fn schema_name() -> Cow<'static, str> {
        "RobotKind".into()
    }

    /// The registry adds the names.
    fn json_schema(_: &mut SchemaGenerator) -> Schema {
        json_schema!({ "description": "Robots of FARSA.", "oneOf": [] })
    }
}
