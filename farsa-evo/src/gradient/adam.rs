//! Adam: steps from decaying means of the gradient and of its square.

use alloc::vec;
use alloc::vec::Vec;

use farsa_num::Scalar;

use super::settings::read;
use crate::error::EvoError;
use crate::snapshot::{StateReader, push_reals};

/// The state of Adam.
///
/// Source: \[Kingma2015\] algorithm 1; no deviation but the sign, as fitness is maximised. The powers of the decays are
/// products of one factor a step.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Adam {
    /// The powers of the decays.
    powers: [f64; 2],
    first: Vec<f64>,
    second: Vec<f64>,
}

impl Adam {
    pub(super) fn new(genes: usize) -> Self {
        Self { powers: [1.0; 2], first: vec![0.0; genes], second: vec![0.0; genes] }
    }

    /// Turns a gradient \[genes\] into a step.
    pub(super) fn step(&mut self, gradient: &mut [f64], rate: f64, decays: [f64; 2], epsilon: f64) {
        let [beta1, beta2] = decays;
        self.powers = [self.powers[0] * beta1, self.powers[1] * beta2];
        let [scale1, scale2] = self.powers.map(|power| 1.0 - power);
        for ((g, first), second) in gradient.iter_mut().zip(&mut self.first).zip(&mut self.second) {
            *first = beta1 * *first + (1.0 - beta1) * *g;
            *second = beta2 * *second + (1.0 - beta2) * (*g * *g);
            *g = rate * (*first / scale1) / (Scalar::sqrt(*second / scale2) + epsilon);
        }
    }

    pub(super) const fn bytes(genes: usize) -> usize {
        8 * (2 + 2 * genes)
    }

    pub(super) fn push(&self, state: &mut Vec<u8>) {
        push_reals(state, &self.powers);
        push_reals(state, &self.first);
        push_reals(state, &self.second);
    }

    pub(super) fn read(reader: &mut StateReader<'_>, genes: usize) -> Result<Self, EvoError> {
        let powers = read(reader, 2, "a power of a decay", [0.0, 1.0])?;
        let first = read(reader, genes, "a mean gradient", [-1e110, 1e110])?;
        let second = read(reader, genes, "a mean square", [0.0, 1e220])?;
        Ok(Self { powers: powers.try_into().unwrap_or([1.0; 2]), first, second })
    }
}
