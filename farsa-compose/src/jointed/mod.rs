//! A robot with joints in space.

/// Actuators of motors.
mod actuation;
/// Quantities of channels.
mod channel_quantity;
/// Motors, with their wrappers.
mod driving;
/// Episode.
pub(crate) mod episode;
/// Cameras with an image.
mod eyes;
/// Pose and velocity of frames of bodies.
mod frame;
/// Positions of markers relative to a body.
mod marker_position;
/// A point of a body, or a marker.
pub(crate) mod named_point;
/// Registered sensors and motors.
mod registered;
/// Robot, built in or from a file.
pub(crate) mod robot_model;
/// Robot with the floor and the objects, and the parts that names refer to.
pub(crate) mod scene;
/// Sensors, with their wrappers.
mod sensing;
/// Scene with the sensors, motors and terms of its robot.
pub(crate) mod setup;
/// Abilities that a world must have.
mod spatial_world;
/// Contacts at the start of a trial.
pub(crate) mod start_contacts;
/// Initial placements.
mod starting;
/// Terms of the fitness.
mod term;
/// Objects of the scene.
mod things;

pub(crate) use spatial_world::SpatialWorld;
