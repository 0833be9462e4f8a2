//! `farsa evaluate --stdin`: JSON lines, parameters in and outcomes out, for optimizers in any language.

/// Output lines: a description first, then one answer per input line.
mod answer;
/// Input lines of bounded length.
mod bounded_line;
/// Vectors of numbers in a line.
mod parameter_vectors;
/// Requests: the content of an input line.
mod request;
/// Loop over lines.
mod serve;

#[cfg(feature = "fuzzing")]
pub(crate) use request::{Request, RequestSchema};
pub(crate) use serve::serve;
