//! The checks of the conformance kit.

/// Setting a world up for a new episode.
mod arrange;
/// Sensors and motors.
mod channels;
/// Forces from outside.
mod forces;
/// Surfaces and lines of sight of a planar world.
mod planar;
/// Ray casts.
mod rays;
/// Rays of cameras.
mod vision;
/// A world that steps.
mod world;

pub use arrange::check_arrange;
pub use channels::{check_motor, check_sensor};
pub use forces::check_external_forces;
pub use planar::{check_planar, check_sight};
pub use rays::check_rays;
pub use vision::check_vision;
pub use world::check_world;
