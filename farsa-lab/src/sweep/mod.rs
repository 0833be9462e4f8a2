//! Sweeps: one file with many settings, `farsa sweep`.

/// The points of a sweep and their names.
mod points;
/// The file of a sweep.
mod sweep_file;
/// `farsa sweep`: the runs of all points.
pub(crate) mod work;

pub(crate) use sweep_file::SweepFile;
