#![doc = include_str!("../README.md")]
#![cfg_attr(docsrs, feature(doc_cfg))]
#![no_std]

#[cfg(any(test, all(target_arch = "wasm32", feature = "std")))]
extern crate std;

mod atan;
mod digest;
mod exp;
mod instructions;
mod lanes;
mod logarithm;
mod normal;
mod philox;
mod polynomial;
#[cfg(feature = "rand_core")]
mod rng;
mod scalar;
mod sin_cos;
mod square_root;

pub use atan::{acos, asin, atan2};
pub use digest::{Crc32, Digest, crc32};
pub use exp::{exp, logistic, tanh};
pub use fearless_simd;
pub use instructions::Instructions;
pub use logarithm::ln;
pub use philox::{Domain, Stream, philox};
pub use scalar::{Mask, Real, Scalar};
pub use sin_cos::sin_cos;
