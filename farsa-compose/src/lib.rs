#![doc = include_str!("../README.md")]
#![cfg_attr(test, allow(clippy::unwrap_used))]

mod check;
mod composition;
pub mod document;
mod episode;
mod experiment;
mod files;
mod name;
mod parts;

pub use check::schema::schema;
pub use experiment::ComposedExperiment;
pub use files::FILES;
