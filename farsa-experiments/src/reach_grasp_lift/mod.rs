//! The experiment `reach-grasp-lift`, in which an arm and a hand reach for a sphere, grasp it and lift it.

/// The values of `reach-grasp-lift` and what is built from them.
pub(crate) mod config;
/// The settings of `reach-grasp-lift` with their limits, units, sources and reasons.
mod entries;
/// An episode of `reach-grasp-lift`: one trial, from the start to the last step or the sphere's fall.
pub(crate) mod episode;
/// Its name, conditions and settings, and what runs its trials.
pub(crate) mod experiment;
/// The controller of `reach-grasp-lift` and its starts for other programs.
mod export;
/// The reward of `reach-grasp-lift`: what a step earns, the caps over an individual's trials, and success.
mod fitness;
/// The parts of the arm that only pictures and pages show.
mod look;
/// The parameters of `reach-grasp-lift`.
mod parameters;
/// The three phases of `reach-grasp-lift` and what is observed of a step to distinguish them.
mod phase;
/// The scene of `reach-grasp-lift`: how a trial starts in it, what the robot senses and does, and what the judge sees.
pub(crate) mod scene;
/// The recorded channels of `reach-grasp-lift`, by name.
mod schema;
/// A grasp by script: what the task asks of arm, hand and contacts, shown without evolution.
pub(crate) mod script;
/// The configuration of `reach-grasp-lift` from settings, and as settings.
mod settings;
/// The description of `reach-grasp-lift`, and its episodes over parameters.
pub(crate) mod task;

pub use crate::worlds::Engine;
pub use config::{Config, Displacement, Labels, OUTPUTS, SphereFrame, TRIALS};
pub use episode::{Judge, ReachEpisode};
#[cfg(feature = "rapier")]
pub use experiment::evaluator_in_rapier;
pub use experiment::{ReachGraspLift, evaluator};
pub use fitness::{ContactTerm, GRASP_CAP, Judgement, LIFT_CAP, REACH_CAP, Rewards, Trial};
pub use phase::{Observation, Phase};
pub use scene::{Motors, Scene, Senses};
pub use script::{GraspPlan, ScriptEpisode, Statics, Timetable};
pub use task::ReachTask;
