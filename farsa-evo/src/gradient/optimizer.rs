//! Optimizers, which turn an estimated gradient into a step.

use alloc::vec;
use alloc::vec::Vec;

use farsa_num::Scalar;

use super::settings::{LARGEST, decay, positive};
use crate::error::EvoError;
use crate::search::Row;

/// An optimizer that [`OpenAiEs`](crate::gradient::OpenAiEs) can use.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[non_exhaustive]
pub enum Optimizer {
    /// Adam, \[Kingma2015\] algorithm 1.
    Adam {
        /// Decay of the mean gradient (beta 1), 0 to less than 1.
        first_decay: f64,
        /// Decay of the mean square (beta 2), 0 to less than 1.
        second_decay: f64,
        /// Number that is added to the root of the mean square (epsilon), 1e-100 to 1e100.
        epsilon: f64,
    },
    /// Gradient ascent with momentum: v = momentum v + (1 - momentum) gradient, the step is the learning rate times v.
    /// Source: the program of the authors of \[Salimans2017\].
    Momentum {
        /// Share of the former velocity, 0 to less than 1.
        momentum: f64,
    },
}

impl Optimizer {
    /// Adam with the decays of \[Kingma2015\], 0.9 and 0.999, and epsilon 1e-8.
    pub const ADAM: Self = Self::Adam { first_decay: 0.9, second_decay: 0.999, epsilon: 1e-8 };

    /// Gradient ascent with a momentum of 0.9.
    pub const MOMENTUM: Self = Self::Momentum { momentum: 0.9 };

    pub(super) fn validate(self) -> Result<(), EvoError> {
        match self {
            Self::Adam { first_decay, second_decay, epsilon } => {
                decay("first_decay", first_decay)?;
                decay("second_decay", second_decay)?;
                positive("epsilon", epsilon)
            }
            Self::Momentum { momentum } => decay("momentum", momentum),
        }
    }
}

/// The state of an optimizer.
#[derive(Clone, Debug, PartialEq)]
pub(super) enum Memory {
    Adam(Adam),
    Momentum(Vec<f64>),
}

impl Memory {
    pub(super) fn new(optimizer: Optimizer, genes: usize) -> Self {
        match optimizer {
            Optimizer::Adam { .. } => Self::Adam(Adam::new(genes)),
            Optimizer::Momentum { .. } => Self::Momentum(vec![0.0; genes]),
        }
    }

    /// Turns a gradient \[genes\] into a step.
    pub(super) fn step(&mut self, optimizer: Optimizer, rate: f64, gradient: &mut [f64]) {
        match (self, optimizer) {
            (Self::Adam(adam), Optimizer::Adam { first_decay, second_decay, epsilon }) => {
                adam.step(gradient, rate, [first_decay, second_decay], epsilon);
            }
            (Self::Momentum(velocity), Optimizer::Momentum { momentum }) => {
                for (g, velocity) in gradient.iter_mut().zip(velocity) {
                    // All steps are ascents: the caller adds them.
                    *velocity = momentum * *velocity + (1.0 - momentum) * *g;
                    *g = rate * *velocity;
                }
            }
            _ => debug_assert!(false, "the memory of another optimizer"),
        }
    }

    pub(super) fn rows(&self) -> Vec<&[f64]> {
        match self {
            Self::Adam(Adam { powers, first, second }) => vec![powers, first, second],
            Self::Momentum(velocity) => vec![velocity],
        }
    }

    pub(super) fn rows_mut(&mut self) -> Vec<Row<'_>> {
        match self {
            Self::Adam(Adam { powers, first, second }) => vec![
                (powers, "a power of a decay", [0.0, 1.0]),
                (first, "a mean gradient", [-1e110, 1e110]),
                (second, "a mean square", [0.0, 1e220]),
            ],
            Self::Momentum(velocity) => vec![(velocity, "a velocity", [-1e110, 1e110])],
        }
    }
}

