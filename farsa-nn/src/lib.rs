#![doc = include_str!("../README.md")]
#![no_std]

#[cfg(feature = "alloc")]
extern crate alloc;

mod controller;
mod error;
mod fixed_logistic;
mod fixed_network;
mod fixed_scale;
#[cfg(feature = "alloc")]
mod gradient;
mod kernel;
mod layout;
mod leak;
#[cfg(feature = "alloc")]
mod learner;
mod network;
mod optimizer;
mod perceptron;
mod perceptron_lanes;

pub use controller::Controller;
pub use error::Error;
pub use fixed_network::FixedNetwork;
pub use fixed_scale::FixedScale;
#[cfg(feature = "alloc")]
pub use gradient::{Demonstration, Gradient, Loss};
pub use layout::{Layout, ParameterKind, Parts};
pub use leak::Leak;
#[cfg(feature = "alloc")]
pub use learner::Learner;
pub use network::Network;
pub use optimizer::{Adam, Momentum, Optimizer};
pub use perceptron::Perceptron;
pub use perceptron_lanes::PerceptronLanes;
