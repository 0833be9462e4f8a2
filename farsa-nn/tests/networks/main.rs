//! Networks of every kind, against closed forms, scipy and each other.
#![allow(missing_docs, clippy::unwrap_used)]

mod blocks;
mod ctrnn;
mod ctrnn_scipy;
mod evonet;
mod gradient;
mod gradients;
mod leaky_network;
mod perceptron;
mod saved;
mod sizes;
mod symmetry;
