//! The experiments `passive-walker` and `body-evolution`, and the simplest walking model.

/// The experiment `body-evolution`. It evolves the body of a walker and optionally a network at its hip.
pub mod body_evolution;
/// An episode of a walker, with or without a network at the hip: a launch, then steps until it falls or its time is
/// over.
mod episode;
/// The feet of a walker: stance and swing, the change between them, and the end of the walk.
mod gait;
/// The experiment `passive-walker`, in which two legs walk down a slope without a motor.
pub mod passive_walker;
/// The recording of a walker, and its shapes.
mod schema;
/// The settings that all experiments with walkers have, and how a walk is run and recorded.
mod settings;
/// The simplest walking model: two massless legs, a mass at the hip, feet of vanishing mass, on a slope.
mod simplest_model;
/// A biped of two stiff pairs of legs, as data: the rigid body that the simplest walking model is the limit of.
mod walker;

pub use simplest_model::{ModelGait, ModelStep, SLOPES, SlopeError, WalkingModel};
