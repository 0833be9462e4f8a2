//! A robot with joints in space.

/// Meshes of a model's file.
pub(crate) mod drawn_meshes;
/// Episode.
pub(crate) mod episode;
/// Registered sensors and motors.
mod registered;
/// Robot, built in or from a file.
pub(crate) mod robot_model;
/// Robot with the floor and the objects, and the parts that names refer to.
pub(crate) mod scene;
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
