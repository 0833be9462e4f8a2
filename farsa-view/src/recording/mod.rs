//! What happened, tick by tick, as a [`Recorder`](farsa_body::Recorder) gets it.
//!
//! - `schema`: what there is to record: bodies, channels, a network
//! - `arena_schema`: the schema of a planar arena
//! - `view`: from where a page first looks
//! - `memory`: a recording in memory
//! - `table`: a recording as comma-separated values

mod arena_schema;
pub(crate) mod memory;
pub(crate) mod schema;
mod table;
pub(crate) mod view;

pub use memory::{CastRay, Recording, Touching};
pub use schema::{Channel, Links, NodeParameters, Schema};
pub use table::Table;
pub use view::View;
