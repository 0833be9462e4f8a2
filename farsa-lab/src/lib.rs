#![doc = include_str!("../README.md")]
#![cfg_attr(docsrs, feature(doc_cfg))]
#![cfg_attr(test, allow(clippy::unwrap_used))]
// Runs, tests and reports are private: only the command uses them.
#![cfg_attr(not(feature = "command"), allow(dead_code, unused_imports))]

pub mod advanced;
#[cfg(feature = "command")]
mod archive;
#[cfg(feature = "command")]
mod command;
mod error;
mod escaped;
mod evaluation;
mod experiment;
#[cfg(feature = "command")]
mod export;
#[cfg(feature = "command")]
mod figures;
#[cfg(feature = "fuzzing")]
#[doc(hidden)]
pub mod fuzzing;
#[cfg(feature = "command")]
mod json;
mod limits;
mod live;
#[cfg(feature = "command")]
mod merge;
pub mod prelude;
mod ranks;
#[cfg(feature = "command")]
mod report;
mod run;
mod run_directory;
#[cfg(feature = "command")]
mod shell;
mod store;
pub mod strategy;
#[cfg(feature = "command")]
mod sweep;

#[cfg(feature = "command")]
pub use command::cli;
pub use error::Error;
pub use experiment::{
    Combination, Controlled, Episode, EpisodeId, Evaluation, Evaluator, InWorld, Neurocontroller, Note, Objective,
    Outcome, Parameter, Setting, Settings, Task, TaskInfo, Trials,
};
pub use run::{Experiment, Laboratory, SimpleExperiment};

/// Types of `farsa export`: controllers, channels and starts as plain data.
pub mod exports {
    pub use crate::experiment::{
        ActuatorExport, ControllerExport, Exports, JudgeExport, MotorDrive, MotorExport, NetworkExport, PointExport,
        SensorExport, SensorReading, ServoExport, StartExport, SurfaceExport,
    };
    #[cfg(feature = "command")]
    pub use crate::export::c::CFiles;
}
