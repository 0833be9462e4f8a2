//! Searches in which what is evaluated together evolves apart.
//!
//! - `cosyne_config`, `cosyne`: [`Cosyne`], a subpopulation for each weight of a network.

mod cosyne;
mod cosyne_config;

pub use cosyne::Cosyne;
pub use cosyne_config::{CosyneConfig, Permutation};
