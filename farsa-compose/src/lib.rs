#![doc = include_str!("../README.md")]
#![cfg_attr(test, allow(clippy::unwrap_used))]
#![cfg_attr(docsrs, feature(doc_cfg))]

mod arena;
mod built_in;
mod check;
mod composed_task;
pub mod document;
mod ends;
mod experiment;
mod files;
mod formula;
mod jointed;
mod limits;
mod motors;
mod name;
mod networks;
pub mod part;
mod parts;
mod robots;
mod sensors;
mod starts;
mod terms;
mod things;
mod wrappers;

pub use built_in::schema;
pub use experiment::ComposedExperiment;
pub use files::FILES;
pub use limits::Limits;
pub use parts::reflex::Reflex;
