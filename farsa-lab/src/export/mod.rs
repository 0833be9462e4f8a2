//! Controllers, starts, genotypes and robots as files for other programs.
//!
//! - `controller_formats`: a controller in the formats of boards and of Python: bytes, Rust source, tables
//! - `files`: `farsa export`: robots, controllers, genotypes and starts as files for other programs
//! - `robot_file`: `farsa robot`: what is in a model file of a robot

mod controller_formats;
pub(crate) mod files;
pub(crate) mod robot_file;
