//! Sweeps: one file with many settings, `farsa sweep`.

/// Points of a sweep and their names.
mod points;
/// File of a sweep.
mod sweep_file;
/// `farsa sweep`: the runs of all points.
pub(crate) mod work;

pub(crate) use sweep_file::SweepFile;
