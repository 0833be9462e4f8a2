//! Continuous-time recurrent networks.

/// Biases that place every neuron where its function is steepest.
mod centre_crossing;
/// One step, over the lanes of a scalar.
mod dynamics;
/// Integrators.
pub(crate) mod integrator;
/// The shape of a network and the order of its parameters.
pub(crate) mod layout;
/// The network: parameters, states, steps.
pub(crate) mod network;
/// Few genes for a network with mirror symmetry.
mod symmetry;

pub use integrator::Integrator;
pub use layout::{CtrnnLayout, CtrnnParameter, CtrnnParts};
pub use network::Ctrnn;
pub use symmetry::CtrnnSymmetry;
