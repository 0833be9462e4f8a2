#![doc = include_str!("../README.md")]
#![cfg_attr(docsrs, feature(doc_cfg))]

/// Bounds of a model's numbers.
mod bounds;
/// The shared state of both readers.
mod context;
/// The error of readers.
mod error;
/// The files that a model names, found within its folders only.
mod files;
/// Where the file's links and bodies are in the robot.
mod frame;
/// The entry: a robot from a file or a text.
mod imported;
/// Triangles, the solids that replace them, and their principal axes.
mod mesh;
pub mod mjcf;
/// Options of readers: strictness, repairs, limits.
mod options;
/// Masses that no body can have.
mod repair;
pub mod urdf;
/// Products and lengths of vectors.
mod vector;
/// Omitted and replaced parts.
mod warnings;
/// XML: checked before it is parsed, asked for names and numbers, written.
mod xml;

pub use error::{ReadError, SourceLocation};
pub use frame::Frame;
pub use imported::Imported;
pub use options::{Limits, Meshes, ReadOptions, Repair};
pub use warnings::Warning;
