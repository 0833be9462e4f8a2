//! Searches of several populations whose individuals are evaluated together.

/// Cooperative Synapse Neuroevolution.
mod cosyne;
/// Two populations with generalist selection.
mod generalist;
mod generalist_config;
/// Outcomes of encounters, and generalist selection by them.
mod outcomes;
/// Several searches of one kind, one for each population.
mod populations;

pub use cosyne::{Cosyne, CosyneConfig, Permutation};
pub use generalist::GeneralistCoevolution;
pub use generalist_config::GeneralistConfig;
pub use outcomes::{Outcomes, Replacement};
pub use populations::Populations;
