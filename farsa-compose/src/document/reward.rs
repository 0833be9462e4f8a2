//! What a trial earns, and when it has succeeded.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use crate::name::NAME;

/// A term of the fitness.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct Reward {
    /// What logs, tests and other terms call it; by default its kind.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    #[schemars(regex(pattern = NAME))]
    pub name: Option<String>,
    /// What it is multiplied by; below 0 it is a cost, with 0 it is measured and no part of the fitness.
    #[serde(default = "one")]
    #[schemars(range(min = -1e9, max = 1e9))]
    pub weight: f64,
    /// What of a trial's steps counts.
    #[serde(default)]
    pub over: Over,
    /// The robot that it is about, from 1; by default all of them.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    #[schemars(range(min = 1, max = 1000))]
    pub robot: Option<u32>,
    /// The group of `robots` that it is about; by default all of them, or those that evolve.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub of: Option<String>,
    /// The name of another term: only steps count in which that is more than 0.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub during: Option<String>,
    /// Two ends between which the value of a step is cut.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    #[schemars(inner(range(min = -1e9, max = 1e9)))]
    pub clip: Option<[f64; 2]>,
    /// What it is.
    #[serde(flatten)]
    pub kind: RewardKind,
}

/// The kinds of terms; what is measured of all robots is their mean.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(tag = "kind", rename_all = "kebab-case")]
pub enum RewardKind {
    /// 1 while the surfaces of robot and thing are less than this apart.
    Near {
        /// Which thing.
        object: String,
        /// How far at most [m].
        #[schemars(range(min = 0.0, max = 1000.0))]
        within: f64,
        /// Of which body of a robot with joints; by default its first.
        #[serde(default, skip_serializing_if = "Option::is_none")]
        body: Option<String>,
        /// Of which point of that body [m].
        #[serde(default)]
        #[schemars(inner(range(min = -1000.0, max = 1000.0)))]
        point: [f64; 3],
    },
    /// How far the robot's middle is from that of a thing [m].
    Distance {
        /// Which thing.
        object: String,
        /// Of which body of a robot with joints; by default its first.
        #[serde(default, skip_serializing_if = "Option::is_none")]
        body: Option<String>,
        /// Of which point of that body [m].
        #[serde(default)]
        #[schemars(inner(range(min = -1000.0, max = 1000.0)))]
        point: [f64; 3],
    },
    /// How much nearer to a thing the robot is than at the start [m].
    Approach {
        /// Which thing.
        object: String,
        /// Of which body of a robot with joints; by default its first.
        #[serde(default, skip_serializing_if = "Option::is_none")]
        body: Option<String>,
        /// Of which point of that body [m].
        #[serde(default)]
        #[schemars(inner(range(min = -1000.0, max = 1000.0)))]
        point: [f64; 3],
    },
    /// How far off its heading the robot sees a thing [rad].
    Angle {
        /// Which thing.
        object: String,
    },
    /// 1 while the robot touches something.
    Touch {
        /// Bodies of a robot with joints that count; none is all of them.
        #[serde(default)]
        bodies: Vec<String>,
        /// The only thing that counts, or `floor`, for a robot with joints.
        #[serde(default, skip_serializing_if = "Option::is_none")]
        with: Option<String>,
    },
    /// How far the robot is from where it started [m].
    Displacement {
        /// Of which body of a robot with joints; by default its first.
        #[serde(default, skip_serializing_if = "Option::is_none")]
        body: Option<String>,
    },
    /// How far a thing is from where it stood at the start [m].
    Moved {
        /// Which thing.
        object: String,
    },
    /// How fast the robot moves [m/s].
    Speed {
        /// Of which body of a robot with joints; by default its first.
        #[serde(default, skip_serializing_if = "Option::is_none")]
        body: Option<String>,
    },
    /// How far the robot came in this step along its heading [m].
    Forward {
        /// Of which body of a robot with joints; by default its first.
        #[serde(default, skip_serializing_if = "Option::is_none")]
        body: Option<String>,
    },
    /// How far the robot came in this step along a direction of the world [m].
    Progress {
        /// The direction, of any length.
        #[schemars(inner(range(min = -1.0, max = 1.0)))]
        along: [f64; 3],
        /// Of which body of a robot with joints; by default its first.
        #[serde(default, skip_serializing_if = "Option::is_none")]
        body: Option<String>,
    },
    /// Where a point of the robot is along a direction of the world, from its origin [m]: `[1.0, 0.0, 0.0]` for x.
    Position {
        /// The direction, of any length.
        #[schemars(inner(range(min = -1.0, max = 1.0)))]
        along: [f64; 3],
        /// Of which body of a robot with joints; by default its first.
        #[serde(default, skip_serializing_if = "Option::is_none")]
        body: Option<String>,
        /// Of which point of that body [m].
        #[serde(default)]
        #[schemars(inner(range(min = -1000.0, max = 1000.0)))]
        point: [f64; 3],
    },
    /// How high a point of the robot is [m].
    Height {
        /// Of which body of a robot with joints; by default its first.
        #[serde(default, skip_serializing_if = "Option::is_none")]
        body: Option<String>,
        /// Of which point of that body [m].
        #[serde(default)]
        #[schemars(inner(range(min = -1000.0, max = 1000.0)))]
        point: [f64; 3],
    },
    /// How upright a body is: 1 upright .. 0 lying .. -1 upside down.
    Upright {
        /// Of which body of a robot with joints; by default its first.
        #[serde(default, skip_serializing_if = "Option::is_none")]
        body: Option<String>,
    },
    /// How fast joints turn in the mean [rad/s or m/s].
    JointSpeed {
        /// Which, of a robot with joints; none is all.
        #[serde(default)]
        joints: Vec<String>,
    },
    /// How fast the wheels turn in the mean, as a share of the greatest speed: 0 to 1.
    WheelSpeed {},
    /// How much the wheels turn alike: 1 both alike .. 0 against each other.
    StraightOn {},
    /// The largest value of a sensor's channels.
    Sensor {
        /// Which sensor.
        sensor: String,
    },
    /// 1 while the robot's middle is in an area.
    InArea {
        /// Which disc or rectangle.
        area: String,
        /// Others that count as well.
        #[serde(default)]
        or: Vec<String>,
    },
    /// How near the other robots are: 1 at one place .. 0 at a mean distance of the arena's diagonal.
    NearOthers {},
    /// Pieces of food that the team has brought to its nest, by the rules of `foraging`.
    Food {},
    /// The robot's energy, 0 dead .. 1, by the rules of `foraging`.
    Energy {},
    /// 1 while the robot lives, by the rules of `foraging`.
    Alive {},
    /// 1 while the robot's attachment device holds something.
    Held {},
    /// The squares of the motors' values, of 0 to 1, in the mean.
    Effort {},
    /// How far the motors' values are from 1/2, as a share, squared and in the mean: 0 at rest .. 1.
    Control {},
    /// 1 in every step.
    Steps {},
}

/// What of a trial's steps counts.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub enum Over {
    /// The sum over the steps, divided by the most steps that a trial has.
    #[default]
    Mean,
    /// The sum over the steps.
    Sum,
    /// The value after the last step.
    End,
    /// The largest value of a step.
    Most,
}

/// How the terms become one number.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(default)]
pub struct Fitness {
    /// Whether the terms of a trial are multiplied instead of added.
    pub product: bool,
    /// How trials become one number.
    pub trials: Trials,
}

/// How trials become one number.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub enum Trials {
    /// By their mean.
    #[default]
    Mean,
    /// By their sum.
    Sum,
    /// By the worst of them.
    Worst,
}

/// A condition of success, on the last step's value of a term before its weight.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct Condition {
    /// The name of a term.
    pub term: String,
    /// It has to be more than this.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    #[schemars(range(min = -1e9, max = 1e9))]
    pub above: Option<f64>,
    /// It has to be less than this.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    #[schemars(range(min = -1e9, max = 1e9))]
    pub below: Option<f64>,
}

fn one() -> f64 {
    1.0
}
