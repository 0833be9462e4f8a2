//! Leaky networks in integer arithmetic, for processors without floating-point instructions.

/// The logistic function: a table and a line between its entries.
mod logistic;
/// The network: integer parameters, state, steps.
pub(crate) mod network;
/// The scale of the integers, and the conversion of real parameters.
pub(crate) mod scale;

pub use network::QuantizedNetwork;
pub use scale::QuantizedScale;
