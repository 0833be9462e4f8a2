//! Searches that fill an archive with diverse individuals.
//!
//! [`MapElites`] keeps the best individual of every cell of the space of measures. [`NoveltySearch`] selects for measures
//! that differ from those seen so far.

/// The elite of each cell.
mod archive;
/// Distances between measures.
mod behaviors;
/// Divisions of the space of measures.
mod cells;
/// Cells of a centroidal Voronoi tessellation.
mod cvt_cells;
/// Variation of elites.
mod emitter;
/// Cells of a grid.
mod grid_cells;
/// The improvement emitter of CMA-ME.
mod improvement;
/// MAP-Elites.
mod map_elites;
mod map_elites_config;
/// Nearest neighbors by a k-d tree.
mod nearest;
mod novelty_config;
/// Novelty search.
mod novelty_search;

pub use archive::{Addition, Archive, CvtArchive, Elite, GridArchive};
pub use cells::Cells;
pub use cvt_cells::CvtCells;
pub use emitter::Emitter;
pub use grid_cells::GridCells;
pub use map_elites::MapElites;
pub use map_elites_config::MapElitesConfig;
pub use novelty_config::{ArchiveRule, NoveltyConfig};
pub use novelty_search::NoveltySearch;
