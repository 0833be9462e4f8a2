//! Trained networks as bytes: in flash, in a file, over a wire. The format is `docs/controller-format.md`.

/// Of a network of blocks.
mod block;
/// Of a continuous-time network.
mod ctrnn;
/// What can be wrong with bytes.
mod error;
/// What the bytes of all kinds have in common: head, channels, parameters, checksum.
mod frame;
/// Of the leaky network.
mod leaky;
/// Of the single layer.
mod perceptron;
/// Of the leaky network in integers.
mod quantized;

pub use block::BlockNetworkBytes;
pub use ctrnn::CtrnnBytes;
pub use error::BytesError;
pub use frame::{Aligned, channel_hash};
pub use leaky::LeakyNetworkBytes;
pub use perceptron::PerceptronBytes;
pub use quantized::QuantizedNetworkBytes;
