//! How a trial starts, goes on and ends.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// Steps and trials.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(default)]
pub struct Episode {
    /// Most steps of a trial.
    #[schemars(range(min = 1, max = 1_000_000))]
    pub steps: u32,
    /// Trials of an evaluation, each with a start of its own.
    #[schemars(range(min = 1, max = 100_000))]
    pub trials: u32,
    /// What ends a trial before its last step.
    pub ends: Vec<Ending>,
}

impl Default for Episode {
    fn default() -> Self {
        Self { steps: 500, trials: 5, ends: Vec::new() }
    }
}

/// What ends a trial.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub enum Ending {
    /// A robot runs into something.
    Collision,
    /// All conditions of success hold.
    Success,
    /// All robots are dead, by the rules of `foraging`.
    Death,
}

/// Where a trial puts something.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct Start {
    /// A thing by its name; `robot` for all robots one after the other, `robot-1`, `robot-2` for one of them, or a group of them; a joint.
    pub place: String,
    /// How.
    #[serde(flatten)]
    pub how: Placing,
}

/// How something is put somewhere; robots have a heading drawn uniformly after their place.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(tag = "at", rename_all = "kebab-case")]
pub enum Placing {
    /// Uniformly where there is room.
    Anywhere {
        /// Least distance from the walls [m].
        #[serde(default)]
        #[schemars(range(min = 0.0, max = 1000.0))]
        walls: f64,
        /// Least distance from all that was placed before [m]; of areas from other areas.
        #[serde(default)]
        #[schemars(range(min = 0.0, max = 1000.0))]
        apart: f64,
    },
    /// Uniformly near a thing, where there is room.
    Near {
        /// Which thing.
        of: String,
        /// Greatest distance of the middles [m].
        #[schemars(range(min = 0.0, max = 1000.0))]
        within: f64,
        /// Least distance from the walls [m].
        #[serde(default)]
        #[schemars(range(min = 0.0, max = 1000.0))]
        walls: f64,
        /// Least distance from all that was placed before [m].
        #[serde(default)]
        #[schemars(range(min = 0.0, max = 1000.0))]
        apart: f64,
    },
    /// In any direction from a thing, its middle from that of the thing at a distance drawn uniformly.
    Around {
        /// Which thing.
        of: String,
        /// The least and the greatest distance [m].
        #[schemars(inner(range(min = 0.0, max = 1000.0)))]
        distance: [f64; 2],
    },
    /// Uniformly in a box; beside a robot with joints.
    InBox {
        /// The least x, y and z [m].
        #[schemars(inner(range(min = -1000.0, max = 1000.0)))]
        low: [f64; 3],
        /// The greatest x, y and z [m].
        #[schemars(inner(range(min = -1000.0, max = 1000.0)))]
        high: [f64; 3],
        /// Least distance from the things that were placed before [m].
        #[serde(default)]
        #[schemars(range(min = 0.0, max = 1000.0))]
        apart: f64,
    },
    /// On one of these points, drawn from those that are free of the things that were placed before.
    OneOf {
        /// x and y of each, and z beside a robot with joints [m].
        #[schemars(length(min = 1, max = 100))]
        points: Vec<Vec<f64>>,
        /// What was placed `one-of` as many points before: the point of the same number is taken, free or not; of several
        /// robots, that of the last.
        #[serde(default, skip_serializing_if = "Option::is_none")]
        like: Option<String>,
    },
    /// A joint at a position drawn uniformly.
    Turned {
        /// The least position [rad or m].
        #[schemars(range(min = -1e6, max = 1e6))]
        low: f64,
        /// The greatest position [rad or m].
        #[schemars(range(min = -1e6, max = 1e6))]
        high: f64,
    },
    /// Always there; a robot with this heading.
    Fixed {
        /// Where its middle is: x and y, and z beside a robot with joints [m].
        #[schemars(length(min = 2, max = 3), inner(range(min = -1000.0, max = 1000.0)))]
        point: Vec<f64>,
        /// Where it looks to, counter-clockwise from the x axis [deg].
        #[serde(default)]
        #[schemars(range(min = -360.0, max = 360.0))]
        heading: f64,
    },
}
