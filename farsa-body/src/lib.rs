// The examples of the README build descriptions, which need `alloc`.
#![cfg_attr(feature = "alloc", doc = include_str!("../README.md"))]
#![cfg_attr(
    not(feature = "alloc"),
    doc = "Actuators, ports, sensors and motors of robots; the feature `alloc` adds descriptions."
)]
#![cfg_attr(docsrs, feature(doc_cfg))]
#![no_std]

#[cfg(feature = "alloc")]
extern crate alloc;

pub mod actuators;
/// The error of constructors of sensors, motors and wrappers, and writing to slices that may be short.
mod channel;
/// Sensors and motors made of sensors and motors.
mod compose;
#[cfg(feature = "alloc")]
pub mod kinematics;
pub mod motors;
pub mod ports;
/// Positions, orientations and velocities.
mod pose;
pub mod prelude;
/// The recorder of an episode, tick by tick.
mod recorder;
#[cfg(feature = "alloc")]
pub mod robot;
#[cfg(feature = "alloc")]
pub mod robots;
pub mod sensors;
#[cfg(feature = "alloc")]
pub mod testing;
pub mod wrappers;

pub use channel::ChannelError;
pub use pose::{Pose, Twist};
pub use recorder::{Recorder, record_world};
