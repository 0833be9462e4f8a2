//! Searches for trade-offs between several objectives.

/// Fronts, crowding distances and the hypervolume.
mod fronts;
/// The elitist non-dominated sorting genetic algorithm.
mod nsga2;

pub use fronts::{crowding_distances, dominates, hypervolume, non_dominated_fronts};
pub use nsga2::{Nsga2, Nsga2Config};
