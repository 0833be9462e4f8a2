//! The experiment `minimal-cognition`. It studies categorical perception.

/// The values of `minimal-cognition`, as settings.
mod config;
/// An episode of `minimal-cognition`: one object falls, and the agent moves under it.
mod episode;
/// Its name, conditions and settings, and what runs its trials.
mod experiment;
/// The network of `minimal-cognition`: layers of sensory, inner and motor neurons that are the same left and right.
mod network;
/// The falling objects of `minimal-cognition`, and their intersections with rays.
mod object;

pub use config::Config;
pub use episode::AgentEpisode;
pub use experiment::{Agent, MinimalCognition, evaluator};
pub use network::{INNER, LAYOUT, MOTORS, NEURONS, RAYS, Wiring};
pub use object::Object;
