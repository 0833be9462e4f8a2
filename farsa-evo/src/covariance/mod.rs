//! Evolution strategies that adapt the covariance matrix of a normal distribution.
//!
//! [`CmaEs`] searches with a full matrix, [`CholeskyCmaEs`] with its triangular factor, [`SeparableCmaEs`] with its diagonal.
//! [`CmaEsRestarts`] runs [`CmaEs`] several times with growing populations.

/// The triangular factor.
mod cholesky;
/// The searches.
mod cma_es;
/// Weights and learning rates.
pub(crate) mod coefficients;
mod config;
/// One variance for each gene.
mod diagonal;
/// The normal distribution.
pub(crate) mod distribution;
/// Eigenvalues and eigenvectors.
mod eigen;
/// The full matrix.
pub(crate) mod full;
/// Sums over rows.
mod linear;
/// Runs with growing populations.
mod restarts;
/// Termination criteria of a run.
mod termination;

pub use cholesky::Cholesky;
pub use cma_es::{CholeskyCmaEs, CmaEs, SeparableCmaEs};
pub use config::{CmaEsConfig, SeparableCmaEsConfig};
pub use diagonal::Diagonal;
pub use distribution::Covariance;
pub use full::Full;
pub use restarts::{CmaEsRestarts, CmaEsRestartsConfig, RestartSchedule};
