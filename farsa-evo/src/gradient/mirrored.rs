//! Mirrored samples around a point, which an estimated gradient moves.

use alloc::vec;
use alloc::vec::Vec;

use super::noise::{Directions, Spread};
use super::optimizer::norm;
use super::settings::{bounded, point_row};
use crate::population::Population;
use crate::search::{Row, Step};

/// A point x, from which individuals are drawn at x + sigma z and x - sigma z for each of its directions z.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Mirrored {
    /// The point x \[genes\].
    pub(super) mean: Vec<f64>,
    /// Length of the latest step.
    pub(super) step: f64,
    /// The directions of this generation.
    pub(super) directions: Directions,
}

impl Mirrored {
    pub(super) fn new(mean: &[f64], pairs: usize) -> Self {
        Self { mean: mean.to_vec(), step: 0.0, directions: Directions::new(pairs, mean.len()) }
    }

    /// Draws the individuals of a generation.
    pub(super) fn draw<C>(&mut self, step: &Step<'_, C>, sigma: f64, genomes: &mut Population<f64>) {
        self.directions.mirror(|row| step.stream(row), genomes, &self.mean, Spread::Same(sigma));
    }

    /// Adds a step \[genes\] to the point, which stays within 1e100 of zero.
    pub(super) fn advance(&mut self, step: &[f64]) {
        self.mean.iter_mut().zip(step).for_each(|(mean, step)| *mean = bounded(*mean + step));
        self.step = norm(step);
    }

    /// The lengths of the latest step and of the point.
    pub(super) fn diagnostics(&self) -> Vec<f64> {
        vec![self.step, norm(&self.mean)]
    }

    pub(super) fn rows(&self) -> Vec<&[f64]> {
        vec![core::slice::from_ref(&self.step), &self.mean]
    }

    pub(super) fn rows_mut(&mut self) -> Vec<Row<'_>> {
        vec![(core::slice::from_mut(&mut self.step), "a length", [0.0, f64::MAX]), point_row(&mut self.mean)]
    }
}
