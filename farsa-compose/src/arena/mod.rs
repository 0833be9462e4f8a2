//! Robots on wheels in an arena.

/// The quantities of channels.
mod channel_quantity;
/// Motors, with their wrappers.
pub(crate) mod driving;
/// The episode.
pub(crate) mod episode;
/// The field that foragers share.
pub(crate) mod field;
/// The field in recordings and animations.
mod field_view;
/// Spread and clusters of robots.
mod gathering;
/// The measures of terms.
pub(crate) mod measure;
/// The arena, and the bodies that names refer to.
pub(crate) mod scene;
/// Sensors, with their wrappers.
pub(crate) mod sensing;
/// The scene with the sensors, motors and terms of its robots.
pub(crate) mod setup;
/// Initial placements.
pub(crate) mod starting;
/// Terms of the fitness.
pub(crate) mod term;
