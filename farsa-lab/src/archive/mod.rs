//! Archives of finished runs: one compressed file from which every file of the runs is restored.

/// File of an archive.
mod packed;
/// Files of a run in an archive.
mod run;

pub(crate) use packed::Archive;
pub(crate) use run::{pack, restore};
