//! A binary format for trained networks. You can store it in flash memory or files, or send it over a wire. It is
//! specified in `docs/controller-format.md`.
//!
//! All bytes are checked when a network is read. Reading never allocates or panics, and the parameters are used in
//! place.

/// Networks of blocks.
mod block;
/// Continuous-time networks.
mod ctrnn;
/// Errors.
mod error;
/// The common frame: head, parameters, checksum.
mod frame;
/// Leaky networks.
mod leaky;
/// The reader that all kinds share.
mod network;
/// Single layers.
mod perceptron;
/// Leaky networks in integers.
mod quantized;

pub use block::BlockNetworkBytes;
pub use ctrnn::CtrnnBytes;
pub use error::{BytesError, Field, Table};
pub use frame::{Aligned, channel_hash};
pub use leaky::LeakyNetworkBytes;
pub use network::NetworkBytes;
pub use perceptron::PerceptronBytes;
pub use quantized::QuantizedNetworkBytes;
