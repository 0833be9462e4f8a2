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
mod episode;
mod error;
mod evaluate;
mod evaluator;
pub mod evolution;
mod exam;
mod exam_table;
mod experiment;
mod export;
pub mod foraging;
mod genotype;
mod genotypes;
mod import;
mod in_lanes;
mod in_world;
mod info;
mod infrared;
pub mod kinesthetic_grasp;
mod lanes;
mod learning;
mod log;
mod manifest;
mod manual;
pub mod minimal_cognition;
mod model;
mod network_parameters;
mod neurocontroller;
mod opponents;
mod outcome;
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
pub use episode::{Episode, EpisodeId, run, seconds};
pub use evaluator::{Bodies, Evaluation, Evaluator, Exports, InLanes, Learner, Lesson, Parameter, Task};
pub use experiment::Experiment;
pub use foraging::Foraging;
pub use genotype::Genotype;
pub use genotypes::read_genotypes;
pub use in_lanes::{Batch, run_in_lanes};
pub use in_world::{InWorld, Rollout};
pub use kinesthetic_grasp::KinestheticGrasp;
pub use lanes::Lanes;


pub use minimal_cognition::MinimalCognition;
pub use network_parameters::{OwnedNetwork, network_parameters, resting_network};
pub use neurocontroller::Neurocontroller;
pub use outcome::{ChannelGroup, Description, Note, Outcome};
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
