//! Runs from many places brought together: `farsa merge`.
//!
//! - `copy`: runs copied whole to one directory, and nothing overwritten
//! - `gather`: the runs below directories, each once
//! - `merged`: `farsa merge`: what is copied and told of the runs
//! - `run_table`: a table of runs: what differs, and what came of each

mod copy;
mod gather;
mod merged;
mod run_table;

pub(crate) use merged::Merge;
