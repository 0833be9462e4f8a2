#![doc = include_str!("../README.md")]
#![no_std]

mod bytes;
mod bytes_error;
mod bytes_frame;
mod controller;
mod error;
mod kernel;
mod layout;
mod leak;
mod network;
mod perceptron;
mod perceptron_lanes;

pub use bytes::{Aligned, NetworkBytes, channel_hash};
pub use bytes_error::BytesError;
pub use controller::Controller;
pub use error::Error;
pub use layout::{Layout, ParameterKind, Parts};
pub use leak::Leak;
pub use network::Network;
pub use perceptron::Perceptron;
pub use perceptron_lanes::PerceptronLanes;
