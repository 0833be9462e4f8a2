//! The experiment `reach-grasp-lift`: an arm and hand reach for a sphere, grasp it and lift it.
//!
//! - `config`: the values of `reach-grasp-lift` and what is built from them
//! - `experiment`: its name, conditions and settings, and what lives its lives
//! - `export`: the controller of `reach-grasp-lift` and its starts for other programs
//! - `fitness`: the reward of `reach-grasp-lift`: what a step earns, the caps over an individual's trials, and success
//! - `life`: a life of `reach-grasp-lift`: one trial, from the start to the last step or the sphere's fall
//! - `parameters`: the parameters of `reach-grasp-lift`
//! - `phase`: the three phases of `reach-grasp-lift` and what is observed of a step to tell them apart
//! - `scene`: the scene of `reach-grasp-lift`: how a trial starts in it, what the robot senses and does, and what the judge sees
//! - `script`: a grasp by script: what the task asks of arm, hand and contacts, shown without evolution
//! - `settings`: every value of `reach-grasp-lift` as a setting: its key, limits, unit, source and reason
//! - `task`: what there is to know of `reach-grasp-lift`, and its episodes over parameters
//! - `stage`: what a life of `reach-grasp-lift` tells a recorder, and the names of it

pub(crate) mod config;
pub(crate) mod experiment;
mod export;
mod fitness;
pub(crate) mod life;
mod parameters;
mod phase;
pub(crate) mod scene;
pub(crate) mod script;
mod settings;
mod stage;
pub(crate) mod task;

pub use crate::worlds::Engine;
pub use config::{Config, Displacement, SphereFrame, TRIALS};
#[cfg(feature = "rapier")]
pub use experiment::evaluator_in_rapier;
pub use experiment::{ReachGraspLift, evaluator};
pub use fitness::{ContactTerm, GRASP_CAP, Judgement, LIFT_CAP, Ledger, REACH_CAP, Trial};
pub use life::{Judge, ReachLife};
pub use phase::{Observation, Phase};
pub use scene::{Motors, OUTPUTS, Scene, Senses};
pub use script::{Plan, ScriptLife, Statics, Timetable};
pub use task::ReachTask;
