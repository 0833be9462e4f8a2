//! Why a world of rapier cannot be built.

use alloc::string::String;
use core::fmt;

use farsa_body::RobotError;

use crate::model::ModelError;

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
}

impl From<ModelError> for RapierError {
    fn from(e: ModelError) -> Self {
        Self::Model(e)
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
            Self::MovingPlane { collider } => write!(f, "collider {collider}: a plane does not move"),
        }
    }
}

impl core::error::Error for RapierError {}
