//! Search for what has not been there.
//!
//! - `novelty_config`: what novelty search needs to know.
//! - `behaviours`: an archive of behaviours, and how new one is.
//! - `novelty_search`: novelty in the place of fitness, for any strategy.

mod behaviours;
mod novelty_config;
mod novelty_search;

pub use novelty_config::{ArchiveRule, NoveltyConfig};
pub use novelty_search::NoveltySearch;
