#![doc = include_str!("../README.md")]
#![cfg_attr(docsrs, feature(doc_cfg))]

/// Bounds of a model's numbers.
mod bounds;
/// Shared state of both readers.
mod context;
/// Meshes that views draw.
mod drawn;
/// Errors of reading.
mod error;
/// Files that a model names, which must be in its folders.
mod files;
/// Frames of the file's links and bodies.
mod frame;
/// Reading of a robot from a file or a text.
mod imported;
/// Triangles, the solids that replace them, and their principal axes.
mod mesh;
pub mod mjcf;
/// Options for reading, such as repairs and limits.
mod options;
/// Masses that no body can have.
mod repair;
/// Models as texts that name no other file.
mod self_contained;
pub mod urdf;
/// Products and lengths of vectors.
mod vector;
/// Omitted and replaced parts.
mod warnings;
/// Checked XML, its names and numbers, and its writer.
mod xml;

pub use drawn::DrawnMesh;
pub use error::{ReadError, SourceLocation};
pub use frame::Frame;
pub use imported::Imported;
pub use options::{Limits, Meshes, ReadOptions, Repair};
pub use self_contained::{SelfContained, self_contained};
pub use warnings::Warning;
