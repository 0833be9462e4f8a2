#![doc = include_str!("../README.md")]
#![no_std]

#[cfg(feature = "alloc")]
extern crate alloc;

mod activation;
mod architecture;
mod block;
mod bytes;
mod controller;
mod ctrnn;
mod error;
mod evonet;
#[cfg(feature = "alloc")]
mod evonet_text;
mod kernel;
mod leak;
mod leaky_layout;
mod leaky_network;
mod learning;
mod lesion;
mod name;
mod perceptron;
mod perceptron_lanes;
mod quantized;
mod wide_layer;

pub use activation::Activation;
pub use architecture::{Architecture, BlockPlan};
#[cfg(feature = "alloc")]
pub use block::BlockLayoutBuf;
pub use block::{Block, BlockLayout, BlockNetwork, BlockParameter, Group, Span};
pub use bytes::{
    Aligned, BlockNetworkBytes, BytesError, CtrnnBytes, LeakyNetworkBytes, PerceptronBytes, QuantizedNetworkBytes,
    channel_hash,
};
pub use controller::Controller;
pub use ctrnn::{Ctrnn, CtrnnLayout, CtrnnParameter, CtrnnParts, CtrnnSymmetry, Integrator};
pub use error::Error;
pub use evonet::EvonetRanges;
#[cfg(feature = "alloc")]
pub use evonet_text::Evonet;
pub use leak::Leak;
pub use leaky_layout::{LeakyLayout, LeakyParameter, LeakyParts};
pub use leaky_network::LeakyNetwork;
pub use learning::{Adam, Momentum, Optimizer};
#[cfg(feature = "alloc")]
pub use learning::{Demonstration, Gradient, Learner, Loss};
pub use lesion::{Ablatable, Lesion, Lesioned};
pub use perceptron::Perceptron;
pub use perceptron_lanes::PerceptronLanes;
pub use quantized::{QuantizedNetwork, QuantizedScale};
