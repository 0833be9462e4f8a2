//! A diagonal covariance matrix.

use alloc::vec;
use alloc::vec::Vec;

use farsa_num::Scalar;

use crate::covariance::coefficients::Coefficients;
use crate::covariance::config::SeparableCmaEsConfig;
use crate::covariance::distribution::{Covariance, bounded};
use crate::error::EvoError;
use crate::snapshot::{StateReader, push_reals};

/// The smallest variance of a gene as a fraction of the largest.
const SMALLEST: f64 = 1e-30;
/// The limits of saved variances.
const VARIANCES: [f64; 2] = [1e-80, 1e80];

/// The variance of each gene.
#[derive(Clone, Debug, PartialEq)]
pub struct Diagonal {
    /// The variances \[n\].
    pub(super) variances: Vec<f64>,
}

impl Covariance for Diagonal {
    type Config = SeparableCmaEsConfig;

    fn identity(n: usize, _: &Coefficients) -> Self {
        Self { variances: vec![1.0; n] }
    }

    fn shape(&self, normals: &[f64], steps: &mut [f64]) {
        let deviations: Vec<f64> = self.variances.iter().map(|&variance| Scalar::sqrt(variance)).collect();
        let n = deviations.len();
        for (step, normal) in steps.chunks_exact_mut(n).zip(normals.chunks_exact(n)) {
            step.iter_mut().zip(normal).zip(&deviations).for_each(|((y, z), d)| *y = d * z);
        }
    }

    fn turn(&self, normals: &[f64]) -> Vec<f64> {
        normals.to_vec()
    }

    fn update(&mut self, keep: f64, factors: &[f64], rows: &[f64]) {
        self.variances.iter_mut().for_each(|variance| *variance *= keep);
        for (factor, row) in factors.iter().zip(rows.chunks_exact(self.variances.len())) {
            self.variances.iter_mut().zip(row).for_each(|(variance, y)| *variance += factor * y * y);
        }
        let largest = self.variances.iter().fold(0.0_f64, |largest, variance| largest.max(*variance));
        // Above 0 even if all variances underflow, because the axis ratio divides by the smallest.
        let smallest = (SMALLEST * largest).max(f64::MIN_POSITIVE);
        self.variances.iter_mut().for_each(|variance| *variance = variance.max(smallest));
    }

    fn largest_variance(&self) -> f64 {
        self.variances.iter().copied().fold(0.0, f64::max)
    }

    fn extremes(&self) -> [f64; 2] {
        let fold = |first, choose: fn(f64, f64) -> f64| self.variances.iter().copied().fold(first, choose);
        [fold(f64::INFINITY, f64::min), fold(0.0, f64::max)]
    }

    fn scale(&mut self, factor: f64) {
        self.variances.iter_mut().for_each(|variance| *variance *= factor);
    }

    fn matrix(&self) -> Vec<f64> {
        let n = self.variances.len();
        let mut matrix = vec![0.0; n * n];
        matrix.iter_mut().step_by(n + 1).zip(&self.variances).for_each(|(x, variance)| *x = *variance);
        matrix
    }

    fn snapshot_interval(_: usize) -> u32 {
        u32::MAX
    }

    fn state_length(n: usize) -> usize {
        8 * n
    }

    fn save(&self, state: &mut Vec<u8>) {
        push_reals(state, &self.variances);
    }

    fn restore(&mut self, reader: &mut StateReader<'_>) -> Result<(), EvoError> {
        bounded(reader, &mut self.variances, VARIANCES)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::covariance::config::CmaEsConfig;

    #[test]
    fn scaling_multiplies_variances() {
        let coefficients = CmaEsConfig::new(vec![0.0; 3], 1.0).coefficients_of(8);
        let mut covariance = Diagonal::identity(3, &coefficients);
        covariance.variances = vec![0.5, 2.0, 8.0];
        covariance.scale(0.25);
        assert_eq!((&covariance.variances[..], covariance.extremes()), (&[0.125, 0.5, 2.0][..], [0.125, 2.0]));
    }
}
