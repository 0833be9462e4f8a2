//! Controllers, starts, genotypes and robots as files for other programs.

/// A controller in C.
pub(crate) mod c;
/// A controller in the formats of boards and of Python.
mod controller_formats;
/// `farsa export`.
pub(crate) mod files;
/// Start of a trial as a keyframe.
mod keyframe;
/// `farsa robot`.
pub(crate) mod robot_file;
