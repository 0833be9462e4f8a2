//! Terms of the fitness, success and failure.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};
use serde_json::{Map, Value};

use crate::document::one;
use crate::name::NAME;

/// A term of the fitness.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct Reward {
    /// Name for logs, tests and other terms, by default the kind.
    #[schemars(regex(pattern = NAME))]
    pub name: Option<String>,
    /// Name in outcomes and recordings, by default `name`, in notes after the word "measured".
    pub label: Option<String>,
    /// Factor of the term. A negative one makes it a cost. With 0 it is only measured and not part of the fitness.
    #[serde(default = "one")]
    #[schemars(range(min = -1e9, max = 1e9))]
    pub weight: f64,
    /// Aggregation over the steps of a trial.
    #[serde(default)]
    pub over: Over,
    /// Number of the robot, from 1, by default all robots.
    #[schemars(range(min = 1, max = 1000))]
    pub robot: Option<u32>,
    /// Name of a group of `robots`, by default all robots, or those that evolve.
    pub of: Option<String>,
    /// Name of another term. Only steps with a positive value of that term count.
    pub during: Option<String>,
    /// Lower and upper limit of the value of a step.
    #[schemars(inner(range(min = -1e9, max = 1e9)))]
    pub clip: Option<[f64; 2]>,
    /// The kind of term.
    #[serde(flatten)]
    pub kind: RewardKind,
}

