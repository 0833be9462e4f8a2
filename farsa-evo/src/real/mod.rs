//! Searches over real genes within bounds or around a mean, by selection and mutation.

/// Ranges of genes.
pub(crate) mod bounds;
/// Recombination of two parents.
pub(crate) mod crossover;
/// Evolution strategies with self-adaptation.
mod evolution_strategy;
/// Mutation of genes.
pub(crate) mod mutation;
/// The generational genetic algorithm.
mod real_ga;
/// Selection of parents.
mod selection;
/// The steady state strategy.
mod steady_state;

pub use crossover::Crossover;
pub use evolution_strategy::{EvolutionStrategy, EvolutionStrategyConfig, Recombination, StepSizes, Survival};
pub use mutation::RealMutation;
pub use real_ga::{RealGa, RealGaConfig};
pub use selection::Selection;
pub use steady_state::{SteadyState, SteadyStateConfig};
