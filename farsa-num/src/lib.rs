#![doc = include_str!("../README.md")]
#![no_std]

mod lanes;
mod scalar;

pub use fearless_simd;
pub use scalar::{Mask, Real, Scalar};
