//! Sweeps: one file with many settings or checks, `farsa sweep`.

/// Results of checks.
pub(crate) mod check_table;
/// Checks of a file.
mod checks_file;
/// Measures of a check.
mod measure;
/// Points of a sweep and their names.
mod points;
/// File of a sweep.
mod sweep_file;
/// `farsa sweep`: the runs of all points.
pub(crate) mod work;

pub(crate) use checks_file::{Check, Study};
pub(crate) use measure::Estimate;
