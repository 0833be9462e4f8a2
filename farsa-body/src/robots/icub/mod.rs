//! The upper body of the iCub [Metta2010] with 60 joints in six chains.
//!
//! The values are taken from a URDF file [Gepetto2025], and the hands from [`crate::robots::ArmAndHand`]. The masses
//! and limits are compared with the file in docs/icub-tables.md. This page also lists Denavit-Hartenberg parameters.

/// The six chains, the two sides, and which joints and bodies are theirs.
pub(crate) mod chain;
/// Colliders, and the pairs of them that may touch.
mod colliders;
/// The robot with its fields, and how it is put together.
pub(crate) mod description;
/// The error of its configuration.
pub(crate) mod error;
/// The shapes that views draw.
mod look;
/// The joint angles of all chains.
pub(crate) mod posture;
/// Joints and masses of torso, neck and right arm, as the file has them.
mod table;
/// The table with the ball before it.
mod tabletop;

pub use chain::{Chain, Side};
pub use description::{Icub, JointControl};
pub use error::IcubError;
pub use posture::IcubPosture;
pub use tabletop::IcubTabletop;
