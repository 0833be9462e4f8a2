//! Descriptions of robots, sensors and motors, and what a world owes them.
#![allow(missing_docs, clippy::unwrap_used)]

#[cfg(feature = "alloc")]
mod arm_and_hand;
#[cfg(feature = "alloc")]
mod cameras;
#[cfg(feature = "alloc")]
mod conformance;
#[cfg(feature = "alloc")]
mod descriptions;
#[cfg(feature = "alloc")]
mod eyes;
#[cfg(feature = "alloc")]
mod icub;
#[cfg(feature = "alloc")]
mod inverse_kinematics;
mod lanes;
#[cfg(feature = "alloc")]
mod mobile;
#[cfg(feature = "alloc")]
mod planar_conformance;
#[cfg(feature = "alloc")]
mod planar_sensors;
#[cfg(feature = "alloc")]
mod rays_left_out;
#[cfg(feature = "alloc")]
mod sensors_and_motors;
mod serialised;
#[cfg(feature = "alloc")]
mod shared;
#[cfg(feature = "alloc")]
mod turned_scenes;
#[cfg(feature = "alloc")]
mod vehicles;
#[cfg(feature = "alloc")]
mod wrappers;