/// The kinds of terms. Terms of several robots are their mean.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(tag = "kind", rename_all = "kebab-case")]
pub enum RewardKind {
    /// Value of a formula of terms and channels.
    Formula {
        /// Formula, such as `1 - distance(lamp) / 0.3 m`.
        #[schemars(length(max = 2000))]
        formula: String,
    },
    /// 1 while the surfaces of robot and thing are closer than this.
    Near {
        /// Name of the thing.
        object: String,
        /// Greatest distance [m].
        #[schemars(range(min = 0.0, max = 1000.0))]
        within: f64,
        /// Body of a robot with joints, by default the first.
        body: Option<String>,
        /// Point of that body [m].
        #[serde(default)]
        #[schemars(inner(range(min = -1000.0, max = 1000.0)))]
        point: [f64; 3],
    },
    /// Distance between the centers of robot and thing [m].
    Distance {
        /// Name of the thing.
        object: String,
        /// Body of a robot with joints, by default the first.
        body: Option<String>,
        /// Point of that body [m].
        #[serde(default)]
        #[schemars(inner(range(min = -1000.0, max = 1000.0)))]
        point: [f64; 3],
    },
    /// Decrease of the distance to a thing since the start [m].
    Approach {
        /// Name of the thing.
        object: String,
        /// Body of a robot with joints, by default the first.
        body: Option<String>,
        /// Point of that body [m].
        #[serde(default)]
        #[schemars(inner(range(min = -1000.0, max = 1000.0)))]
        point: [f64; 3],
    },
    /// Angle between heading and thing [rad].
    Angle {
        /// Name of the thing.
        object: String,
    },
    /// 1 while the robot touches something.
    Touch {
        /// Bodies of a robot with joints, by default all of them.
        #[serde(default)]
        bodies: Vec<String>,
        /// The only thing that counts, or `floor`, for a robot with joints.
        with: Option<String>,
    },
    /// Distance of the robot from its start [m].
    Displacement {
        /// Body of a robot with joints, by default the first.
        body: Option<String>,
    },
    /// Distance of a thing from its start [m].
    Moved {
        /// Name of the thing.
        object: String,
    },
    /// Speed of the robot [m/s].
    Speed {
        /// Body of a robot with joints, by default the first.
        body: Option<String>,
    },
    /// Displacement in this step along the heading [m].
    Forward {
        /// Body of a robot with joints, by default the first.
        body: Option<String>,
    },
    /// Displacement in this step along a direction of the world [m].
    Progress {
        /// Direction, of any length.
        #[schemars(inner(range(min = -1.0, max = 1.0)))]
        along: [f64; 3],
        /// Body of a robot with joints, by default the first.
        body: Option<String>,
    },
    /// Position of a point of the robot along a direction of the world, from its origin [m]: `[1.0, 0.0, 0.0]` for x.
    Position {
        /// Direction, of any length.
        #[schemars(inner(range(min = -1.0, max = 1.0)))]
        along: [f64; 3],
        /// Body of a robot with joints, by default the first.
        body: Option<String>,
        /// Point of that body [m].
        #[serde(default)]
        #[schemars(inner(range(min = -1000.0, max = 1000.0)))]
        point: [f64; 3],
    },
    /// Height of a point of the robot [m].
    Height {
        /// Body of a robot with joints, by default the first.
        body: Option<String>,
        /// Point of that body [m].
        #[serde(default)]
        #[schemars(inner(range(min = -1000.0, max = 1000.0)))]
        point: [f64; 3],
    },
    /// Uprightness of a body: 1 upright .. 0 lying .. -1 upside down.
    Upright {
        /// Body of a robot with joints, by default the first.
        body: Option<String>,
    },
    /// Mean speed of joints [rad/s or m/s].
    JointSpeed {
        /// Names of joints of a robot with joints, by default all.
        #[serde(default)]
        joints: Vec<String>,
    },
    /// Position of a joint [rad or m].
    JointPosition {
        /// Name of a joint of a robot with joints.
        joint: String,
    },
    /// Speed of a joint with its sign [rad/s or m/s].
    JointVelocity {
        /// Name of a joint of a robot with joints.
        joint: String,
    },
    /// Mean speed of the wheels, as a share of the greatest speed: 0 to 1.
    WheelSpeed {},
    /// Difference of the wheel speeds, without its sign [rad/s].
    WheelDifference {},
    /// Similarity of the wheel speeds: 1 equal .. 0 opposite.
    StraightOn {},
    /// Largest value of a sensor's channels.
    Sensor {
        /// Name of the sensor.
        sensor: String,
    },
    /// 1 while the robot's center is in an area.
    InArea {
        /// Name of a disc or rectangle.
        area: String,
        /// Further areas.
        #[serde(default)]
        or: Vec<String>,
    },
    /// Share of the robots whose centers are in the same area, for the area with the most of them.
    FullestArea {
        /// Name of a disc or rectangle, or of several.
        area: String,
    },
    /// Number of robots whose centers are in an area.
    RobotsInArea {
        /// Name of a disc or rectangle, or of several.
        area: String,
    },
    /// Sum of the robots' squared distances from their centroid, in squared diameters of a robot.
    Dispersion {},
    /// Number of groups of robots without gaps that another robot fits into.
    Clusters {},
    /// Share of the robots in the largest of these groups.
    LargestCluster {},
    /// Proximity of the other robots: 1 at one place .. 0 at a mean distance of the arena's diagonal.
    NearOthers {},
    /// Pieces of food that the team has delivered to its nest, according to `foraging`.
    Food {},
    /// Pieces of food that the team carries, according to `foraging`.
    CarriedFood {},
    /// Pieces of food that the team lost with dead robots, according to `foraging`.
    LostFood {},
    /// Number of dead robots, according to `foraging`.
    Deaths {},
    /// Energy of the robot, 0 dead .. 1, according to `foraging`.
    Energy {},
    /// 1 while the robot is alive, according to `foraging`.
    Alive {},
    /// 1 while the robot's attachment device holds something.
    Held {},
    /// Mean square of the motor values, each from 0 to 1.
    Effort {},
    /// Mean square of the motor values' distance from 1/2, as a share: 0 at rest .. 1.
    Control {},
    /// 1 in every step.
    Steps {},
    /// Number of steps since the start.
    Step {},
    /// Time since the start [s].
    Time {},
    /// Distance between the hulls of robot and thing [m].
    Gap {
        /// Name of the thing.
        object: String,
    },
    /// 1 while robot and thing collide, or their hulls are at most this far apart.
    Contact {
        /// Name of the thing.
        object: String,
        /// Greatest distance [m].
        #[serde(default)]
        #[schemars(range(min = 0.0, max = 1000.0))]
        within: f64,
    },
    /// Share of the longest trial that is left.
    TimeLeft {
        /// Name of a group of robots for which it is the rest of 1 instead.
        rest: String,
    },
    /// A term of the user's program, with its keys.
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

impl RewardKind {
    /// Takes the name of the measured body, if any.
    pub(crate) fn take_body(&mut self) -> Option<String> {
        match self {
            Self::Near { body, .. }
            | Self::Distance { body, .. }
            | Self::Approach { body, .. }
            | Self::Displacement { body }
            | Self::Speed { body }
            | Self::Forward { body }
            | Self::Progress { body, .. }
            | Self::Position { body, .. } => body.take(),
            Self::Touch { bodies, .. } if bodies.len() == 1 => bodies.pop(),
            _ => None,
        }
    }
}

/// Aggregations over the steps of a trial.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub enum Over {
    /// Sum over the steps, divided by the greatest number of steps.
    #[default]
    Mean,
    /// Sum over the steps.
    Sum,
    /// Value after the last step.
    End,
    /// Largest value of a step.
    Most,
}

/// Combination of the terms into one number.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(default)]
pub struct Fitness {
    /// Multiplies the terms of a trial instead of adding them.
    pub product: bool,
    /// Combination of trials into one number.
    pub trials: Trials,
}

/// Combinations of trials into one number.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub enum Trials {
    /// Mean.
    #[default]
    Mean,
    /// Sum.
    Sum,
    /// Worst trial.
    Worst,
}

/// A condition: a formula, or limits on the last step's value of a term, before its weight.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct Condition {
    /// Formula, such as `time > 5 and near(lamp, 0.1) > 0 for 1 s`. Its quantities are means over the robots.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    #[schemars(length(max = 2000))]
    pub formula: Option<String>,
    /// Name of a term, unless there is a formula.
    pub term: Option<String>,
    /// Name of a group of robots. The condition is for trials in which it evolves, by default for all.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub of: Option<String>,
    /// Lower limit. The value must be greater.
    #[schemars(range(min = -1e9, max = 1e9))]
    pub above: Option<f64>,
    /// Upper limit. The value must be less.
    #[schemars(range(min = -1e9, max = 1e9))]
    pub below: Option<f64>,
}
