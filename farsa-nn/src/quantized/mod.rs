//! The leaky network in integers, for processors without floating-point arithmetic.

/// The logistic function: a table and a line between its entries.
mod logistic;
/// The network: integer parameters, state, steps.
pub(crate) mod network;
/// What its integers stand for, and how real parameters become such integers.
pub(crate) mod scale;

pub use network::QuantizedNetwork;
pub use scale::QuantizedScale;
