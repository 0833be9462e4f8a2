//! MJCF, MuJoCo's own format: [`write`](write()) makes it. [`Imported`](crate::Imported) reads it.
//!
//! A model is read in this order, a file each.

/// Entry: the sections of a model, one after the other.
pub(crate) mod read;

/// Reasons for which parts are ignored.
mod reasons;

/// Settings of `compiler` elements, and the places and rotations that depend on them.
mod compiler;

/// Settings of `option` elements that change the robot.
mod flags;

/// Classes of defaults, and the lookup of missing attributes.
mod classes;

/// Names that bodies, joints and geoms have or get.
mod names;

/// Bodies and the segments that they become.
mod bodies;

/// Elements of a body, those of its `frame`s among them.
mod items;

/// Masses of bodies.
mod inertials;

/// Joints.
mod joints;

/// Limits of joints.
mod limits;

/// Geoms and meshes.
mod geoms;

/// Meshes that views draw.
mod drawn;

/// Actuators.
mod actuators;

/// Laws of actuators.
mod gains;

/// Which colliders may touch.
mod contacts;

/// Interaction of two surfaces.
mod surface;

/// Inverse weights of bodies, to which contact parameters are relative.
mod inverse_weight;

/// Shapes instead of meshes.
mod without_meshes;

/// Named states.
mod keyframes;

/// From a robot to the text of a file.
mod write;

/// Inertias in a file.
mod written_inertia;

pub use keyframes::Keyframe;
pub(crate) use without_meshes::without_meshes;
pub use write::{MjcfOptions, write};
