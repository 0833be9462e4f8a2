#![doc = include_str!("../README.md")]
#![cfg_attr(test, allow(clippy::unwrap_used))]

mod command;
mod error;
mod evaluation;
mod experiment;
mod export;
mod figures;
mod json;
mod report;
mod run;
mod search;
mod store;

pub use command::cli;
pub use error::Error;
pub use evaluation::read_genotypes;
pub use experiment::{
    ActuatorExport, Batch, Bodies, ChannelGroup, Controlled, ControllerExport, CtrnnExport, Description, Episode,
    EpisodeId, Evaluation, Evaluator, Experiment, Exports, Genotype, InLanes, InWorld, JudgeExport, Lanes, Learner,
    Lesson, MotorDrive, MotorExport, NetworkExport, Neurocontroller, NoWorld, Note, Objective, Outcome, OwnedNetwork,
    Parameter, PlanarWorld, PointExport, Rescored, Rollout, Search, SensorExport, SensorReading, ServoExport, Setting,
    Settings, SimpleExperiment, Source, StartExport, SurfaceExport, Task, Trials, Value, mean_of_trials,
    network_parameters, record_row, resting_network, run_episode, run_in_lanes, seconds,
};
pub use run::{BestOfRun, ENGINE};
pub use search::evolution;
pub use store::VALUES_VERSION;

pub use farsa_view::{Channel, Links, NodeParameters, Prop, Recording, Stage, View};
