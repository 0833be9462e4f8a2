//! Mirrored samples around a point, which an estimated gradient moves.

use alloc::vec;
use alloc::vec::Vec;

use super::noise::{Directions, Noise, Spread};
use super::optimizer::norm;
use super::settings::{bounded, read_length, read_point};
use crate::error::EvoError;
use crate::population::Population;
use crate::snapshot::{StateReader, push_reals};

/// A point, and the individuals at x + sigma z and x - sigma z for each of its directions z.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Mirrored {
    pub(super) seed: u64,
    pub(super) generation: u32,
    /// The point x \[genes\].
    pub(super) mean: Vec<f64>,
    sigma: f64,
    /// Length of the latest step.
    pub(super) step: f64,
    /// The directions of this generation.
    pub(super) directions: Directions,
    pub(super) population: Population<f64>,
}

impl Mirrored {
    pub(super) fn new(mean: Vec<f64>, pairs: usize, sigma: f64, seed: u64) -> Result<Self, EvoError> {
        let population = Population::new(2 * pairs, mean.len())?;
        let directions = Directions::new(pairs, mean.len());
        let mut samples = Self { seed, generation: 0, mean, sigma, step: 0.0, directions, population };
        samples.sample();
        Ok(samples)
    }

    fn sample(&mut self) {
        let noise = Noise { seed: self.seed, generation: self.generation };
        self.directions.mirror(noise, &mut self.population, &self.mean, Spread::Same(self.sigma));
    }

    /// Adds a step \[genes\] to the point, which stays within 1e100 of zero.
    pub(super) fn advance(&mut self, step: &[f64]) {
        self.mean.iter_mut().zip(step).for_each(|(mean, step)| *mean = bounded(*mean + step));
        self.step = norm(step);
    }

    /// Draws the individuals of a generation.
    pub(super) fn begin(&mut self, generation: u32) {
        self.generation = generation;
        self.sample();
    }

    /// The lengths of the latest step and of the point.
    pub(super) fn diagnostics(&self) -> Vec<f64> {
        vec![self.step, norm(&self.mean)]
    }

    pub(super) const fn bytes(genes: usize) -> usize {
        12 + 8 * genes
    }

    pub(super) fn save(&self) -> Vec<u8> {
        let mut state = Vec::new();
        state.extend(self.generation.to_le_bytes());
        push_reals(&mut state, &[self.step]);
        push_reals(&mut state, &self.mean);
        state
    }

    /// Reads generation, length of the step and point.
    pub(super) fn read(&self, reader: &mut StateReader<'_>) -> Result<(u32, f64, Vec<f64>), EvoError> {
        Ok((reader.u32()?, read_length(reader)?, read_point(reader, self.mean.len())?))
    }

    /// Takes what was read, and draws the individuals again.
    pub(super) fn restore(&mut self, (generation, step, mean): (u32, f64, Vec<f64>)) {
        (self.step, self.mean) = (step, mean);
        self.begin(generation);
    }
}
