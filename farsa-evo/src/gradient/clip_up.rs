//! `ClipUp`: normalised gradients with momentum, and a speed limit.

use alloc::vec;
use alloc::vec::Vec;

use farsa_num::Scalar;

use super::settings::{LARGEST, read};
use crate::error::EvoError;
use crate::snapshot::{StateReader, push_reals};

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

    /// Takes a gradient \[genes\]; the velocity is the step.
    pub(super) fn step(&mut self, gradient: &[f64], step_size: f64, max_speed: f64, momentum: f64) {
        let length = norm(gradient);
        for (velocity, g) in self.velocity.iter_mut().zip(gradient) {
            let push = if length > 0.0 { step_size * (g / length) } else { 0.0 };
            *velocity = momentum * *velocity + push;
        }
        let speed = self.speed();
        if speed > max_speed {
            self.velocity.iter_mut().for_each(|velocity| *velocity = max_speed * (*velocity / speed));
        }
    }

    pub(super) fn velocity(&self) -> &[f64] {
        &self.velocity
    }

    pub(super) fn speed(&self) -> f64 {
        norm(&self.velocity)
    }

    pub(super) fn read(reader: &mut StateReader<'_>, genes: usize) -> Result<Self, EvoError> {
        // Twice the largest speed: clipping rounds.
        Ok(Self { velocity: read(reader, genes, "a velocity", [-2.0 * LARGEST, 2.0 * LARGEST])? })
    }

    pub(super) fn push(&self, state: &mut Vec<u8>) {
        push_reals(state, &self.velocity);
    }
}

/// The Euclidean length of a finite row, also where squares would overflow or vanish.
pub(super) fn norm(row: &[f64]) -> f64 {
    let largest = row.iter().fold(0.0, |largest: f64, x| largest.max(x.abs()));
    if largest == 0.0 {
        return 0.0;
    }
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
