//! A robot with joints in space.
//!
//! - `spatial_world`: what such a robot needs of a world
//! - `composition`: the scene, the robot's sensors and motors, and what is measured of it
//! - `scene`: the robot with the floor and the things, and what their names mean
//! - `things`: things beside the robot, as parts of the scene
//! - `body`: the robot itself
//! - `spot`: a point that a name means
//! - `sensing`: any sensor, with what is wrapped around it
//! - `eyes`: cameras with an image
//! - `marker_position`: where a marker is
//! - `driving`: any motor, with what is wrapped around it
//! - `actuation`: the actuators that motors drive
//! - `starting`: where a trial puts joints and things
//! - `term`: what a term measures
//! - `episode`: a trial
//! - `meaning`: what channels stand for

mod actuation;
mod body;
pub(crate) mod composition;
mod driving;
pub(crate) mod episode;
mod eyes;
mod marker_position;
mod meaning;
pub(crate) mod scene;
mod sensing;
mod spatial_world;
mod spot;
mod starting;
mod term;
mod things;

pub(crate) use spatial_world::SpatialWorld;
