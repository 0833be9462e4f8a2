//! Searches that fill an archive with diverse individuals.
//!
//! [`MapElites`] keeps the best individual of every cell of the space of measures. [`NoveltySearch`] selects for measures
//! that differ from those seen so far.

/// The elite of each cell.
mod archive;
/// Cells of a centroidal Voronoi tessellation.
mod cvt_cells;
/// Variation of elites.
mod emitter;
/// Cells, and those of a grid.
mod grid_cells;
/// The improvement emitter of CMA-ME.
mod improvement;
/// MAP-Elites.
mod map_elites;
/// Nearest neighbors by a k-d tree.
mod nearest;
/// Novelty search.
mod novelty_search;

pub use archive::{Addition, Archive, Elite};
pub use cvt_cells::CvtCells;
pub use emitter::Emitter;
pub use grid_cells::{Cells, GridCells};
pub use map_elites::{MapElites, MapElitesConfig};
pub use novelty_search::{ArchiveRule, NoveltyConfig, NoveltySearch};
