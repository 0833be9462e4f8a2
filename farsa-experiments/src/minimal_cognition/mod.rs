//! The experiment `minimal-cognition`: categorical perception.
//!
//! - `config`: the values of `minimal-cognition`, as settings
//! - `experiment`: its name, conditions and settings, and what runs its trials
//! - `episode`: an episode of `minimal-cognition`: one object falls, and the agent moves under it
//! - `network`: the network of `minimal-cognition`: layers of sensory, inner and motor neurons that are the same left and right
//! - `object`: what falls in `minimal-cognition`, and where a ray meets it

mod config;
mod episode;
mod experiment;
mod network;
mod object;

pub use config::Config;
pub use episode::AgentEpisode;
pub use experiment::{Agent, MinimalCognition, evaluator};
pub use network::{INNER, LAYOUT, MOTORS, NEURONS, RAYS, Wiring};
pub use object::Object;
