//! Robots on wheels in an arena.

/// Abilities that a world must have.
mod arena_world;
/// Episode.
pub(crate) mod episode;
/// Field that foragers share.
pub(crate) mod field;
/// Field in recordings and animations.
mod field_view;
/// Registered sensors and motors.
mod registered;
/// Arena, and the bodies that names refer to.
pub(crate) mod scene;
/// Scene with the sensors, motors and terms of its robots.
pub(crate) mod setup;
/// Overlaps at the start of a trial.
pub(crate) mod start_contacts;
/// Initial placements.
pub(crate) mod starting;
/// Terms of the fitness.
pub(crate) mod term;

pub(crate) use arena_world::ArenaWorld;
