//! Strategies that follow an estimated gradient of the expected fitness in the space of real genes.

/// Augmented random search.
mod ars;
/// The exponential of a symmetric matrix.
mod matrix_exponential;
/// Mirrored samples around a point.
mod mirrored;
/// Random numbers of a generation.
mod noise;
/// Running mean and variance of observations.
pub(crate) mod observation_statistics;
/// The evolution strategy of OpenAI.
mod open_ai_es;
/// Steps from gradients.
mod optimizer;
/// Policy gradients with parameter-based exploration.
mod pgpe;
/// Ranges of configurations and states.
mod settings;
/// The separable natural evolution strategy.
mod snes;
/// Replacements for the values of fitness.
mod utilities;
/// The exponential natural evolution strategy.
mod xnes;

pub use ars::{Ars, ArsConfig};
pub use open_ai_es::{OpenAiEs, OpenAiEsConfig};
pub use optimizer::Optimizer;
pub use pgpe::{Pgpe, PgpeConfig, PgpeFitness};
pub use snes::{Snes, SnesConfig};
pub use xnes::{Xnes, XnesConfig};
