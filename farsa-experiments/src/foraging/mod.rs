//! The experiment `foraging`: a team carries food to its nest.

/// A forager without evolution, to compare evolved ones with.
mod baseline;
/// The values of `foraging`, as settings.
mod config;
/// An episode of `foraging`: robots carry food from a field to their nest, and must return to survive.
mod episode;
/// Its name, conditions and settings, and what runs its trials.
mod experiment;

pub use crate::team::config::TeamConfig;
pub use crate::team::eyes::RobotEyes;
pub use crate::team::robots::Team;
pub use crate::team::{episode::Moment, episode::Scenario, episode::TeamEpisode};
pub use baseline::HomingForager;
pub use config::ForagingConfig;
pub use episode::{ForagingEpisode, ForagingScenario};
pub use experiment::{Foraging, forage};
pub use farsa_compose::{Field, Forager};
pub use farsa_lab::advanced::OwnedNetwork;
