//! The experiment `icub-reach`, in which an iCub reaches for targets with its left hand.

/// Its values.
mod config;
/// An episode: the hand reaches for a target, or for two.
mod episode;
/// Its name, conditions and settings, and what runs its trials.
mod experiment;
/// The network of an agent.
mod network;
/// Its test protocols.
mod protocols;
/// The robot, its six joints, and the targets.
mod scene;
/// The recorded channels, by name.
mod schema;
/// A controller written by hand.
mod script;
/// Its values as settings.
mod settings;
/// Its description, and episodes over parameters.
mod task;
/// The reward of a trial.
mod totals;

pub use config::{Condition, Config, Volume};
pub use episode::{ReachEpisode, Reacher, Reaching, ReachingWorld};
pub use experiment::{IcubReach, evaluator};
pub use network::{Agent, LAYOUT};
pub use protocols::{GRID, grid, outside};
pub use scene::{CONTROLLED, Scene};
pub use script::Script;
pub use task::ReachTask;
pub use totals::RewardTotals;
