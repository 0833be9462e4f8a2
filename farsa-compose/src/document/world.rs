//! The world and what stands in it.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use crate::name::NAME;

/// A plane, usually with walls around it; or space, usually with a floor.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(default)]
pub struct World {
    /// What moves the robots.
    pub engine: Engine,
    /// Width and depth of the arena, whose lower left corner is the origin [m]; for robots on wheels.
    #[schemars(inner(range(min = 0.05, max = 1000.0)))]
    pub size: [f64; 2],
    /// A file with more `objects`, in the folder of the experiment's file or below it.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub scene: Option<String>,
    /// Whether there are walls around it; for robots on wheels.
    pub walls: bool,
    /// Control step [s].
    #[schemars(range(min = 0.001, max = 0.2))]
    pub time_step: f64,
    /// Colour of the ground where no area is: red, green and blue.
    #[schemars(inner(range(min = 0.0, max = 1.0)))]
    pub ground: [f64; 3],
    /// Whether there is a floor at height 0; for robots with joints.
    pub floor: bool,
    /// Gravity [m/s2]; for robots with joints.
    #[schemars(inner(range(min = -1000.0, max = 1000.0)))]
    pub gravity: [f64; 3],
    /// Steps of the dynamics in a control step; for robots with joints.
    #[schemars(range(min = 1, max = 1000))]
    pub substeps: u32,
    /// Height of the horizontal plane that cameras see [m]; for robots with joints.
    #[schemars(range(min = -1000.0, max = 1000.0))]
    pub sight_height: f64,
    /// How hard things and the floor are [N/m]; for robots with joints.
    #[schemars(range(min = 1.0, max = 1e9))]
    pub stiffness: f64,
    /// Friction of the robot with things and with the floor; for robots with joints.
    #[schemars(range(min = 0.0, max = 10.0))]
    pub friction: f64,
}

impl Default for World {
    fn default() -> Self {
        Self {
            engine: Engine::Arena,
            size: [1.0, 1.0],
            scene: None,
            walls: true,
            time_step: 0.05,
            ground: [1.0; 3],
            floor: true,
            gravity: [0.0, 0.0, -9.81],
            substeps: 10,
            sight_height: 0.0,
            stiffness: 1e4,
            friction: 1.0,
        }
    }
}

/// What moves the robots.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub enum Engine {
    /// The kinematic plane: wheels turn as they are told, a robot that would run into something stays where it was.
    #[default]
    Arena,
    /// rapier: robots are rigid bodies, on driven wheels or with joints, and blocks can be pushed. It has no lanes.
    Rapier,
    /// The articulated world: robots with joints, and things that can be pushed.
    Articulated,
}

/// A thing in the world.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct Object {
    /// What other parts of the file call it.
    #[schemars(regex(pattern = NAME))]
    pub name: String,
    /// Where its middle is at first: x and y, and z beside a robot with joints [m]; by default a trial has to place it.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    #[schemars(length(min = 2, max = 3), inner(range(min = -1000.0, max = 1000.0)))]
    pub at: Option<Vec<f64>>,
    /// Where its length points to, counter-clockwise from the x axis [deg].
    #[serde(default)]
    #[schemars(range(min = -360.0, max = 360.0))]
    pub heading: f64,
    /// What it is.
    #[serde(flatten)]
    pub kind: ObjectKind,
}

impl Object {
    /// Whether it is a lamp, which is seen beyond walls, too.
    pub(crate) fn shines(&self) -> bool {
        matches!(self.kind, ObjectKind::Cylinder { lamp, .. } if lamp > 0.0)
    }
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
    /// A box that robots can push; not in the engine `arena`.
    Block {
        /// Length, breadth and height [m].
        #[schemars(inner(range(min = 0.001, max = 100.0)))]
        size: [f64; 3],
        /// Mass [kg].
        #[schemars(range(min = 0.0001, max = 10000.0))]
        mass: f64,
        /// Coefficient of friction with the ground and with what is smoother.
        #[serde(default = "half")]
        #[schemars(range(min = 0.0, max = 10.0))]
        friction: f64,
        /// Red, green and blue.
        #[serde(default = "grey")]
        #[schemars(inner(range(min = 0.0, max = 1.0)))]
        color: [f64; 3],
    },
    /// A ball that robots can push; beside a robot with joints.
    Ball {
        /// Radius [m].
        #[schemars(range(min = 0.0001, max = 100.0))]
        radius: f64,
        /// Mass [kg].
        #[schemars(range(min = 0.0001, max = 10000.0))]
        mass: f64,
        /// Coefficient of friction with the floor and with other things.
        #[serde(default = "half")]
        #[schemars(range(min = 0.0, max = 10.0))]
        friction: f64,
        /// Red, green and blue.
        #[serde(default = "grey")]
        #[schemars(inner(range(min = 0.0, max = 1.0)))]
        color: [f64; 3],
    },
    /// A place that can be seen and reached and touches nothing; beside a robot with joints.
    Marker {
        /// Radius of the ball that is drawn there [m].
        #[serde(default = "small")]
        #[schemars(range(min = 0.0001, max = 100.0))]
        radius: f64,
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

fn half() -> f64 {
    0.5
}

fn small() -> f64 {
    0.02
}

fn height() -> f64 {
    0.1
}

fn grey() -> [f64; 3] {
    [0.5; 3]
}
