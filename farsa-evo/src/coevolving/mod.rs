//! Searches in which what is evaluated together evolves apart.
//!
//! - `cosyne_config`, `cosyne`: [`Cosyne`], a subpopulation for each weight of a network.
//! - `outcomes`: [`Outcomes`], who did how well against whom, and generalist selection by it.

mod cosyne;
mod cosyne_config;
mod outcomes;

pub use cosyne::Cosyne;
pub use cosyne_config::{CosyneConfig, Permutation};
pub use outcomes::{Outcomes, Replacement};
