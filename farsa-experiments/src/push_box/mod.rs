//! The experiment `push-box`. It requires a world with movable objects.

/// A pusher without evolution, to compare evolved ones with.
#[cfg(feature = "rapier")]
mod baseline;
/// The values of `push-box`, as settings.
mod config;
/// An episode of `push-box`: one trial with a robot and a box on an endless plane.
#[cfg(feature = "rapier")]
mod episode;
/// Its name, conditions and settings, and what runs its trials.
mod experiment;
/// Recording, protocols and wheels of its layer.
#[cfg(feature = "rapier")]
mod layer;
/// Its description, and episodes over parameters.
#[cfg(feature = "rapier")]
mod task;

#[cfg(feature = "rapier")]
pub use baseline::HomingPusher;
pub use config::PushConfig;
#[cfg(feature = "rapier")]
pub use episode::{PushEpisode, PushTrial};
pub use experiment::PushBox;
