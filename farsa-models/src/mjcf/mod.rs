//! MJCF, MuJoCo's own format: [`write`](write()) makes it; [`Imported`](crate::Imported) reads it.
//!
//! A model is read in this order, a file each.

/// The entry: the sections of a model, one after the other.
pub(crate) mod read;

/// The settings of `compiler` elements, and the places and rotations that depend on them.
mod compiler;

/// The classes of defaults, and elements that ask them for what they do not say.
mod classes;

/// The names that bodies, joints and geoms have or get.
mod names;

/// Bodies and the segments that they become.
mod bodies;

/// Joints.
mod joints;

/// Geoms and meshes.
mod geoms;

/// Actuators.
mod actuators;

/// Which colliders may touch, and how their surfaces act.
mod contacts;

/// How easily a force moves each body, which contact parameters are relative to.
mod inverse_weight;

/// From a robot to the text of a file.
mod write;

pub use write::{Keyframe, MjcfOptions, write};
