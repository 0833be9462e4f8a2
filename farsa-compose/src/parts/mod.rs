//! The parts that a document names, made.
//!
//! - `scene`: the arena, and which of its bodies a name means
//! - `sensing`: any sensor, with what is wrapped around it
//! - `driving`: any motor, with what is wrapped around it
//! - `network`: any network
//! - `starting`: where a trial puts things
//! - `term`: a term of the fitness
//! - `wrapping`: what is wrapped around sensors and motors alike

pub(crate) mod driving;
pub(crate) mod network;
pub(crate) mod scene;
pub(crate) mod sensing;
pub(crate) mod starting;
pub(crate) mod term;
pub(crate) mod wrapping;
