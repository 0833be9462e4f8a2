#![doc = include_str!("../README.md")]
#![cfg_attr(test, allow(clippy::unwrap_used))]

mod arena;
mod check;
mod composed;
pub mod document;
mod experiment;
mod files;
mod jointed;
mod name;
mod parts;

pub use arena::field::{Field, Forager};
pub use check::schema::schema;
pub use experiment::ComposedExperiment;
pub use files::FILES;
