#![doc = include_str!("../README.md")]
#![cfg_attr(test, allow(clippy::unwrap_used))]

mod arguments;
mod camera;
pub mod cli;
mod directory;
mod draw;
mod draw_order;
mod error;
pub mod evolution;
mod exam;
mod exam_table;
mod experiment;
mod export;
mod fitness;
mod form;
mod info;
mod lanes;
mod life;
mod lit_scene;
mod live_in_lanes;
mod log;
mod manifest;
mod manual;
mod marks;
mod outline;
mod page;
mod phase;
mod picture;
mod picture_png;
mod picture_svg;
mod plan;
mod plot;
mod pool;
mod progress;
mod prop;
pub mod reach_grasp_lift;
mod reach_grasp_lift_config;
mod reach_grasp_lift_life;
mod reach_grasp_lift_scene;
mod reach_grasp_lift_settings;
mod recording;
mod records;
mod replay;
mod report;
mod report_curves;
mod report_page;
mod report_run;
mod report_section;
mod report_settings;
mod run;
mod script;
mod sealed;
mod settings;
mod stage;
mod statistics;
mod svg_data;
mod table;
mod vector;

pub use camera::Camera;
pub use error::Error;
pub use experiment::{ChannelGroup, Description, Experiment, Note, Outcome, Setup, Tape, Task};
pub use form::Form;
pub use lanes::Lanes;
pub use life::{Job, Life, live};
pub use live_in_lanes::live_in_lanes;
pub use page::Page;
pub use picture::{Beam, Color, OKABE_ITO, Picture, Placed, Push, Role};
pub use prop::Prop;
pub use reach_grasp_lift::ReachGraspLift;
pub use recording::{CastRay, Recording, Touching};
pub use settings::{Setting, Settings, Source, Value};
pub use stage::{Channel, Links, NodeParameters, Stage, View};

/// Grows by one whenever the same configuration, seed and genes come to other lives through a change in the crates that
/// experiments are built of; see [`Experiment::values_version`] for changes in an experiment itself.
pub const VALUES_VERSION: u32 = 2;
