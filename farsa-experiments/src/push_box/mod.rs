//! The experiment `push-box`: what only a general world can do.
//!
//! - `baseline`: a pusher without evolution, to compare evolved ones with
//! - `config`: the values of `push-box`, as settings
//! - `experiment`: its name, conditions and settings, and what runs its trials
//! - `episode`: an episode of `push-box`: one trial with a robot and a box on an endless plane
//! - `task`: what there is to know of `push-box`, and its episodes over parameters

#[cfg(feature = "rapier")]
mod baseline;
mod config;
#[cfg(feature = "rapier")]
mod episode;
mod experiment;
#[cfg(feature = "rapier")]
mod task;

#[cfg(feature = "rapier")]
pub use baseline::HomingPusher;
pub use config::PushConfig;
#[cfg(feature = "rapier")]
pub use episode::{PushEpisode, PushTrial};
pub use experiment::PushBox;
