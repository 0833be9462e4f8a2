//! The experiment `kinesthetic-grasp`: the arm is led, and the network learns to do it alone.
//!
//! - `demonstrator`: who leads the arm: the scripted grasp, with the network's own commands mixed in
//! - `experiment`: its name, conditions and settings, and what lives its lives
//! - `training`: Lessons: the arm is led, and a network learns by back-propagation through time what its motors should have done

mod demonstrator;
mod experiment;
mod training;

pub use experiment::{Config, KinestheticGrasp, Trainee};
pub use training::Lessons;
