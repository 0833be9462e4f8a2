//! Errors in the configuration of the iCub.

use alloc::string::String;
use core::fmt;

use crate::robot::validation::RobotError;

/// An error in the configuration of the iCub, or an unknown name.
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
pub enum IcubError {
    /// There is no chain with this name.
    Chain {
        /// Requested name.
        name: String,
    },
    /// A chain occurs twice in the list of actuated chains.
    Twice {
        /// Name of the chain.
        chain: &'static str,
    },
    /// There is no joint with this name.
    Joint {
        /// Requested name.
        name: String,
    },
    /// The joint is rigid, because its chain is not actuated.
    Locked {
        /// Name of the joint.
        joint: String,
        /// Name of the chain.
        chain: &'static str,
    },
    /// An angle of the posture is NaN or violates the limits of the joint.
    Posture {
        /// Name of the joint.
        joint: String,
        /// Invalid angle [rad].
        angle: f64,
        /// Limits of the joint [rad].
        range: [f64; 2],
    },
    /// A number is not finite or out of its range.
    Value {
        /// Name of the field.
        field: &'static str,
        /// Invalid value.
        value: f64,
    },
    /// The description that results from the configuration is invalid.
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
