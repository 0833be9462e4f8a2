//! Searches of several populations whose individuals are evaluated together.

/// Cooperative Synapse Neuroevolution.
mod cosyne;
mod cosyne_config;
mod ga_populations;
/// Two populations with generalist selection.
mod generalist;
mod generalist_config;
/// Outcomes of encounters, and generalist selection by them.
mod outcomes;
/// Several searches of one kind, one for each population.
mod populations;

pub use cosyne::Cosyne;
pub use cosyne_config::{CosyneConfig, Permutation};
pub use ga_populations::Coevolution;
pub use generalist::GeneralistCoevolution;
pub use generalist_config::GeneralistConfig;
pub use outcomes::{Outcomes, Replacement};
pub use populations::Populations;
