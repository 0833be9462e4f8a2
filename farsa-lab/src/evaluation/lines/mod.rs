//! `farsa evaluate --stdin`: JSON lines, parameters in and outcomes out, for optimisers in any language.
//!
//! - `answer`: what is written: the description at first, then a line for each line
//! - `bounded_line`: lines of an input, each of a bounded length
//! - `given`: vectors of numbers as a line gives them
//! - `request`: what a line asks for
//! - `serve`: from the first line to the last

mod answer;
mod bounded_line;
mod given;
mod request;
mod serve;

#[cfg(feature = "fuzzing")]
pub(crate) use request::{Request, Wanted};
pub(crate) use serve::serve;
