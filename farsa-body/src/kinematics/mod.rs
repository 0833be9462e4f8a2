//! Kinematic computations that need a description of the robot but no world.
//!
//! | question | answer |
//! |---|---|
//! | where are the segments at these joint positions? | [`KinematicTree::poses`] |
//! | how does a point move with the joints? | [`KinematicTree::jacobian`] |
//! | which torques hold the robot against gravity? | [`KinematicTree::gravity_torques`] |
//! | which joint positions bring a body to a place? | [`InverseKinematics::solve`] with a [`Goal`] |

/// The goal of a posture: a point's position, a body's orientation.
pub(crate) mod goal;
/// Damped least squares within joint limits.
pub(crate) mod inverse_kinematics;
/// Forward kinematics, Jacobians and gravity torques.
pub(crate) mod tree;

pub use goal::{Goal, Orientation};
pub use inverse_kinematics::{InverseKinematics, InverseKinematicsError, Solution};
pub use tree::KinematicTree;
