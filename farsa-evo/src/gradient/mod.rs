//! Strategies that follow an estimated gradient of the expected fitness in the space of real genes.
//!
//! - `snes`, `xnes`: natural evolution strategies, separable and with a full covariance.
//! - `open_ai_es`, `pgpe`, `ars`: mirrored sampling around one point, for genomes of many genes.
//! - `utilities`, `centred_ranks`, `rewards`: what stands in for the values of fitness.
//! - `optimizer`, `adam`, `clip_up`: how a gradient becomes a step.
//! - `noise`: the random numbers, and genomes made of them.
//! - `matrix_exponential`: of a symmetric matrix.
//! - `settings`: what the numbers of a configuration and of a state may be.
//! - `observation_statistics`: running mean and variance of what networks sense.

mod adam;
mod ars;
mod centred_ranks;
mod clip_up;
mod matrix_exponential;
mod noise;
pub(crate) mod observation_statistics;
mod open_ai_es;
mod optimizer;
mod pgpe;
mod rewards;
mod settings;
mod snes;
mod utilities;
mod xnes;

pub use ars::{Ars, ArsConfig};
pub use open_ai_es::{OpenAiEs, OpenAiEsConfig};
pub use optimizer::Optimizer;
pub use pgpe::{Pgpe, PgpeConfig, PgpeFitness};
pub use snes::{Snes, SnesConfig};
pub use xnes::{Xnes, XnesConfig};
