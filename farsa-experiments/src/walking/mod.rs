//! The experiments `passive-walker` and `body-evolution`, and the simplest walking model.
//!
//! - `body_evolution`: the experiment `body-evolution`: the body of a walker evolves, alone or with a network at its hip
//! - `gait`: what a walker's feet do: which of them stands, when they change places, and how the walk ends
//! - `episode`: an episode of a walker: a launch, then steps until it falls or its time is over; with or without a
//!   network at the hip
//! - `passive_walker`: the experiment `passive-walker`: two legs walk down a slope by themselves
//! - `settings`: the settings that all experiments with walkers have, and how a walk is run and recorded
//! - `simplest_model`: the simplest walking model: two massless legs, a mass at the hip, feet of vanishing mass, on a slope
//! - `schema`: what a recording of a walker holds, and its shapes
//! - `walker`: a biped of two stiff pairs of legs, as data: the rigid body that the simplest walking model is the limit of

pub mod body_evolution;
mod episode;
mod gait;
pub mod passive_walker;
mod schema;
mod settings;
mod simplest_model;
mod walker;

pub use simplest_model::{ModelGait, ModelStep, SLOPES, SlopeError, WalkingModel};
