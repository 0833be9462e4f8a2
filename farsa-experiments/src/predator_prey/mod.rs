//! The experiment `predator-prey`: two populations evolve against each other.
//!
//! - `baseline`: a predator and a prey without evolution, to compare evolved ones with
//! - `config`: the values of `predator-prey`, as settings
//! - `experiment`: its name, conditions and settings, and what runs its trials
//! - `episode`: an episode of `predator-prey`: one robot chases another

mod baseline;
mod config;
mod episode;
mod experiment;

pub use baseline::Chaser;
pub use config::PredatorPreyConfig;
pub use episode::{PredatorPreyEpisode, PredatorPreyScenario};
pub use experiment::{PredatorPrey, chase};
