//! Why a world of rapier cannot be built.

use alloc::string::String;
use core::fmt;

use farsa_body::robot::RobotError;

use crate::arena::error::ArenaError;
use crate::articulated::model::ModelError;

/// Why a world of rapier cannot be built.
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
pub enum RapierError {
    /// The robot's description is not valid, a joint moves no mass, or there are too many parts.
    Model(ModelError),
    /// An option is out of its range.
    Option {
        /// Its name.
        name: &'static str,
        /// Its value.
        value: f64,
        /// The lowest and highest value.
        range: [f64; 2],
    },
    /// A plane on a body that moves; planes are ground.
    MovingPlane {
        /// The collider's name.
        collider: String,
    },
    /// Ground below a body that slides; rapier has no friction in a joint.
    Ground {
        /// The body's name.
        body: String,
    },
    /// A number of an object is NaN, infinite or out of its range.
    SceneObject {
        /// The object's name.
        name: String,
        /// Which number.
        field: &'static str,
        /// Its value.
        value: f64,
    },
    /// An object with a mass whose geometry does not move.
    Immovable {
        /// The object's name.
        name: String,
        /// Its geometry.
        geometry: &'static str,
    },
    /// A triangle of a vertex that the mesh does not have.
    Triangle {
        /// The object's name.
        name: String,
        /// The triangle's number.
        triangle: usize,
        /// The vertex's number.
        vertex: u32,
        /// How many vertices there are.
        count: usize,
    },
    /// A height field that has not as many heights as rows times columns, or fewer than two of either.
    Grid {
        /// The object's name.
        name: String,
        /// Number of rows and columns.
        size: [usize; 2],
        /// Number of heights.
        heights: usize,
    },
    /// Points or triangles that rapier makes nothing of.
    Unusable {
        /// The object's name.
        name: String,
        /// Why.
        why: String,
    },
    /// The arena is none.
    Arena(ArenaError),
    /// There are not as many chassis as robots.
    Chassis {
        /// Number of robots.
        robots: usize,
        /// Number of chassis.
        chassis: usize,
    },
    /// A robot with an attachment device, of which this world has none.
    Attachment {
        /// The robot's number.
        robot: usize,
    },
    /// A number of a robot as a rigid body, or of a block, is out of its range.
    Part {
        /// `robot` or `block`.
        part: &'static str,
        /// Its number.
        number: usize,
        /// Which number of it.
        field: &'static str,
        /// Its value.
        value: f64,
        /// The lowest and highest value.
        range: [f64; 2],
    },
    /// A block overlaps something where it starts, which would push it away.
    BlockOverlap {
        /// The block's number.
        block: usize,
        /// How deep it lies in it [m].
        depth: f64,
    },
}

impl From<ModelError> for RapierError {
    fn from(e: ModelError) -> Self {
        Self::Model(e)
    }
}

impl From<ArenaError> for RapierError {
    fn from(e: ArenaError) -> Self {
        Self::Arena(e)
    }
}

impl From<RobotError> for RapierError {
    fn from(e: RobotError) -> Self {
        Self::Model(e.into())
    }
}

impl fmt::Display for RapierError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Model(e) => e.fmt(f),
            Self::Option { name, value, range: [low, high] } => {
                let nearest = if *value > *high { high } else { low };
                write!(f, "option {name} is {value}, not from {low} to {high}; the nearest is {nearest}")
            }
            Self::Ground { body } => write!(f, "body {body}: nothing rubs on the ground that it slides on here"),
            Self::MovingPlane { collider } => write!(f, "collider {collider}: a plane does not move"),
            Self::SceneObject { name, field, value } => write!(f, "object {name}: {field} is {value}"),
            Self::Immovable { name, geometry } => {
                write!(f, "object {name}: a {geometry} does not move, so it has no mass")
            }
            Self::Triangle { name, triangle, vertex, count } => {
                let last = count.saturating_sub(1);
                write!(f, "object {name}: triangle {triangle} has vertex {vertex}; the last of {count} is {last}")
            }
            Self::Grid { name, size: [rows, columns], heights } => {
                write!(
                    f,
                    "object {name}: {heights} heights for {rows} rows of {columns}, of which there are at least two"
                )
            }
            Self::Unusable { name, why } => write!(f, "object {name}: {why}"),
            Self::Arena(e) => e.fmt(f),
            Self::Chassis { robots, chassis } => write!(f, "{chassis} chassis for {robots} robots: one for each"),
            Self::Attachment { robot } => {
                write!(f, "robot {robot} has an attachment device, which holds nothing in rapier: take it off (`None`)")
            }
            Self::Part { part, number, field, value, range: [low, high] } => {
                let nearest = if *value > *high { high } else { low };
                write!(f, "{field} of {part} {number} is {value}, not from {low} to {high}; the nearest is {nearest}")
            }
            Self::BlockOverlap { block, depth } => write!(f, "block {block} starts {depth:.6} m deep in something"),
        }
    }
}

impl core::error::Error for RapierError {}
