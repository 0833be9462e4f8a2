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
    ActuatorExport, ChannelGroup, ControllerExport, CtrnnExport, Description, Experiment, Job, JudgeExport, Lanes,
    Lesson, Life, MotorDrive, MotorExport, NetworkDecoder, NetworkExport, Neurocontroller, Note, Outcome, PointExport,
    Search, SensorExport, SensorReading, ServoExport, Setting, Settings, Setup, Source, StartExport, SurfaceExport,
    Tape, Task, TeamNetwork, Value, live, live_in_lanes,
};
pub use run::{BestOfRun, ENGINE};
pub use search::evolution;
pub use store::VALUES_VERSION;

pub use farsa_view::{Channel, Links, NodeParameters, Prop, Recording, Stage, View};
