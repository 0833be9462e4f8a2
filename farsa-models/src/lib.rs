#![doc = include_str!("../README.md")]

/// How large the numbers of a model may be.
mod bounds;
/// What the readers of both formats carry along.
mod context;
/// What can be wrong with a file.
mod error;
/// The files that a model names, found within its folders only.
mod files;
/// Where the file's links and bodies are in the robot.
mod frame;
/// The entry: a robot from a file or a text.
mod imported;
/// Triangles, the solids that stand for them, and their principal axes.
mod mesh;
pub mod mjcf;
/// How to read: strictly, or with what repairs and limits.
mod options;
/// Masses that no body can have.
mod repair;
pub mod urdf;
/// Products and lengths of vectors.
mod vector;
/// What was left out or replaced.
mod warnings;
/// XML: checked before it is parsed, asked for names and numbers, written.
mod xml;

pub use error::{ReadError, SourceLocation};
pub use frame::Frame;
pub use imported::Imported;
pub use mjcf::{Keyframe, MjcfOptions};
pub use options::{Limits, Meshes, ReadOptions, Repair};
pub use warnings::Warning;
