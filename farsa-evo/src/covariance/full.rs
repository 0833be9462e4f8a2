//! A full covariance matrix.

use alloc::vec;
use alloc::vec::Vec;

use farsa_num::Scalar;

use crate::covariance::coefficients::Coefficients;
use crate::covariance::config::CmaEsConfig;
use crate::covariance::distribution::{Covariance, bounded, multiply};
use crate::covariance::eigen::SymmetricEigen;
use crate::covariance::linear::add_rows;
use crate::error::EvoError;
use crate::snapshot::{StateReader, push_reals};
use crate::vectors::vectorized;

/// The smallest variance along an axis as a fraction of the largest: below it there is nothing but rounding.
const SMALLEST: f64 = 1e-16;
/// The limit of the elements of a saved matrix.
const ELEMENT: f64 = 1e100;
/// The limits of the roots of saved eigenvalues.
const DEVIATIONS: [f64; 2] = [1e-40, 1e40];

/// A covariance matrix and its eigenvectors, which are computed only now and then.
#[derive(Clone, Debug, PartialEq)]
pub struct Full {
    n: usize,
    /// The matrix C [n x n], of which the lower triangle counts.
    matrix: Vec<f64>,
    /// The standard deviations D along the axes \[n\] of the latest decomposition, rising.
    deviations: Vec<f64>,
    /// The axes B [n x n], one after the other.
    axes: Vec<f64>,
    /// Updates since the latest decomposition.
    age: u32,
    /// The age at which the matrix is not yet decomposed again.
    interval: f64,
}

impl Full {
    /// The standard deviations \[n\] of the genes.
    pub(crate) fn gene_deviations(&self) -> impl Iterator<Item = f64> + '_ {
        self.matrix.iter().step_by(self.n + 1).map(|variance| Scalar::sqrt(variance.max(0.0)))
    }

    /// An axis \[n\] and the standard deviation along it.
    pub(crate) fn axis(&self, index: usize) -> (&[f64], f64) {
        let axis = self.axes.chunks_exact(self.n).nth(index).unwrap_or_default();
        (axis, self.deviations.get(index).copied().unwrap_or_default())
    }

    /// Computes axes and deviations from the matrix. They stay if it has no positive eigenvalue.
    fn decompose(&mut self) {
        // On failure `age` stays, so the next update tries again.
        let Some(SymmetricEigen { values, vectors }) = SymmetricEigen::from_lower(&self.matrix, self.n) else { return };
        let largest = values.last().copied().unwrap_or_default();
        let smallest = SMALLEST * largest;
        if smallest > 0.0 {
            // Rounding can leave small eigenvalues at or below 0, where the axis ratio has no value.
            self.deviations = values.iter().map(|value| Scalar::sqrt(value.max(smallest))).collect();
            (self.axes, self.age) = (vectors, 0);
        }
    }
}

/// The symmetric matrix [n x n] of a lower triangle.
pub(super) fn symmetric(lower: &[f64], n: usize) -> Vec<f64> {
    let element = |i: usize, j: usize| lower[i.max(j) * n + i.min(j)];
    (0..n).flat_map(|i| (0..n).map(move |j| element(i, j))).collect()
}

/// The number of generations that take some seconds, where one takes `genes`^3 of `cubes` steps.
pub(super) fn interval_of_cubes(genes: usize, cubes: u64) -> u32 {
    let cube = (genes as u64).saturating_pow(3).max(1);
    u32::try_from(cubes / cube).unwrap_or(u32::MAX).max(1)
}

/// Keeps so much of the lower triangle of a matrix [n x n] and adds the squares of rows [factors x n], each times its factor.
#[inline(always)]
pub(super) fn add_squares(matrix: &mut [f64], n: usize, keep: f64, factors: &[f64], rows: &[f64]) {
    // Row i of sum f_k y_k y_k^T is sum (f_k y_k[i]) y_k, of which the lower triangle has i + 1 elements.
    let mut weighted = vec![0.0; factors.len()];
    for (index, elements) in matrix.chunks_exact_mut(n).enumerate() {
        let column = rows.iter().skip(index).step_by(n);
        weighted.iter_mut().zip(factors).zip(column).for_each(|((weighted, factor), y)| *weighted = factor * y);
        let elements = &mut elements[..=index];
        for x in elements.iter_mut() {
            *x *= keep;
        }
        add_rows(elements, &weighted, rows, n);
    }
}

impl Covariance for Full {
    type Config = CmaEsConfig;

