#![doc = include_str!("../README.md")]
#![cfg_attr(test, allow(clippy::unwrap_used))]

pub mod cli;
mod directory;
mod error;
pub mod evolution;
mod exam;
mod experiment;
mod fitness;
mod info;
mod life;
mod log;
mod manifest;
mod phase;
mod plan;
mod plot;
mod pool;
mod progress;
pub mod reach_grasp_lift;
mod reach_grasp_lift_config;
mod reach_grasp_lift_life;
mod reach_grasp_lift_scene;
mod reach_grasp_lift_settings;
mod records;
mod replay;
mod run;
mod script;
mod sealed;
mod settings;

pub use error::Error;
pub use experiment::{ChannelGroup, Description, Experiment, Note, Outcome, Setup, Tape};
pub use life::{Job, Life, live};
pub use reach_grasp_lift::ReachGraspLift;
pub use settings::{Setting, Settings, Source, Value};

/// Grows by one whenever the same configuration, seed and genes come to other lives through a change in the crates that
/// experiments are built of; see [`Experiment::values_version`] for changes in an experiment itself.
pub const VALUES_VERSION: u32 = 1;
