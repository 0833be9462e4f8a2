//! Many settings by one file: `farsa sweep`.
//!
//! - `points`: the points of a sweep: what varies from one to the next, and their names
//! - `sweep_file`: what the file of a sweep says
//! - `work`: `farsa sweep`: the runs of all points, by any number of processes

mod points;
mod sweep_file;
pub(crate) mod work;

pub(crate) use sweep_file::SweepFile;
