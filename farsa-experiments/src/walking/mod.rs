//! The experiments `passive-walker` and `body-evolution`, and the simplest walking model.
//!
//! - `body_evolution`: the experiment `body-evolution`: the body of a walker evolves, alone or with a network at its hip
//! - `gait`: what a walker's feet do: which of them stands, when they change places, and how the walk ends
//! - `life`: a life of a walker: a launch, then steps until it falls or its time is over; with or without a network at the hip
//! - `passive_walker`: the experiment `passive-walker`: two legs walk down a slope by themselves
//! - `settings`: the settings that all experiments with walkers have, and how a walk is lived and told
//! - `simplest_model`: the simplest walking model: two massless legs, a mass at the hip, feet of vanishing mass, on a slope
//! - `stage`: what is to be seen and told of a walker
//! - `walker`: a biped of two stiff pairs of legs, as data: the rigid body that the simplest walking model is the limit of

pub mod body_evolution;
mod gait;
mod life;
pub mod passive_walker;
mod settings;
mod simplest_model;
mod stage;
mod walker;

pub use simplest_model::{ModelGait, ModelStep, SLOPES, SlopeError, WalkingModel};
