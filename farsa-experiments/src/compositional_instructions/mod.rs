//! The experiment `compositional-instructions`, in which a robot arm follows instructions of two words.

/// The network of an agent, whole or with lesions.
mod agent;
/// Its values.
mod config;
/// An episode: the agent receives an instruction and follows it, or does not.
mod episode;
/// Its name, conditions and settings, and what runs its trials.
mod experiment;
/// The reward of a trial, and its success.
mod fitness;
/// Instructions of two words.
mod instruction;
/// The network as a function of genes.
mod network;
/// Its test protocols.
mod protocols;
/// An arm and three objects in a plane, and how a trial starts.
mod scene;
/// The recorded channels, by name.
mod schema;
/// A controller written by hand.
mod script;
/// The senses of the agent.
mod senses;
/// Its values as settings.
mod settings;
/// Its description, and episodes over parameters.
mod task;

pub use agent::Agent;
pub use config::{Arm, Camera, Config, Judging, Objects, Ranges, Start};
pub use episode::{InstructionEpisode, TrialInstructions};
pub use experiment::{CompositionalInstructions, evaluator};
pub use fitness::{Observation, Parts, RewardTotals};
pub use instruction::{Action, Color, Condition, Instruction};
pub use network::{INNER, INPUTS, KINDS, LAYOUT, MOTORS, NEURONS, Wiring};
pub use scene::{Scene, StartPose};
pub use script::{Deaf, Script};
pub use senses::{ArmWorld, Senses, channel_names};
pub use task::InstructionTask;
