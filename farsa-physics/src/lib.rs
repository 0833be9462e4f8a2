#![doc = include_str!("../README.md")]
#![no_std]

#[cfg(feature = "alloc")]
extern crate alloc;

#[cfg(feature = "alloc")]
pub mod arena;
pub mod articulated;
#[cfg(feature = "rapier")]
pub mod rapier;