/// The state of Adam.
///
/// Source: \[Kingma2015\] algorithm 1, with the opposite sign, because fitness is maximized. The powers of the decays are
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
        // beta^t as a product, one factor a step, needs no power function.
        self.powers = [self.powers[0] * beta1, self.powers[1] * beta2];
        let [scale1, scale2] = self.powers.map(|power| 1.0 - power);
        for ((g, first), second) in gradient.iter_mut().zip(&mut self.first).zip(&mut self.second) {
            // m <- beta_1 m + (1 - beta_1) g and v <- beta_2 v + (1 - beta_2) g^2. The step is
            // alpha m' / (sqrt(v') + epsilon), with m' = m / (1 - beta_1^t) and v' = v / (1 - beta_2^t). [Kingma2015] algorithm 1.
            *first = beta1 * *first + (1.0 - beta1) * *g;
            *second = beta2 * *second + (1.0 - beta2) * (*g * *g);
            *g = rate * (*first / scale1) / (Scalar::sqrt(*second / scale2) + epsilon);
        }
    }
}

/// The state of `ClipUp`, a velocity.
///
/// Source: \[Toklu2020\], its algorithm for `ClipUp`. Deviation: a gradient of zero, which has no direction, adds
/// nothing.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct ClipUp {
    velocity: Vec<f64>,
}

impl ClipUp {
    pub(super) fn new(genes: usize) -> Self {
        Self { velocity: vec![0.0; genes] }
    }

    /// Takes a gradient \[genes\]. The velocity is the step.
    pub(super) fn step(&mut self, gradient: &[f64], step_size: f64, max_speed: f64, momentum: f64) {
        // v <- m v + alpha g / |g|, then v <- v_max v / |v| where |v| > v_max. [Toklu2020].
        let length = norm(gradient);
        for (velocity, g) in self.velocity.iter_mut().zip(gradient) {
            let push = if length > 0.0 { step_size * (g / length) } else { 0.0 };
            *velocity = momentum * *velocity + push;
        }
        let speed = self.speed();
        if speed > max_speed {
            // The quotient is at most 1 up to rounding, so the product does not overflow.
            self.velocity.iter_mut().for_each(|velocity| *velocity = max_speed * (*velocity / speed));
        }
    }

    pub(super) fn velocity(&self) -> &[f64] {
        &self.velocity
    }

    pub(super) fn speed(&self) -> f64 {
        norm(&self.velocity)
    }

    pub(super) fn row(&mut self) -> Row<'_> {
        // Twice the largest speed: clipping rounds.
        (&mut self.velocity, "a velocity", [-2.0 * LARGEST, 2.0 * LARGEST])
    }
}

/// The Euclidean length of a finite row, also where squares would overflow or vanish.
pub(super) fn norm(row: &[f64]) -> f64 {
    let largest = row.iter().fold(0.0, |largest: f64, x| largest.max(x.abs()));
    if largest == 0.0 {
        return 0.0;
    }
    // Within this range squares are safe, and division by 1 keeps the bits.
    let scale = if (1e-100..1e100).contains(&largest) { 1.0 } else { largest };
    let sum: f64 = row.iter().map(|x| (x / scale) * (x / scale)).sum();
    scale * Scalar::sqrt(sum)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_norm_neither_overflows_nor_vanishes() {
        for scale in [1e-300, 1e-99, 1.0, 1e99, 1e300] {
            let got = norm(&[3.0 * scale, 0.0, -4.0 * scale]);
            assert!((got / scale - 5.0).abs() < 1e-14, "{scale}: {got}");
        }
        assert_eq!(norm(&[0.0; 3]), 0.0);
        assert_eq!(norm(&[]), 0.0);
    }

    #[test]
    fn the_speed_is_limited_and_momentum_goes_on() {
        let mut clip_up = ClipUp::new(2);
        clip_up.step(&[3e9, 4e9], 1.0, 1.5, 0.9);
        assert!((clip_up.velocity[0] - 0.6).abs() < 1e-15 && (clip_up.velocity[1] - 0.8).abs() < 1e-15);
        clip_up.step(&[3.0, 4.0], 1.0, 1.5, 0.9);
        assert!((clip_up.speed() - 1.5).abs() < 1e-15);
        clip_up.step(&[0.0, 0.0], 1.0, 1.5, 0.9);
        assert!((clip_up.speed() - 1.35).abs() < 1e-15);
    }
}
