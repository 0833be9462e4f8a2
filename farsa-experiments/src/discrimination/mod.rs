//! The experiments `discrimination` and `discrimination-cylinders`: what a robot finds by its infrared sensors.
//!
//! - `config`: the values of `discrimination` and `discrimination-cylinders`, as settings
//! - `cylinders`: the experiment `discrimination-cylinders`: a large and a small cylinder, distinguished by moving
//! - `experiment`: its name, conditions and settings, and what runs its trials
//! - `episode`: an episode of `discrimination` and `discrimination-cylinders`: one trial among cylinders, up to its
//!   last step or a collision

mod config;
mod cylinders;
mod episode;
mod experiment;

pub use crate::infrared::{settings::Infrared, settings::InfraredModel};
pub use crate::worlds::PlanarEngine;
pub use config::{Config, EYES};
pub use cylinders::DiscriminationCylinders;
pub use episode::{CYLINDERS, CylinderEpisode, Trial};
#[cfg(feature = "rapier")]
pub use experiment::evaluator_in_rapier;
pub use experiment::{Discrimination, Layer, evaluator};
