//! The experiment `braitenberg`: vehicles wired by hand.
//!
//! - `experiment`: its name, conditions and settings, and what runs its trials
//! - `episode`: a vehicle of `braitenberg`: its wiring, and a trial beside a lamp

mod episode;
mod experiment;

pub use episode::{Config, LIGHTS, Vehicle, VehicleEpisode, Wiring};
pub use experiment::{Braitenberg, evaluator};
