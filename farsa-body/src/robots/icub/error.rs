//! Errors of the robot's configuration or of a requested name.

use alloc::string::String;
use core::fmt;

use crate::robot::validation::RobotError;

/// The error of the iCub's configuration or of a requested name.
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
pub enum IcubError {
    /// No chain has this name.
    Chain {
        /// The name.
        name: String,
    },
    /// A chain is listed twice among those that are actuated.
    Twice {
        /// Its name.
        chain: &'static str,
    },
    /// No joint has this name.
    Joint {
        /// The name.
        name: String,
    },
    /// The joint is rigid, because its chain is not actuated.
    Locked {
        /// The joint's name.
        joint: String,
        /// The name of its chain.
        chain: &'static str,
    },
    /// An angle of the posture is not a number within the joint's limits.
    Posture {
        /// The joint's name.
        joint: String,
        /// The angle [rad].
        angle: f64,
        /// The joint's limits [rad].
        range: [f64; 2],
    },
    /// A number is not finite or out of its range.
    Value {
        /// Which field.
        field: &'static str,
        /// Its value.
        value: f64,
    },
    /// An error of the description from these numbers.
    Robot(RobotError),
}

impl From<RobotError> for IcubError {
    fn from(error: RobotError) -> Self {
        Self::Robot(error)
    }
}

impl fmt::Display for IcubError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Chain { name } => {
                let chains = "torso, neck, left-arm, right-arm, left-hand, right-hand";
                write!(f, "no chain is called {name}: there are {chains}")
            }
            Self::Twice { chain } => write!(f, "the chain {chain} is listed twice"),
            Self::Joint { name } => write!(
                f,
                "no joint is called {name}: there are torso_pitch, torso_roll, torso_yaw, neck_pitch, neck_roll, \
                 neck_yaw, and with l_ or r_ before it shoulder_pitch, shoulder_roll, shoulder_yaw, elbow, \
                 wrist_prosup, wrist_pitch, wrist_yaw, J8 to J27"
            ),
            Self::Locked { joint, chain } => write!(f, "joint {joint} is rigid: the chain {chain} is not actuated"),
            Self::Posture { joint, angle, range: [low, high] } => {
                write!(f, "joint {joint}: the posture's angle {angle} is not between {low} and {high}")
            }
            Self::Value { field, value } => write!(f, "{field} is {value}"),
            Self::Robot(error) => error.fmt(f),
        }
    }
}

impl core::error::Error for IcubError {}
