//! Optimizers that change parameters by means of a gradient.

use farsa_num::Real;

/// An optimizer that minimizes a cost by means of its gradient.
///
/// An implementation contains only its settings. Its memory is a slice provided by the caller and initially zero, so a
/// checkpoint consists of two slices.
///
/// # For implementors
/// - Equal calls with equal memory must produce equal bits on every machine. Use + - * / and square root in a fixed
///   order.
/// - If `gradient` and `parameters` have different lengths, use the shorter one.
pub trait Optimizer<R: Real> {
    /// Returns the length of the memory that is required for the given number of parameters.
    fn memory_len(&self, parameters: usize) -> usize;
    /// Changes the parameters according to a gradient. The memory must have the length
    /// [`memory_len`](Self::memory_len), and it must be zero before the first step.
    fn step(&self, gradient: &[R], parameters: &mut [R], memory: &mut [R]);
}

/// Gradient descent with momentum, `v = momentum*v - rate*g`, `p = p + v`.
///
/// Source: `[Rumelhart1986]` eq. 9, for single steps. With a momentum of 0 it is plain gradient descent.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct Momentum {
    /// Learning rate by which the gradient is multiplied.
    pub rate: f64,
    /// Fraction of a change that is added to the next one, in [0, 1).
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

/// The optimizer Adam. Each parameter changes by about `rate` in a step, independent of the magnitude of its gradient.
///
/// Source: `[Kingma2015]` algorithm 1. Deviation: the powers of the decays are stored as `1 - beta^t` and computed by
/// repeated multiplication, so that the initial memory is zero.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct Adam {
    /// Approximate change of a parameter in a step.
    pub rate: f64,
    /// Decay rates of the mean gradient and of the mean squared gradient, in [0, 1).
    pub decays: [f64; 2],
    /// Small number added to the root of the mean squared gradient. The default is 1e-8.
    pub epsilon: f64,
}

impl Adam {
    /// Creates an optimizer with the given step size. All other settings have the defaults of the source.
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
