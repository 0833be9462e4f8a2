//! Learning from demonstrations by back-propagation.

/// Back-propagation through block networks.
#[cfg(feature = "alloc")]
mod blocks;
/// Back-propagation through continuous-time networks.
#[cfg(feature = "alloc")]
mod ctrnn;
/// Networks through which a cost can be propagated back.
#[cfg(feature = "alloc")]
mod differentiable;
/// The gradient of the cost of demonstrations.
#[cfg(feature = "alloc")]
mod gradient;
/// Back-propagation through leaky networks.
#[cfg(feature = "alloc")]
mod leaky;
/// A network that learns.
#[cfg(feature = "alloc")]
mod learner;
/// Costs of motor values.
#[cfg(feature = "alloc")]
mod loss;
/// Optimizers.
mod optimizer;
/// Back-propagation through a single layer.
#[cfg(feature = "alloc")]
mod perceptron;
/// Sums over weights.
#[cfg(feature = "alloc")]
mod sums;

#[cfg(feature = "alloc")]
pub use differentiable::{Demonstration, Differentiable, Domain};
#[cfg(feature = "alloc")]
pub use gradient::Gradient;
#[cfg(feature = "alloc")]
pub use learner::Learner;
#[cfg(feature = "alloc")]
pub use loss::Loss;
pub use optimizer::{Adam, Momentum, Optimizer};
