//! The world and its objects.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use crate::document::registered::ObjectKind;
use crate::name::NAME;

/// A plane, usually with walls around it, or space, usually with a floor.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(default)]
pub struct World {
    /// Engine that moves the robots.
    pub engine: Engine,
    /// Width and depth of the arena, whose lower left corner is the origin [m], for robots on wheels.
    #[schemars(inner(range(min = 0.05, max = 1000.0)))]
    pub size: [f64; 2],
    /// A file with more `objects`, in the folder of the experiment's file or below it.
    // Without this the schema has a default of null, because the table has a default as a whole.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub scene: Option<String>,
    /// Surrounds the arena with walls, for robots on wheels.
    pub walls: bool,
    /// Rule for robots on wheels that collide in the engine `arena`, by default `undone`.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub collisions: Option<Collisions>,
    /// Control step [s].
    #[schemars(range(min = 0.001, max = 0.2))]
    pub time_step: f64,
    /// Color of the ground outside areas: red, green and blue.
    #[schemars(inner(range(min = 0.0, max = 1.0)))]
    pub ground: [f64; 3],
    /// Adds a floor at height 0, for robots with joints.
    pub floor: bool,
    /// Gravity [m/s2], for robots with joints.
    #[schemars(inner(range(min = -1000.0, max = 1000.0)))]
    pub gravity: [f64; 3],
    /// Steps of the dynamics in a control step, for robots with joints.
    #[schemars(range(min = 1, max = 1000))]
    pub substeps: u32,
    /// Height of the horizontal plane that cameras see [m], for robots with joints.
    #[schemars(range(min = -1000.0, max = 1000.0))]
    pub sight_height: f64,
    /// Stiffness of things and of the floor [N/m], for robots with joints.
    #[schemars(range(min = 1.0, max = 1e9))]
    pub stiffness: f64,
    /// Friction of the robot with things and with the floor, for robots with joints.
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
            collisions: None,
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

/// Rules for robots that collide.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub enum Collisions {
    /// Robots slide along obstacles.
    Circles,
    /// Robots stay in place.
    Undone,
}

/// Engines that move robots.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub enum Engine {
    /// The kinematic plane. Wheels turn at their commanded speed. A robot that would collide stays in place.
    #[default]
    Arena,
    /// rapier: robots are rigid bodies, on driven wheels or with joints, and blocks can be pushed. It has no lanes.
    Rapier,
    /// The articulated world: robots with joints, and movable things.
    Articulated,
}

/// A thing in the world.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct Object {
    /// Name for other parts of the file.
    #[schemars(regex(pattern = NAME))]
    pub name: String,
    /// Initial center: x and y, and z for experiments with joints [m], by default a trial has to place it.
    #[schemars(length(min = 2, max = 3), inner(range(min = -1000.0, max = 1000.0)))]
    pub at: Option<Vec<f64>>,
    /// Number of equal things of this name, each placed in turn, for robots on wheels.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    #[schemars(range(min = 1, max = 100))]
    pub count: Option<u32>,
    /// Direction of the length, counter-clockwise from the x axis [deg].
    #[serde(default)]
    #[schemars(range(min = -360.0, max = 360.0))]
    pub heading: f64,
    /// The kind of thing.
    #[serde(flatten)]
    pub kind: ObjectKind,
    /// Shape that the kind gives it.
    #[serde(skip)]
    #[schemars(skip)]
    pub shape: Option<Shape>,
}

impl Object {
    /// Returns true for lamps, which are visible beyond walls.
    pub(crate) fn shines(&self) -> bool {
        matches!(self.shape, Some(Shape::Cylinder { lamp, .. }) if lamp > 0.0)
    }
}

/// Shapes of which things consist.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Shape {
    /// An upright cylinder, which is a lamp with a light intensity above 0.
    Cylinder {
        /// Radius \[m\].
        radius: f64,
        /// Height \[m\].
        height: f64,
        /// Red, green and blue.
        color: [f64; 3],
        /// Light intensity.
        lamp: f64,
    },
    /// A fixed box.
    Wall {
        /// Length and thickness \[m\].
        size: [f64; 2],
        /// Height \[m\].
        height: f64,
        /// Red, green and blue.
        color: [f64; 3],
    },
    /// A movable box.
    Block {
        /// Length, breadth and height \[m\].
        size: [f64; 3],
        /// Mass \[kg\].
        mass: f64,
        /// Coefficient of friction.
        friction: f64,
        /// Red, green and blue.
        color: [f64; 3],
    },
    /// A movable ball.
    Ball {
        /// Radius \[m\].
        radius: f64,
        /// Mass \[kg\].
        mass: f64,
        /// Coefficient of friction.
        friction: f64,
        /// Red, green and blue.
        color: [f64; 3],
    },
    /// A visible place without contacts.
    Marker {
        /// Radius of the drawn ball \[m\].
        radius: f64,
        /// Red, green and blue.
        color: [f64; 3],
    },
    /// A disc of the ground.
    Disc {
        /// Radius \[m\].
        radius: f64,
        /// Red, green and blue.
        color: [f64; 3],
    },
    /// A rectangle of the ground.
    Rectangle {
        /// Length along the heading, and breadth \[m\].
        size: [f64; 2],
        /// Red, green and blue.
        color: [f64; 3],
    },
}
