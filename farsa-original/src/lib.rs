#![doc = include_str!("../README.md")]
#![cfg_attr(test, allow(clippy::unwrap_used))]
#![cfg_attr(docsrs, feature(doc_cfg))]

/// Names, channels and noise of sensors and motors.
mod channels;
/// The evolutionary algorithm.
mod evolution;
/// Steps, trials, arena and plugin.
mod experiment;
/// Typed access to the keys of a group.
mod group;
/// The conversion of a whole configuration.
mod import;
/// The INI format of the 2013 program.
mod ini;
/// Motors.
mod motor;
/// The network.
mod network;
/// Lines that cannot be converted, with reasons.
mod remarks;
/// The robot.
mod robot;
/// Sensors.
mod sensor;
/// The text of the experiment file.
mod written;

pub use import::{from_original, from_original_within};
