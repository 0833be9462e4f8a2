#![doc = include_str!("../README.md")]
#![cfg_attr(test, allow(clippy::unwrap_used))]

pub mod aggregation;
mod aggregation_by_hand;
mod aggregation_config;
mod aggregation_life;
mod aggregation_measure;
mod arguments;
mod arguments_genotypes;
mod bench;
mod best_of_run;
pub mod body_evolution;
pub mod braitenberg;
mod braitenberg_life;
pub mod cli;
mod controller_export;
mod controller_formats;
mod directory;
pub mod discrimination;
mod discrimination_config;
mod discrimination_cylinders;
mod discrimination_life;
mod draw;
mod engine;
mod error;
mod evaluate;
pub mod evolution;
mod exam;
mod exam_table;
mod experiment;
mod export;
mod fitness;
pub mod foraging;
mod foraging_by_hand;
mod foraging_config;
mod foraging_field;
mod foraging_life;
mod gait;
mod genotypes;
mod import;
mod info;
mod infrared;
pub mod kinesthetic_grasp;
mod kinesthetic_grasp_school;
mod kinesthetic_grasp_teacher;
mod lanes;
mod learning;
mod life;
mod live_in_lanes;
mod log;
mod manifest;
mod manual;
pub mod minimal_cognition;
mod minimal_cognition_config;
mod minimal_cognition_life;
mod minimal_cognition_network;
mod minimal_cognition_object;
mod model;
mod nest;
mod neurocontroller;
mod opponents;
pub mod passive_walker;
mod phase;
mod plan;
mod plot;
mod pool;
mod populations;
pub mod predator_prey;
mod predator_prey_by_hand;
mod predator_prey_config;
mod predator_prey_life;
mod progress;
pub mod push_box;
#[cfg(feature = "rapier")]
mod push_box_by_hand;
mod push_box_config;
#[cfg(feature = "rapier")]
mod push_box_life;
#[cfg(feature = "rapier")]
mod push_box_setup;
pub mod reach_grasp_lift;
mod reach_grasp_lift_config;
mod reach_grasp_lift_decoder;
mod reach_grasp_lift_export;
mod reach_grasp_lift_life;
mod reach_grasp_lift_scene;
mod reach_grasp_lift_settings;
mod reach_grasp_lift_stage;
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
mod script;
mod sealed;
mod search;
#[cfg(test)]
mod search_runs;
mod sensor_rays;
mod settings;
mod statistics;
mod swarm_config;
mod swarm_life;
mod swarm_robot;
mod swarm_setup;
mod swarm_team;
mod walker;
mod walker_life;
mod walker_settings;
mod walker_stage;
mod walking_model;

pub use aggregation::Aggregation;
pub use best_of_run::BestOfRun;
pub use body_evolution::BodyEvolution;
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
pub use passive_walker::PassiveWalker;
pub use predator_prey::PredatorPrey;
pub use push_box::PushBox;
pub use reach_grasp_lift::ReachGraspLift;
pub use search::Search;
pub use settings::{Setting, Settings, Source, Value};
pub use walking_model::{ModelGait, ModelStep, SLOPES, SlopeError, WalkingModel};

pub use farsa_view::{
    Beam, Camera, CastRay, Channel, Color, Form, Links, NodeParameters, OKABE_ITO, Page, Picture, Placed, Prop, Push,
    Recording, Role, Stage, Touching, View,
};

/// Grows by one whenever the same configuration, seed and genes come to other lives through a change in the crates that
/// experiments are built of; see [`Experiment::values_version`] for changes in an experiment itself.
pub const VALUES_VERSION: u32 = 3;
