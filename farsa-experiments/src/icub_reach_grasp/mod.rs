//! The experiment `icub-reach-grasp`: an iCub reaches for a ball on a table, grasps it and lifts it.
//!
//! - `agent`: the network of an agent
//! - `config`: its values
//! - `episode`: an episode: the ball is somewhere, and shall be lifted
//! - `experiment`: its name and settings, and what runs its trials
//! - `fitness`: what a trial earns
//! - `motors`: what the robot does
//! - `protocols`: its test protocols
//! - `scene`: the robot, the table and the ball, and what is seen of them
//! - `schema`: what an episode records, by name
//! - `script`: a controller written by hand
//! - `senses`: what the robot senses
//! - `settings`: its values as settings
//! - `task`: what there is to know of it, and its episodes over parameters

mod agent;
mod config;
mod episode;
mod experiment;
mod fitness;
mod motors;
mod protocols;
mod scene;
mod schema;
mod script;
mod senses;
mod settings;
mod task;

pub use agent::Agent;
pub use config::{Area, Config, MOTORS, SENSORS};
pub use episode::{GraspEpisode, Grasper, GraspingWorld, Lifting};
pub use experiment::{IcubReachGrasp, evaluator};
pub use fitness::{Observation, Score, opposition};
pub use motors::Motors;
pub use protocols::CELLS;
pub use scene::Scene;
pub use script::Script;
pub use senses::Senses;
pub use task::GraspTask;
