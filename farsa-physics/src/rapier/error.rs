//! Errors of worlds in rapier.

use alloc::string::String;
use core::fmt;

use farsa_body::robot::RobotError;

use crate::arena::error::ArenaError;
use crate::articulated::model::ModelError;

/// An error that occurs if a world of rapier cannot be built.
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
pub enum RapierError {
    /// The robot's description is not valid, a joint moves no mass, or there are too many parts.
    Model(ModelError),
    /// An option is out of its allowed range.
    Option {
        /// Name of the option.
        name: &'static str,
        /// Value that was given.
        value: f64,
        /// Lowest and highest value that is allowed.
        range: [f64; 2],
    },
    /// A part that rapier cannot simulate: a moving plane, friction on the ground below a sliding body, or an attachment device.
    Unsupported {
        /// Name of the part and the reason.
        why: String,
    },
    /// An object that has an invalid number, or a geometry from which rapier makes no collider.
    SceneObject {
        /// Name of the object.
        name: String,
        /// Message that explains the problem.
        why: String,
    },
    /// The arena is not valid.
    Arena(ArenaError),
    /// The number of chassis is different from the number of robots.
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
        /// Index of the robot or block.
        number: usize,
        /// Name of the number that is out of range.
        field: &'static str,
        /// Value that was given.
        value: f64,
        /// Lowest and highest value that is allowed.
        range: [f64; 2],
    },
    /// A block overlaps something where it starts, which would push it away.
    BlockOverlap {
        /// Index of the block.
        block: usize,
        /// Depth of the overlap [m].
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
