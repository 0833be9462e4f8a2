//! Searches in which what is evaluated together evolves apart.
//!
//! - `cosyne_config`, `cosyne`: [`Cosyne`], a subpopulation for each weight of a network.
//! - `outcomes`: [`Outcomes`], who did how well against whom, and generalist selection by it.
//! - `generalist_config`, `generalist_coevolution`: [`GeneralistCoevolution`], two populations with generalist selection.

mod cosyne;
mod cosyne_config;
mod generalist_coevolution;
mod generalist_config;
mod outcomes;

pub use cosyne::Cosyne;
pub use cosyne_config::{CosyneConfig, Permutation};
pub use generalist_coevolution::GeneralistCoevolution;
pub use generalist_config::GeneralistConfig;
pub use outcomes::{Outcomes, Replacement};
