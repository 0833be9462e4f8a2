//! The experiment `kinesthetic-grasp`, in which a network learns to grasp from demonstrations.

/// The demonstrator: the scripted grasp, with the network's own commands mixed in.
mod demonstrator;
/// Its name, conditions and settings, and what runs its trials.
mod experiment;
/// Imitation learning: the arm is guided, and a network learns by back-propagation through time what its motors should
/// do.
mod trainer;

pub use experiment::{Config, KinestheticGrasp, Trainee};
pub use trainer::Training;
