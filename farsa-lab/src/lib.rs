#![doc = include_str!("../README.md")]
#![cfg_attr(docsrs, feature(doc_cfg))]
#![cfg_attr(test, allow(clippy::unwrap_used))]
// What runs, tests and reports is private: its user is the command.
#![cfg_attr(not(feature = "command"), allow(dead_code, unused_imports))]

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
mod ranks;
#[cfg(feature = "command")]
mod report;
mod run;
mod run_directory;
mod store;
mod strategy;
#[cfg(feature = "command")]
mod sweep;

#[cfg(feature = "command")]
pub use command::cli;
pub use error::Error;
#[cfg(feature = "command")]
pub use evaluation::TestTrial;
pub use evaluation::read_genotypes;
pub use experiment::{
    ActuatorExport, Anatomy, Batch, Behaviour, Bodies, Case, CaseId, ChannelGroup, Controlled, ControllerExport,
    Description, Displacement, Episode, EpisodeId, Evaluation, Evaluator, Experiment, Exports, Failure, Genotype,
    InLanes, InWorld, Intervention, Interventions, Iteration, JudgeExport, Lanes, Learner, MotorDrive, MotorExport,
    NetworkExport, Neurocontroller, NoWorld, NormalisedController, Note, NotedBehaviour, Objective, Outcome,
    OwnedNetwork, Parameter, PartNames, PlanarWorld, PointExport, Protocol, Push, Rescored, Rollout, SensorExport,
    SensorReading, ServoExport, Setting, Settings, SimpleExperiment, Source, StartExport, SurfaceExport, Task,
    TaskInfo, Trials, Value, input_ranges, mean_of_note, mean_of_trials, network_parameters, record_row,
    resting_network, run_episode, run_in_lanes, seconds,
};
pub use live::LiveSession;
pub use ranks::{Alone, Ranks};
pub use run::{ENGINE, ExperimentFiles, ImportExperiment, ImportedFile, Laboratory, LeftOut, ReadExperiment, Template};
pub use run_directory::{GenerationRecord, LogRow, RunChampion, RunDirectory};
pub use store::{VALUES_VERSION, read_text_file};
pub use strategy::{
    Diagnostics, DiagnosticsChart, Learning, OnePlusOne, Search, SimpleStrategy, StrategyDefinition, StrategyStart,
    Truncation, strategies,
};

pub use farsa_view::shape::SceneObject;
pub use farsa_view::{Channel, ImageChannel, Links, NodeParameters, Recording, Schema, View};
