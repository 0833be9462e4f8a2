//! Searches for the best of every kind of behaviour.
//!
//! - `cells`: how the space of descriptors is divided.
//! - `grid_cells`: into boxes.
//! - `cvt_cells`: into what is nearest to a centroid.
//! - `nearest`: the nearest of many points.
//! - `archive`: the elite of each cell.
//! - `emitter`: where new individuals come from.
//! - `improvement`: a normal distribution that is adapted to what improves an archive.
//! - `map_elites_config`, `search`: the search itself.

mod archive;
mod cells;
mod cvt_cells;
mod emitter;
mod grid_cells;
mod improvement;
mod map_elites_config;
mod nearest;
mod search;

pub use archive::{Addition, Archive, CvtArchive, Elite, GridArchive};
pub use cells::Cells;
pub use cvt_cells::CvtCells;
pub use emitter::Emitter;
pub use grid_cells::GridCells;
pub use map_elites_config::MapElitesConfig;
pub use search::MapElites;
