//! Sums over the weights of a layer, and derivatives of activations.

use farsa_num::Real;

use crate::activation::Activation;

/// `to_i += sum_j source_j w_ji`, source-major, the sources in their order.
pub(crate) fn add_rows<R: Real>(to: &mut [R], sources: impl Iterator<Item = R>, weights: &[R]) {
    for (source, row) in sources.zip(weights.chunks_exact(to.len().max(1))) {
        for (to, w) in to.iter_mut().zip(row) {
            *to += source * *w;
        }
    }
}

/// `sum_ji += source_j through_i`.
pub(crate) fn add_products<R: Real>(sum: &mut [R], sources: impl Iterator<Item = R>, through: &[R]) {
    for (source, row) in sources.zip(sum.chunks_exact_mut(through.len().max(1))) {
        for (sum, through) in row.iter_mut().zip(through) {
            *sum += source * *through;
        }
    }
}

/// `to_j += sum_i w_ji through_i`.
pub(crate) fn add_transposed<R: Real>(to: &mut [R], weights: &[R], through: &[R]) {
    for (to, row) in to.iter_mut().zip(weights.chunks_exact(through.len().max(1))) {
        let mut sum = R::default();
        for (w, through) in row.iter().zip(through) {
            sum += *w * *through;
        }
        *to += sum;
    }
}

/// Derivative of an activation by its argument, from its value.
pub(crate) fn activation_slope<R: Real>(activation: Activation, value: R) -> R {
    let one = R::from_f64(1.0);
    match activation {
        Activation::Logistic => value * (one - value),
        Activation::Tanh => one - value * value,
        Activation::Linear => one,
        Activation::Rectified if value > R::default() => one,
        Activation::Step | Activation::Rectified => R::default(),
    }
}
