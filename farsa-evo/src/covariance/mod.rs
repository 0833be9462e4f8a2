//! Evolution strategies that adapt a covariance matrix.
//!
//! - `eigen`: eigenvalues and eigenvectors of a symmetric matrix.
//! - `linear`: sums over rows of numbers.

mod eigen;
mod linear;
