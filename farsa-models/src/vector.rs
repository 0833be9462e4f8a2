//! Products and lengths of vectors, in one order of arithmetic.

use farsa_num::Scalar;

pub(crate) fn dot(a: [f64; 3], b: [f64; 3]) -> f64 {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}

pub(crate) fn sub(a: [f64; 3], b: [f64; 3]) -> [f64; 3] {
    [a[0] - b[0], a[1] - b[1], a[2] - b[2]]
}

pub(crate) fn cross(a: [f64; 3], b: [f64; 3]) -> [f64; 3] {
    [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]]
}

/// Computes the Euclidean length.
pub(crate) fn norm(v: &[f64]) -> f64 {
    Scalar::sqrt(v.iter().fold(0.0, |sum, x| sum + *x * *x))
}
