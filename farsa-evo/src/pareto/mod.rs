//! Searches for trade-offs between several objectives.
//!
//! - `nsga2_config`, `nsga2`: the elitist non-dominated sorting genetic algorithm.
//! - `non_dominated_fronts`: who is dominated by whom.
//! - `crowding_distances`: how far apart the individuals of a front lie.
//! - `hypervolume`: how much two objectives a set of points dominates.

mod crowding_distances;
mod hypervolume;
mod non_dominated_fronts;
mod nsga2;
mod nsga2_config;

pub use crowding_distances::crowding_distances;
pub use hypervolume::hypervolume;
pub use non_dominated_fronts::{dominates, non_dominated_fronts};
pub use nsga2::Nsga2;
pub use nsga2_config::Nsga2Config;
