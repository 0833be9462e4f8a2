//! Optimizers: rules that follow a gradient downhill.

use farsa_num::Real;

/// A rule that changes parameters by a gradient. The caller provides its memory.
///
/// The rule itself is a few numbers. Its memory is a slice of initial zeros, so a checkpoint is a copy of two slices.
///
/// # For implementors
/// - The same calls on the same memory give the same bits on every machine: + - * / and square root, in a fixed order.
/// - Use the shorter length of `gradient` and `parameters`.
pub trait Optimizer<R: Real> {
    /// Length of the memory for a number of parameters.
    fn memory_len(&self, parameters: usize) -> usize;
    /// Changes the parameters by a gradient \[parameters\]. `memory` [[`memory_len`](Self::memory_len)] must be zeros before the
    /// first step.
    fn step(&self, gradient: &[R], parameters: &mut [R], memory: &mut [R]);
}

/// Steepest descent with momentum: `v = momentum*v - rate*g`, `p = p + v`.
///
/// Source: `[Rumelhart1986]` eq. 9, for single steps. With momentum 0 it is plain descent.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct Momentum {
    /// Factor on the gradient.
    pub rate: f64,
    /// The share of a change that the next step keeps, [0, 1).
    pub momentum: f64,
}

impl<R: Real> Optimizer<R> for Momentum {
    fn memory_len(&self, parameters: usize) -> usize {
        parameters
    }

    fn step(&self, gradient: &[R], parameters: &mut [R], memory: &mut [R]) {
        let (rate, momentum) = (R::from_f64(self.rate), R::from_f64(self.momentum));
        for ((p, g), v) in parameters.iter_mut().zip(gradient).zip(memory) {
            *v = momentum * *v - rate * *g;
            *p += *v;
        }
    }
}

/// Adam: every parameter takes steps of about `rate`, independent of the size of its gradient.
///
/// Source: `[Kingma2015]` algorithm 1. Deviation: the powers of the decays are stored as `1 - beta^t`, by repeated products, so the
/// initial memory is zeros.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct Adam {
    /// Size of a step.
    pub rate: f64,
    /// The shares of the mean gradient and of the mean of its squares that the next step keeps, each in [0, 1).
    pub decays: [f64; 2],
    /// Added to the root of the mean square.
    pub epsilon: f64,
}

impl Adam {
    /// Builds Adam with this step size and the other defaults of the source.
    pub const fn new(rate: f64) -> Self {
        Self { rate, decays: [0.9, 0.999], epsilon: 1e-8 }
    }
}

impl<R: Real> Optimizer<R> for Adam {
    /// Two means per parameter, and their two total weights.
    fn memory_len(&self, parameters: usize) -> usize {
        parameters.saturating_mul(2).saturating_add(2)
    }

    fn step(&self, gradient: &[R], parameters: &mut [R], memory: &mut [R]) {
        let one = R::from_f64(1.0);
        let (rate, epsilon) = (R::from_f64(self.rate), R::from_f64(self.epsilon));
        let new = self.decays.map(|decay| R::from_f64(1.0 - decay));
        let Some((begun, means)) = memory.split_first_chunk_mut::<2>() else { return };
        for (begun, new) in begun.iter_mut().zip(new) {
            *begun += (one - *begun) * new;
        }
        let (first, second) = means.split_at_mut(means.len() / 2);
        for (((p, g), m), v) in parameters.iter_mut().zip(gradient).zip(first).zip(second) {
            *m += (*g - *m) * new[0];
            *v += (*g * *g - *v) * new[1];
            *p -= rate * (*m / begun[0]) / ((*v / begun[1]).sqrt() + epsilon);
        }
    }
}
