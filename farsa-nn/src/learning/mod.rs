//! Learning from demonstrations by back-propagation.

/// The gradient of the cost of demonstrations.
#[cfg(feature = "alloc")]
mod gradient;
/// A network that learns.
#[cfg(feature = "alloc")]
mod learner;
/// Optimizers.
mod optimizer;

#[cfg(feature = "alloc")]
pub use gradient::{Demonstration, Gradient, Loss};
#[cfg(feature = "alloc")]
pub use learner::Learner;
pub use optimizer::{Adam, Momentum, Optimizer};
