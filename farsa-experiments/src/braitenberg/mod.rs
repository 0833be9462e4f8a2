//! The experiment `braitenberg`: vehicles wired by hand.
//!
//! - `experiment`: its name, conditions and settings, and what lives its lives
//! - `life`: a vehicle of `braitenberg`: its wiring, and a trial beside a lamp

mod experiment;
mod life;

pub use experiment::{Braitenberg, evaluator};
pub use life::{Config, LIGHTS, Vehicle, VehicleLife, Wiring};
