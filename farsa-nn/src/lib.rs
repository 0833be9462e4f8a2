#![doc = include_str!("../README.md")]
#![no_std]

#[cfg(feature = "alloc")]
extern crate alloc;

mod activation;
mod architecture;
mod block;
mod block_kernel;
mod block_layout;
#[cfg(feature = "alloc")]
mod block_layout_buf;
mod block_network;
mod bytes;
mod bytes_ctrnn;
mod bytes_error;
mod bytes_fixed;
mod bytes_frame;
mod centre_crossing;
mod controller;
mod ctrnn;
mod ctrnn_layout;
mod dynamics;
mod error;
mod evonet;
#[cfg(feature = "alloc")]
mod evonet_text;
mod fixed_logistic;
mod fixed_network;
mod fixed_scale;
#[cfg(feature = "alloc")]
mod gradient;
mod integrator;
mod kernel;
mod layout;
mod leak;
#[cfg(feature = "alloc")]
mod learner;
mod lesion;
mod name;
mod network;
mod optimizer;
mod perceptron;
mod perceptron_lanes;
mod symmetry;
mod wide_layer;

pub use activation::Activation;
pub use architecture::{Architecture, Plan};
pub use block::{Block, Group, Span};
pub use block_layout::{BlockLayout, BlockParameter};
#[cfg(feature = "alloc")]
pub use block_layout_buf::BlockLayoutBuf;
pub use block_network::BlockNetwork;
pub use bytes::{Aligned, NetworkBytes, channel_hash};
pub use bytes_ctrnn::CtrnnBytes;
pub use bytes_error::BytesError;
pub use bytes_fixed::FixedNetworkBytes;
pub use controller::Controller;
pub use ctrnn::Ctrnn;
pub use ctrnn_layout::{CtrnnLayout, CtrnnParameter, CtrnnParts};
pub use error::Error;
pub use evonet::EvonetRanges;
#[cfg(feature = "alloc")]
pub use evonet_text::Evonet;
pub use fixed_network::FixedNetwork;
pub use fixed_scale::FixedScale;
#[cfg(feature = "alloc")]
pub use gradient::{Demonstration, Gradient, Loss};
pub use integrator::Integrator;
pub use layout::{Layout, ParameterKind, Parts};
pub use leak::Leak;
#[cfg(feature = "alloc")]
pub use learner::Learner;
pub use lesion::{Lesion, Lesioned, Neurons};
pub use network::Network;
pub use optimizer::{Adam, Momentum, Optimizer};
pub use perceptron::Perceptron;
pub use perceptron_lanes::PerceptronLanes;
pub use symmetry::CtrnnSymmetry;
