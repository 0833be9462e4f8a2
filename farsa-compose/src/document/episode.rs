//! Start and end of a trial.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};
use serde_json::{Map, Value};

/// Steps and trials.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(default)]
pub struct Episode {
    /// Most steps of a trial.
    #[schemars(range(min = 1, max = 1_000_000))]
    pub steps: u32,
    /// Trials of an evaluation, each with its own start.
    #[schemars(range(min = 1, max = 100_000))]
    pub trials: u32,
    /// Events that end a trial before its last step.
    pub ends: Vec<Ending>,
}

impl Default for Episode {
    fn default() -> Self {
        Self { steps: 500, trials: 5, ends: Vec::new() }
    }
}

/// An event that ends a trial.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub enum Ending {
    /// A robot collides with something.
    Collision,
    /// All conditions of success hold.
    Success,
    /// All robots are dead according to `foraging`.
    Death,
}

/// A placement at the start of a trial.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct Start {
    /// Name of a thing, a joint or a group of robots. `robot` places all robots in turn, and `robot-1` or `robot-2` a
    /// single one.
    pub place: String,
    /// The kind of placement.
    #[serde(flatten)]
    pub how: Placing,
}

/// Kinds of placements. The heading of a robot is drawn uniformly after its place.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(tag = "at", rename_all = "kebab-case")]
pub enum Placing {
    /// Uniformly in free space.
    Anywhere {
        /// Least distance from the walls [m].
        #[serde(default)]
        #[schemars(range(min = 0.0, max = 1000.0))]
        walls: f64,
        /// Least distance from everything placed earlier [m], for areas from other areas.
        #[serde(default)]
        #[schemars(range(min = 0.0, max = 1000.0))]
        apart: f64,
        /// Measures both distances from the centers of areas instead of their edges.
        #[serde(default, skip_serializing_if = "std::ops::Not::not")]
        centers: bool,
    },
    /// Uniformly in free space near a thing.
    Near {
        /// Name of the thing.
        of: String,
        /// Greatest distance between the centers [m].
        #[schemars(range(min = 0.0, max = 1000.0))]
        within: f64,
        /// Least distance from the walls [m].
        #[serde(default)]
        #[schemars(range(min = 0.0, max = 1000.0))]
        walls: f64,
        /// Least distance from everything placed earlier [m].
        #[serde(default)]
        #[schemars(range(min = 0.0, max = 1000.0))]
        apart: f64,
    },
    /// In a uniformly drawn direction from a thing, at a uniformly drawn distance between the centers.
    Around {
        /// Name of the thing.
        of: String,
        /// Least and greatest distance [m].
        #[schemars(inner(range(min = 0.0, max = 1000.0)))]
        distance: [f64; 2],
    },
    /// Uniformly in a box, for experiments with joints.
    InBox {
        /// Least x, y and z [m].
        #[schemars(inner(range(min = -1000.0, max = 1000.0)))]
        low: [f64; 3],
        /// Greatest x, y and z [m].
        #[schemars(inner(range(min = -1000.0, max = 1000.0)))]
        high: [f64; 3],
        /// Least distance from everything placed earlier [m].
        #[serde(default)]
        #[schemars(range(min = 0.0, max = 1000.0))]
        apart: f64,
    },
    /// On one of these points, drawn from those without an earlier thing.
    OneOf {
        /// x and y of each point, and z for experiments with joints [m].
        #[schemars(length(min = 1, max = 100))]
        points: Vec<Vec<f64>>,
        /// An earlier placement `one-of` the same number of points. The point of the same number is taken, even if it
        /// is occupied. For several robots it is the point of the last one.
        like: Option<String>,
    },
    /// A joint at a uniformly drawn position.
    Turned {
        /// Least position [rad or m].
        #[schemars(range(min = -1e6, max = 1e6))]
        low: f64,
        /// Greatest position [rad or m].
        #[schemars(range(min = -1e6, max = 1e6))]
        high: f64,
    },
    /// At a fixed point, and for robots with a fixed heading.
    Fixed {
        /// Center: x and y, and z for experiments with joints [m].
        #[schemars(length(min = 2, max = 3), inner(range(min = -1000.0, max = 1000.0)))]
        point: Vec<f64>,
        /// Heading, counter-clockwise from the x axis [deg].
        #[serde(default)]
        #[schemars(range(min = -360.0, max = 360.0))]
        heading: f64,
        /// Draws the heading instead.
        #[serde(default, skip_serializing_if = "std::ops::Not::not")]
        drawn_heading: bool,
    },
    /// A placement of the user's program, with its keys.
    #[serde(untagged)]
    #[schemars(skip)]
    Registered {
        /// Registered name.
        at: String,
        /// Keys.
        #[serde(flatten)]
        keys: Map<String, Value>,
    },
}