    fn identity(n: usize, coefficients: &Coefficients) -> Self {
        let mut matrix = vec![0.0; n * n];
        matrix.iter_mut().step_by(n + 1).for_each(|x| *x = 1.0);
        // Within 1 / (10 n (c_1 + c_mu)) generations C changes little, and n^3 operations are spread over them.
        let interval = 1.0 / ((coefficients.rank_one + coefficients.rank_mu) * n as f64 * 10.0);
        Self { n, axes: matrix.clone(), matrix, deviations: vec![1.0; n], age: 0, interval }
    }

    fn shape(&self, normals: &[f64], steps: &mut [f64]) {
        // y = B (D z), a sum of axes.
        let scale = |row: &[f64]| row.iter().zip(&self.deviations).map(|(z, d)| d * z).collect::<Vec<f64>>();
        let scaled: Vec<f64> = normals.chunks_exact(self.n).flat_map(scale).collect();
        vectorized(
            #[inline(always)]
            || multiply(&scaled, &self.axes, self.n, steps),
        );
    }

    fn turn(&self, normals: &[f64]) -> Vec<f64> {
        let mut turned = vec![0.0; self.n];
        vectorized(
            #[inline(always)]
            || add_rows(&mut turned, normals, &self.axes, self.n),
        );
        turned
    }

    fn update(&mut self, keep: f64, factors: &[f64], rows: &[f64]) {
        let (n, matrix) = (self.n, &mut self.matrix);
        vectorized(
            #[inline(always)]
            || add_squares(matrix, n, keep, factors, rows),
        );
        self.age = self.age.saturating_add(1);
        if f64::from(self.age) > self.interval {
            self.decompose();
        }
    }

    fn largest_variance(&self) -> f64 {
        self.matrix.iter().step_by(self.n + 1).copied().fold(0.0, f64::max)
    }

    fn extremes(&self) -> [f64; 2] {
        let square = |d: Option<&f64>| d.map_or(1.0, |d| d * d);
        [square(self.deviations.first()), square(self.deviations.last())]
    }

    fn scale(&mut self, factor: f64) {
        let root = Scalar::sqrt(factor);
        self.matrix.iter_mut().for_each(|x| *x *= factor);
        self.deviations.iter_mut().for_each(|d| *d *= root);
    }

    fn matrix(&self) -> Vec<f64> {
        symmetric(&self.matrix, self.n)
    }

    fn snapshot_interval(genes: usize) -> u32 {
        interval_of_cubes(genes, 20_000_000_000)
    }

    fn state_length(n: usize) -> usize {
        // B and D may be older than C and thus do not follow from it.
        4 + 8 * (n * (n + 1) / 2 + n + n * n)
    }

    fn save(&self, state: &mut Vec<u8>) {
        state.extend(self.age.to_le_bytes());
        for (index, elements) in self.matrix.chunks_exact(self.n).enumerate() {
            push_reals(state, &elements[..=index]);
        }
        push_reals(state, &self.deviations);
        push_reals(state, &self.axes);
    }

    fn restore(&mut self, reader: &mut StateReader<'_>) -> Result<(), EvoError> {
        self.age = reader.u32()?;
        for (index, elements) in self.matrix.chunks_exact_mut(self.n).enumerate() {
            bounded(reader, &mut elements[..=index], [-ELEMENT, ELEMENT])?;
        }
        bounded(reader, &mut self.deviations, DEVIATIONS)?;
        // A unit vector, up to rounding.
        bounded(reader, &mut self.axes, [-1.001, 1.001])
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn adapted() -> Full {
        let coefficients = CmaEsConfig::new(vec![0.0; 3], 1.0).coefficients_of(8);
        let mut covariance = Full::identity(3, &coefficients);
        add_squares(&mut covariance.matrix, 3, 1.0, &[0.5, 2.0], &[1.0, 2.0, 0.0, 0.0, 1.0, -1.0]);
        covariance.decompose();
        covariance
    }

    #[test]
    fn scaling_multiplies_variances_and_their_roots() {
        let (before, mut after) = (adapted(), adapted());
        after.scale(0.25);
        assert!(after.matrix().iter().zip(before.matrix()).all(|(a, b)| *a == 0.25 * b));
        let [low, high] = before.extremes();
        assert!(low < high && after.extremes() == [0.25 * low, 0.25 * high]);
    }

    #[test]
    fn a_matrix_without_positive_eigenvalues_leaves_the_axes() {
        let mut covariance = adapted();
        let before = covariance.extremes();
        for wrong in [0.0, -1.0] {
            covariance.matrix.fill(0.0);
            covariance.matrix.iter_mut().step_by(4).for_each(|x| *x = wrong);
            covariance.decompose();
            assert_eq!(covariance.extremes(), before);
        }
    }
}
