//! The experiment `foraging`: a team carries food to its nest.
//!
//! - `baseline`: a forager without evolution, to compare evolved ones with
//! - `config`: the values of `foraging`, as settings
//! - `experiment`: its name, conditions and settings, and what runs its trials
//! - `episode`: an episode of `foraging`: robots carry food from a field to their nest, and must return to survive

mod baseline;
mod config;
mod episode;
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
pub use farsa_lab::OwnedNetwork;
