//! The experiment `predator-prey`: two populations evolve against each other.

/// A predator and a prey without evolution, to compare evolved ones with.
mod baseline;
/// The values of `predator-prey`, as settings.
mod config;
/// An episode of `predator-prey`: one robot chases another.
mod episode;
/// Its name, conditions and settings, and what runs its trials.
mod experiment;

pub use baseline::Chaser;
pub use config::PredatorPreyConfig;
pub use episode::{PredatorPreyEpisode, PredatorPreyScenario};
pub use experiment::{PredatorPrey, chase};
