#![doc = include_str!("../README.md")]
#![no_std]

mod controller;
mod error;
mod fixed_logistic;
mod fixed_network;
mod fixed_scale;
mod kernel;
mod layout;
mod leak;
mod network;
mod perceptron;
mod perceptron_lanes;

pub use controller::Controller;
pub use error::Error;
pub use fixed_network::FixedNetwork;
pub use fixed_scale::FixedScale;
pub use layout::{Layout, ParameterKind, Parts};
pub use leak::Leak;
pub use network::Network;
pub use perceptron::Perceptron;
pub use perceptron_lanes::PerceptronLanes;
