//! The experiment `reach-grasp-lift`: an arm and hand reach for a sphere, grasp it and lift it.
//!
//! - `config`: the values of `reach-grasp-lift` and what is built from them
//! - `experiment`: its name, conditions and settings, and what runs its trials
//! - `export`: the controller of `reach-grasp-lift` and its starts for other programs
//! - `fitness`: the reward of `reach-grasp-lift`: what a step earns, the caps over an individual's trials, and success
//! - `episode`: an episode of `reach-grasp-lift`: one trial, from the start to the last step or the sphere's fall
//! - `parameters`: the parameters of `reach-grasp-lift`
//! - `phase`: the three phases of `reach-grasp-lift` and what is observed of a step to distinguish them
//! - `scene`: the scene of `reach-grasp-lift`: how a trial starts in it, what the robot senses and does, and what the judge sees
//! - `script`: a grasp by script: what the task asks of arm, hand and contacts, shown without evolution
//! - `settings`: every value of `reach-grasp-lift` as a setting: its key, limits, unit, source and reason
//! - `task`: what there is to know of `reach-grasp-lift`, and its episodes over parameters
//! - `schema`: what an episode of `reach-grasp-lift` records, by name

pub(crate) mod config;
pub(crate) mod episode;
pub(crate) mod experiment;
mod export;
mod fitness;
mod parameters;
mod phase;
pub(crate) mod scene;
mod schema;
pub(crate) mod script;
mod settings;
pub(crate) mod task;

pub use crate::worlds::Engine;
pub use config::{Config, Displacement, SphereFrame, TRIALS};
pub use episode::{Judge, ReachEpisode};
#[cfg(feature = "rapier")]
pub use experiment::evaluator_in_rapier;
pub use experiment::{ReachGraspLift, evaluator};
pub use fitness::{ContactTerm, GRASP_CAP, Judgement, LIFT_CAP, REACH_CAP, Rewards, Trial};
pub use phase::{Observation, Phase};
pub use scene::{Motors, OUTPUTS, Scene, Senses};
pub use script::{GraspPlan, ScriptEpisode, Statics, Timetable};
pub use task::ReachTask;
