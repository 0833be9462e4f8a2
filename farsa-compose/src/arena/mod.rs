//! Robots on wheels in an arena.
//!
//! - `composition`: the scene, its robots, and what is measured of them
//! - `scene`: the arena, and which of its bodies a name means
//! - `sensing`: any sensor, with what is wrapped around it
//! - `driving`: any motor, with what is wrapped around it
//! - `felt`: what a robot feels of itself
//! - `field`: food on a field, and the robots that feed on it
//! - `field_view`: how food and foragers are recorded and seen
//! - `starting`: where a trial puts things
//! - `measure`: what terms measure of robots
//! - `term`: a term with the thing that it is about
//! - `episode`: a trial
//! - `meaning`: what channels stand for

pub(crate) mod composition;
pub(crate) mod driving;
pub(crate) mod episode;
pub(crate) mod felt;
pub(crate) mod field;
mod field_view;
mod meaning;
pub(crate) mod measure;
pub(crate) mod scene;
pub(crate) mod sensing;
pub(crate) mod starting;
pub(crate) mod term;
