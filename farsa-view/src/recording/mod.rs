//! Recorded episodes, as a [`Recorder`](farsa_body::Recorder) receives them.

/// Schema of a planar arena.
mod arena_schema;
/// Images on the ground, stored as changes.
pub(crate) mod ground_images;
/// Camera images.
mod images;
/// A recording in memory.
pub(crate) mod memory;
/// Schema of a recording: bodies, channels and a network.
pub(crate) mod schema;
/// Recordings as comma-separated values.
mod table;
/// Initial camera of a page.
pub(crate) mod view;
/// Appearance of wheeled robots.
mod wheeled_look;

pub use memory::{CastRay, Recording, Touching};
pub use schema::{Channel, ImageChannel, Links, NodeParameters, Schema};
pub use table::Table;
pub use view::View;
