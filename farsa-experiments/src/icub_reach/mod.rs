//! The experiment `icub-reach`: the left hand of an iCub reaches for targets in front of it.
//!
//! - `config`: its values
//! - `episode`: an episode: the hand reaches for a target, or for two
//! - `experiment`: its name, conditions and settings, and what runs its trials
//! - `ledger`: what a trial earns
//! - `network`: the network of an agent
//! - `protocols`: its test protocols
//! - `scene`: the robot, its six joints, and the targets
//! - `schema`: what an episode records, by name
//! - `script`: a controller written by hand
//! - `settings`: its values as settings
//! - `task`: what there is to know of it, and its episodes over parameters

mod config;
mod episode;
mod experiment;
mod ledger;
mod network;
mod protocols;
mod scene;
mod schema;
mod script;
mod settings;
mod task;

pub use config::{Condition, Config, Volume};
pub use episode::{ReachEpisode, Reacher, Reaching, ReachingWorld};
pub use experiment::{IcubReach, evaluator};
pub use ledger::Ledger;
pub use network::{Agent, LAYOUT};
pub use protocols::{GRID, grid, outside};
pub use scene::{CONTROLLED, Scene};
pub use script::Script;
pub use task::ReachTask;
