//! URDF, the format of ROS: [`write`](write()) makes it. [`Imported`](crate::Imported) reads it.

/// Elements that a URDF does not have.
mod elements;
/// Places and shapes in elements of a file.
mod geometry;
/// From a file's links and joints to a robot.
pub(crate) mod read;
/// Visuals of links.
mod visuals;
/// Shapes instead of meshes.
mod without_meshes;
/// From a robot to the text of a file.
mod write;

pub(crate) use without_meshes::without_meshes;
pub use write::write;
