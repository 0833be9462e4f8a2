//! Evolution strategies that adapt the covariance matrix of a normal distribution.
//!
//! - `cma_es`: [`CmaEs`], with a full matrix.
//! - `separable_cma_es`: [`SeparableCmaEs`], with a diagonal one.
//! - `restarts`: [`CmaEsRestarts`], runs of `cma_es` one after the other.
//! - `search`: what `cma_es` and `separable_cma_es` do alike.
//! - `termination`: when such a run ends.
//! - `distribution`: the distribution that is drawn from and adapted, whatever its covariance.
//! - `full`, `diagonal`: the two kinds of covariance.
//! - `coefficients`: weights and learning rates.
//! - `eigen`: eigenvalues and eigenvectors of a symmetric matrix.
//! - `linear`: sums over rows of numbers.

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

pub use cma_es::{CmaEs, CmaEsConfig};
pub use restarts::{CmaEsRestarts, CmaEsRestartsConfig, RestartSchedule};
pub use separable_cma_es::{SeparableCmaEs, SeparableCmaEsConfig};
