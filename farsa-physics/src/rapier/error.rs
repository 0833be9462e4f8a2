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
    /// A part that rapier cannot simulate: a moving plane, friction on the ground below a sliding body, or an attachment device.
    Unsupported {
        /// The part and the reason.
        why: String,
    },
    /// An object that has an invalid number, or a geometry from which rapier makes no collider.
    SceneObject {
        /// The object's name.
        name: String,
        /// The fault.
        why: String,
    },
    /// A fault of the arena.
    Arena(ArenaError),
    /// There are not as many chassis as robots.
    Chassis {
        /// Number of robots.
        robots: usize,
        /// Number of chassis.
        chassis: usize,
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
        /// The depth of the overlap [m].
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
            Self::Unsupported { why } => f.write_str(why),
            Self::SceneObject { name, why } => write!(f, "object {name}: {why}"),
            Self::Arena(e) => e.fmt(f),
            Self::Chassis { robots, chassis } => write!(f, "{chassis} chassis for {robots} robots: one for each"),
            Self::Part { part, number, field, value, range: [low, high] } => {
                let nearest = if *value > *high { high } else { low };
                write!(f, "{field} of {part} {number} is {value}, not from {low} to {high}; the nearest is {nearest}")
            }
            Self::BlockOverlap { block, depth } => write!(f, "block {block} starts {depth:.6} m deep in something"),
        }
    }
}

impl core::error::Error for RapierError {}
