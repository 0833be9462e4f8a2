#![doc = include_str!("../README.md")]
#![cfg_attr(docsrs, feature(doc_cfg))]
#![no_std]

#[cfg(feature = "alloc")]
extern crate alloc;

mod activation;
pub mod block;
pub mod bytes;
mod controller;
mod ctrnn;
mod error;
pub mod fault;
mod kernel;
mod leak;
mod leaky_layout;
mod leaky_network;
pub mod learning;
mod lesion;
mod name;
mod network;
mod perceptron;
mod perceptron_lanes;
pub mod quantized;
mod wide_layer;

pub use activation::Activation;
pub use controller::Controller;
pub use ctrnn::{Ctrnn, CtrnnLayout, CtrnnParameter, CtrnnParts, CtrnnSymmetry, Integrator};
pub use error::Error;
pub use leak::Leak;
pub use leaky_layout::{LeakyLayout, LeakyParameter, LeakyParts};
pub use leaky_network::LeakyNetwork;
pub use lesion::{Ablatable, Lesion, Lesioned};
pub use network::Network;
pub use perceptron::Perceptron;
pub use perceptron_lanes::PerceptronLanes;
