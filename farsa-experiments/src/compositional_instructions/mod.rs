//! The experiment `compositional-instructions`: an arm that is told an action and an object.
//!
//! - `agent`: the network of an agent, whole or with lesions
//! - `config`: its values
//! - `episode`: an episode: the agent hears an instruction and follows it, or does not
//! - `experiment`: its name, conditions and settings, and what runs its trials
//! - `fitness`: what a trial earns, and whether it succeeds
//! - `instruction`: instructions of two words
//! - `network`: how the network is made of numbers
//! - `protocols`: its test protocols
//! - `scene`: an arm and three objects in a plane, and how a trial starts
//! - `schema`: what an episode records, by name
//! - `script`: a controller written by hand
//! - `senses`: what the agent senses
//! - `settings`: its values as settings
//! - `task`: what there is to know of it, and its episodes over parameters

mod agent;
mod config;
mod episode;
mod experiment;
mod fitness;
mod instruction;
mod network;
mod protocols;
mod scene;
mod schema;
mod script;
mod senses;
mod settings;
mod task;

pub use agent::Agent;
pub use config::{Arm, Camera, Config, Judging, Objects, Ranges, Start};
pub use episode::{InstructionEpisode, Told};
pub use experiment::{CompositionalInstructions, evaluator};
pub use fitness::{Ledger, Observation, Parts};
pub use instruction::{Action, Color, Condition, Instruction};
pub use network::{INNER, INPUTS, KINDS, LAYOUT, MOTORS, NEURONS, Wiring};
pub use scene::{Scene, StartPose};
pub use script::{Deaf, Script};
pub use senses::{ArmWorld, Senses, channel_names};
pub use task::InstructionTask;
