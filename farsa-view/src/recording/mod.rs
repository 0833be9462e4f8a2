//! What happened, tick by tick, as a [`Recorder`](farsa_body::Recorder) gets it.
//!
//! - `schema`: what there is to record: bodies, channels, a network
//! - `arena_schema`: the schema of a planar arena
//! - `wheeled_look`: what wheeled robots look like
//! - `view`: from where a page first looks
//! - `images`: what cameras saw, in few bytes
//! - `ground_images`: what lay on the ground, in fewer
//! - `memory`: a recording in memory
//! - `table`: a recording as comma-separated values

mod arena_schema;
pub(crate) mod ground_images;
mod images;
pub(crate) mod memory;
pub(crate) mod schema;
mod table;
pub(crate) mod view;
mod wheeled_look;

pub use memory::{CastRay, Recording, Touching};
pub use schema::{Channel, ImageChannel, Links, NodeParameters, Schema};
pub use table::Table;
pub use view::View;
