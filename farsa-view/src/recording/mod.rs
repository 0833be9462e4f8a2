//! What happened, tick by tick, as a [`Recorder`](farsa_body::Recorder) is told it.
//!
//! - `stage`: what there is to record: bodies, channels, a network
//! - `arena_stage`: the stage of a planar arena
//! - `view`: from where a page first looks
//! - `memory`: a recording in memory
//! - `table`: a recording as comma-separated values

mod arena_stage;
pub(crate) mod memory;
pub(crate) mod stage;
mod table;
pub(crate) mod view;

pub use memory::{CastRay, Recording, Touching};
pub use stage::{Channel, Links, NodeParameters, Stage};
pub use table::Table;
pub use view::View;
