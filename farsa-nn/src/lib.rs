#![doc = include_str!("../README.md")]
#![no_std]

mod activation;
mod controller;
mod ctrnn;
mod ctrnn_layout;
mod dynamics;
mod error;
mod integrator;
mod kernel;
mod layout;
mod leak;
mod name;
mod network;
mod perceptron;
mod perceptron_lanes;

pub use activation::Activation;
pub use controller::Controller;
pub use ctrnn::Ctrnn;
pub use ctrnn_layout::{CtrnnLayout, CtrnnParameter, CtrnnParts};
pub use error::Error;
pub use integrator::Integrator;
pub use layout::{Layout, ParameterKind, Parts};
pub use leak::Leak;
pub use network::Network;
pub use perceptron::Perceptron;
pub use perceptron_lanes::PerceptronLanes;
