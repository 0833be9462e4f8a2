#![doc = include_str!("../README.md")]
#![cfg_attr(test, allow(clippy::unwrap_used))]

pub mod aggregation;
mod arguments;
mod arguments_genotypes;
mod bench;
mod best_of_run;
pub mod braitenberg;
pub mod cli;
mod controller_export;
mod controller_formats;
mod directory;
pub mod discrimination;
mod draw;
mod engine;
mod error;
mod evaluate;
pub mod evolution;
mod exam;
mod exam_table;
mod experiment;
mod export;
pub mod foraging;
mod genotypes;
mod import;
mod info;
mod infrared;
pub mod kinesthetic_grasp;
mod lanes;
mod learning;
mod life;
mod live_in_lanes;
mod log;
mod manifest;
mod manual;
pub mod minimal_cognition;
mod model;
mod network_decoder;
mod neurocontroller;
mod opponents;
mod plan;
mod plot;
mod pool;
mod populations;
pub mod predator_prey;
mod progress;
pub mod push_box;
pub mod reach_grasp_lift;
mod records;
mod replay;
mod replications;
mod report;
mod report_curves;
mod report_page;
mod report_run;
mod report_section;
mod report_settings;
mod run;
mod sealed;
mod search;
#[cfg(test)]
mod search_runs;
mod settings;
mod statistics;
mod team;
mod walking;
mod worlds;

pub use aggregation::Aggregation;
pub use best_of_run::BestOfRun;
pub use braitenberg::Braitenberg;
pub use controller_export::{
    ActuatorExport, ControllerExport, CtrnnExport, JudgeExport, MotorDrive, MotorExport, NetworkExport, PointExport,
    SensorExport, SensorReading, ServoExport, StartExport, SurfaceExport,
};
pub use discrimination::{Discrimination, DiscriminationCylinders};
pub use error::Error;
pub use experiment::{ChannelGroup, Description, Experiment, Lesson, Note, Outcome, Setup, Tape, Task};
pub use foraging::Foraging;
pub use genotypes::read_genotypes;
pub use kinesthetic_grasp::KinestheticGrasp;
pub use lanes::Lanes;
pub use life::{Job, Life, live};
pub use live_in_lanes::live_in_lanes;
pub use minimal_cognition::MinimalCognition;
pub use neurocontroller::Neurocontroller;
pub use predator_prey::PredatorPrey;
pub use push_box::PushBox;
pub use reach_grasp_lift::ReachGraspLift;
pub use search::Search;
pub use settings::{Setting, Settings, Source, Value};
pub use walking::body_evolution;
pub use walking::body_evolution::BodyEvolution;
pub use walking::passive_walker;
pub use walking::passive_walker::PassiveWalker;
pub use walking::{ModelGait, ModelStep, SLOPES, SlopeError, WalkingModel};

pub use farsa_view::{
    Beam, Camera, CastRay, Channel, Color, Form, Links, NodeParameters, OKABE_ITO, Page, Picture, Placed, Prop, Push,
    Recording, Role, Stage, Touching, View,
};

/// Grows by one whenever the same configuration, seed and genes come to other lives through a change in the crates that
/// experiments are built of; see [`Experiment::values_version`] for changes in an experiment itself.
pub const VALUES_VERSION: u32 = 3;
