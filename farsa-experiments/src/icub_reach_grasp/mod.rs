//! The experiment `icub-reach-grasp`, in which an iCub reaches for a ball on a table, grasps it and lifts it.

/// The network of an agent.
mod agent;
/// Its values.
mod config;
/// An episode: the ball is somewhere, and shall be lifted.
mod episode;
/// Its name and settings, and what runs its trials.
mod experiment;
/// The reward of a trial.
mod fitness;
/// The robot's motors.
mod motors;
/// Its test protocols.
mod protocols;
/// The robot, the table and the ball, and what is seen of them.
mod scene;
/// The recorded channels, by name.
mod schema;
/// A controller written by hand.
mod script;
/// The senses of the robot.
mod senses;
/// Its values as settings.
mod settings;
/// Its description, and episodes over parameters.
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
