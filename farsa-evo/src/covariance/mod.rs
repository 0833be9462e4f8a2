//! Evolution strategies that adapt the covariance matrix of a normal distribution.
//!
//! - `cma_es`: [`CmaEs`], with a full matrix.
//! - `cholesky_cma_es`: [`CholeskyCmaEs`], with a full matrix and its triangular factor.
//! - `separable_cma_es`: [`SeparableCmaEs`], with a diagonal one.
//! - `restarts`: [`CmaEsRestarts`], runs of `cma_es` one after the other.
//! - `search`: what they do alike.
//! - `termination`: when such a run ends.
//! - `distribution`: the distribution that is drawn from and adapted, whatever its covariance.
//! - `full`, `cholesky`, `diagonal`: the kinds of covariance.
//! - `coefficients`: weights and learning rates.
//! - `eigen`: eigenvalues and eigenvectors of a symmetric matrix.
//! - `linear`: sums over rows of numbers.

mod cholesky;
mod cholesky_cma_es;
mod cma_es;
pub(crate) mod coefficients;
mod diagonal;
pub(crate) mod distribution;
mod eigen;
pub(crate) mod full;
mod linear;
mod restarts;
mod search;
mod separable_cma_es;
mod termination;

pub use cholesky_cma_es::CholeskyCmaEs;
pub use cma_es::{CmaEs, CmaEsConfig};
pub use restarts::{CmaEsRestarts, CmaEsRestartsConfig, RestartSchedule};
pub use separable_cma_es::{SeparableCmaEs, SeparableCmaEsConfig};
