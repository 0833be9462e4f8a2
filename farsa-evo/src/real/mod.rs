//! Searches over real genes within bounds or around a mean, by selection and mutation.
//!
//! - `bounds`: the range of each gene, and how what leaves it comes back.
//! - `ranking`: who comes before whom.
//! - `selection`: how parents are chosen.
//! - `crossover`: how the genes of two parents are mixed.
//! - `mutation`: how genes change from parent to child.
//! - `polynomial_mutation`: the same, as NSGA-II does it.
//! - `real_ga_config`, `real_ga`: the generational genetic algorithm.
//! - `evolution_strategy_config`, `evolution_strategy`: (mu + lambda) and (mu, lambda) with step sizes that adapt
//!   themselves.
//! - `steady_state`: parents and one child each, of which the better half stays.

pub(crate) mod bounds;
pub(crate) mod crossover;
mod evolution_strategy;
mod evolution_strategy_config;
mod mutation;
pub(crate) mod polynomial_mutation;
pub(crate) mod ranking;
mod real_ga;
mod real_ga_config;
mod selection;
mod steady_state;

pub use crossover::Crossover;
pub use evolution_strategy::EvolutionStrategy;
pub use evolution_strategy_config::{EvolutionStrategyConfig, Recombination, StepSizes, Survival};
pub use mutation::RealMutation;
pub use real_ga::RealGa;
pub use real_ga_config::RealGaConfig;
pub use selection::Selection;
pub use steady_state::{SteadyState, SteadyStateConfig};
