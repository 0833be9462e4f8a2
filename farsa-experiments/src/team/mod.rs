//! What experiments with teams of wheeled robots share.
//!
//! - `config`: what experiments with many wheeled robots have in common, as settings
//! - `eyes`: what a robot of a team senses of its surroundings
//! - `episode`: an episode of a team: robots with a controller each, and a scenario that says what they are to do
//! - `nest`: nests as robots of a team sense them: the ground, and what shines
//! - `robots`: robots with a controller each: what they sense, compute and do
//! - `task`: the task of a team: what is known of a scenario, and its episodes over parameters
//! - `steering`: how a robot of a team turns away from what it sees, for controllers without evolution

pub(crate) mod config;
pub(crate) mod episode;
pub(crate) mod eyes;
pub(crate) mod nest;
pub(crate) mod robots;
pub(crate) mod steering;
pub(crate) mod task;
