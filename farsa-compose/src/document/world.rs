//! The arena and what stands in it.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use crate::name::NAME;

/// A plane, usually with walls around it.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(default)]
pub struct World {
    /// What moves the robots.
    pub engine: Engine,
    /// Width and depth of the arena, from the origin on [m].
    #[schemars(inner(range(min = 0.05, max = 1000.0)))]
    pub size: [f64; 2],
    /// Whether there are walls around it.
    pub walls: bool,
    /// Control step [s].
    #[schemars(range(min = 0.001, max = 0.2))]
    pub time_step: f64,
    /// Colour of the ground where no area is: red, green and blue.
    #[schemars(inner(range(min = 0.0, max = 1.0)))]
    pub ground: [f64; 3],
}

impl Default for World {
    fn default() -> Self {
        Self { engine: Engine::Arena, size: [1.0, 1.0], walls: true, time_step: 0.05, ground: [1.0; 3] }
    }
}

/// What moves the robots.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub enum Engine {
    /// The kinematic plane: wheels turn as they are told, a robot that would run into something stays where it was.
    #[default]
    Arena,
}

/// A thing in the arena.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct Object {
    /// What other parts of the file call it.
    #[schemars(regex(pattern = NAME))]
    pub name: String,
    /// Where its middle is at first [m]; by default a trial has to place it.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    #[schemars(inner(range(min = -1000.0, max = 1000.0)))]
    pub at: Option<[f64; 2]>,
    /// Where its length points to, counter-clockwise from the x axis [deg].
    #[serde(default)]
    #[schemars(range(min = -360.0, max = 360.0))]
    pub heading: f64,
    /// What it is.
    #[serde(flatten)]
    pub kind: ObjectKind,
}

/// The kinds of things.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(tag = "kind", rename_all = "kebab-case")]
pub enum ObjectKind {
    /// A cylinder that stands on the ground, perhaps a lamp.
    Cylinder {
        /// Radius [m].
        #[schemars(range(min = 0.0001, max = 100.0))]
        radius: f64,
        /// Height [m].
        #[serde(default = "height")]
        #[schemars(range(min = 0.0001, max = 100.0))]
        height: f64,
        /// Red, green and blue.
        #[serde(default = "grey")]
        #[schemars(inner(range(min = 0.0, max = 1.0)))]
        color: [f64; 3],
        /// How strongly it shines; 0 is no lamp.
        #[serde(default)]
        #[schemars(range(min = 0.0, max = 1e6))]
        lamp: f64,
    },
    /// A box that nothing moves.
    Wall {
        /// Length and thickness [m].
        #[schemars(inner(range(min = 0.0001, max = 1000.0)))]
        size: [f64; 2],
        /// Height [m].
        #[serde(default = "height")]
        #[schemars(range(min = 0.0001, max = 100.0))]
        height: f64,
        /// Red, green and blue.
        #[serde(default = "grey")]
        #[schemars(inner(range(min = 0.0, max = 1.0)))]
        color: [f64; 3],
    },
    /// A disc of the ground in a colour of its own.
    Disc {
        /// Radius [m].
        #[schemars(range(min = 0.0001, max = 1000.0))]
        radius: f64,
        /// Red, green and blue.
        #[schemars(inner(range(min = 0.0, max = 1.0)))]
        color: [f64; 3],
    },
    /// A rectangle of the ground in a colour of its own.
    Rectangle {
        /// Length along the heading, and breadth [m].
        #[schemars(inner(range(min = 0.0001, max = 1000.0)))]
        size: [f64; 2],
        /// Red, green and blue.
        #[schemars(inner(range(min = 0.0, max = 1.0)))]
        color: [f64; 3],
    },
}

fn height() -> f64 {
    0.1
}

fn grey() -> [f64; 3] {
    [0.5; 3]
}
