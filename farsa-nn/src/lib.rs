#![doc = include_str!("../README.md")]
#![no_std]

#[cfg(feature = "alloc")]
extern crate alloc;

mod activation;
mod architecture;
mod block;
mod bytes;
mod centre_crossing;
mod controller;
mod ctrnn;
mod ctrnn_layout;
mod dynamics;
mod error;
mod evonet;
#[cfg(feature = "alloc")]
mod evonet_text;
#[cfg(feature = "alloc")]
mod gradient;
mod integrator;
mod kernel;
mod leak;
mod leaky_layout;
mod leaky_network;
#[cfg(feature = "alloc")]
mod learner;
mod lesion;
mod name;
mod optimizer;
mod perceptron;
mod perceptron_lanes;
mod quantized;
mod symmetry;
mod wide_layer;

pub use activation::Activation;
pub use architecture::{Architecture, Plan};
#[cfg(feature = "alloc")]
pub use block::BlockLayoutBuf;
pub use block::{Block, BlockLayout, BlockNetwork, BlockParameter, Group, Span};
pub use bytes::{Aligned, BytesError, CtrnnBytes, LeakyNetworkBytes, QuantizedNetworkBytes, channel_hash};
pub use controller::Controller;
pub use ctrnn::Ctrnn;
pub use ctrnn_layout::{CtrnnLayout, CtrnnParameter, CtrnnParts};
pub use error::Error;
pub use evonet::EvonetRanges;
#[cfg(feature = "alloc")]
pub use evonet_text::Evonet;
#[cfg(feature = "alloc")]
pub use gradient::{Demonstration, Gradient, Loss};
pub use integrator::Integrator;
pub use leak::Leak;
pub use leaky_layout::{LeakyLayout, LeakyParameter, LeakyParts};
pub use leaky_network::LeakyNetwork;
#[cfg(feature = "alloc")]
pub use learner::Learner;
pub use lesion::{Lesion, Lesioned, Neurons};
pub use optimizer::{Adam, Momentum, Optimizer};
pub use perceptron::Perceptron;
pub use perceptron_lanes::PerceptronLanes;
pub use quantized::{QuantizedNetwork, QuantizedScale};
pub use symmetry::CtrnnSymmetry;
