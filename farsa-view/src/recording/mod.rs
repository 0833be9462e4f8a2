//! Recorded episodes, as a [`Recorder`](farsa_body::Recorder) receives them.

/// The schema of a planar arena.
mod arena_schema;
/// Images on the ground, stored as changes.
pub(crate) mod ground_images;
/// Camera images.
mod images;
/// A recording in memory.
pub(crate) mod memory;
/// The schema of a recording: bodies, channels and a network.
pub(crate) mod schema;
/// Recordings as comma-separated values.
mod table;
/// The initial camera of a page.
pub(crate) mod view;
/// The appearance of wheeled robots.
mod wheeled_look;

pub use memory::{CastRay, Recording, Touching};
pub use schema::{Channel, ImageChannel, Links, NodeParameters, Schema};
pub use table::Table;
pub use view::View;
