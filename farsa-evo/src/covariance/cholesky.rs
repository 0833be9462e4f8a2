//! A full covariance matrix and its Cholesky factor.

use alloc::vec;
use alloc::vec::Vec;

use farsa_num::fearless_simd::{Simd, dispatch};
use farsa_num::{Instructions, Scalar};

use crate::covariance::coefficients::Coefficients;
use crate::covariance::config::CmaEsConfig;
use crate::covariance::distribution::{Covariance, bounded};
use crate::covariance::full::{add_squares, interval_of_cubes, symmetric};
use crate::covariance::linear::{dot_in_vectors, dots_in_vectors};
use crate::error::EvoError;
use crate::snapshot::{StateReader, push_reals};
use crate::vectors::vectorized;

/// The smallest square on the factor's diagonal as a fraction of the largest variance: below it there is nothing but rounding.
const SMALLEST: f64 = 1e-16;
/// The limit of the elements of a saved matrix.
const ELEMENT: f64 = 1e100;
/// The limits of the diagonal of a saved factor.
const DIAGONAL: [f64; 2] = [1e-40, 1e40];

/// A covariance matrix C = A A^T and its lower triangular factor A, which is computed only now and then.
#[derive(Clone, Debug, PartialEq)]
pub struct Cholesky {
    n: usize,
    /// The matrix C [n x n], of which the lower triangle counts.
    matrix: Vec<f64>,
    /// The factor A [n x n] of the latest factorization, zero above the diagonal.
    factor: Vec<f64>,
    /// Updates since the latest factorization.
    age: u32,
    /// The age at which the matrix is not yet factorized again.
    interval: f64,
}

impl Cholesky {
    fn diagonal(&self) -> impl Iterator<Item = f64> + '_ {
        self.factor.iter().step_by(self.n + 1).copied()
    }

    /// Computes the factor from the matrix. The factor stays if a number is not finite or no variance is positive.
    fn factorize(&mut self) {
        let (n, matrix) = (self.n, &self.matrix);
        let factor = dispatch!(Instructions::detect().level(), simd => simd.vectorize(
            #[inline(always)]
            || factor(simd, matrix, n),
        ));
        if let Some(factor) = factor {
            (self.factor, self.age) = (factor, 0);
        }
    }
}

/// Returns the lower triangular factor of the lower triangle of a matrix [n x n], computed in blocks of four rows. A square
/// on its diagonal is at least a fraction of the largest variance.
#[inline(always)]
fn factor<V: Simd>(simd: V, matrix: &[f64], n: usize) -> Option<Vec<f64>> {
    let largest = matrix.iter().step_by(n + 1).fold(0.0_f64, |largest, x| largest.max(*x));
    let smallest = SMALLEST * largest;
    if !(smallest > 0.0 && largest.is_finite()) {
        return None;
    }
    // A_ij = (C_ij - sum_k A_ik A_jk) / A_jj and A_jj^2 = C_jj - sum_k A_jk^2, with sums over k < j.
    let mut factor = vec![0.0; n * n];
    for first in (0..n).step_by(4) {
        let count = 4.min(n - first);
        // Four rows of a block use each earlier row, which is therefore read once for four.
        let (done, rows) = factor.split_at_mut(first * n);
        let rows = &mut rows[..count * n];
        for (column, other) in done.chunks_exact(n).enumerate() {
            let products = if count == 4 {
                dots_in_vectors(simd, rows, n, &other[..column])
            } else {
                let mut products = [0.0; 4];
                for (product, row) in products.iter_mut().zip(rows.chunks_exact(n)) {
                    *product = dot_in_vectors(simd, &row[..column], &other[..column]);
                }
                products
            };
            for (index, product) in products.iter().take(count).enumerate() {
                rows[index * n + column] = (matrix[(first + index) * n + column] - product) / other[column];
            }
        }
        // Columns of the block itself depend on its rows above, so they follow row by row.
        for index in 0..count {
            let (above, own) = rows.split_at_mut(index * n);
            for (column, other) in (first..).zip(above.chunks_exact(n)) {
                let product = dot_in_vectors(simd, &own[..column], &other[..column]);
                own[column] = (matrix[(first + index) * n + column] - product) / other[column];
            }
            let place = first + index;
            let square = matrix[place * n + place] - dot_in_vectors(simd, &own[..place], &own[..place]);
            // Rounding can make this square negative where C is nearly singular.
            own[place] = Scalar::sqrt(square.max(smallest));
        }
    }
    factor.iter().all(|x| x.is_finite()).then_some(factor)
}

impl Covariance for Cholesky {
    type Config = CmaEsConfig;

    fn identity(n: usize, coefficients: &Coefficients) -> Self {
        let mut matrix = vec![0.0; n * n];
        matrix.iter_mut().step_by(n + 1).for_each(|x| *x = 1.0);
        // A factorization takes of the order of n^3 operations, and C changes little within this interval.
        let interval = 1.0 / ((coefficients.rank_one + coefficients.rank_mu) * n as f64 * 10.0);
        Self { n, factor: matrix.clone(), matrix, age: 0, interval }
    }

    fn shape(&self, normals: &[f64], steps: &mut [f64]) {
        let (n, factor) = (self.n, &self.factor);
        dispatch!(Instructions::detect().level(), simd => simd.vectorize(
            #[inline(always)]
            || {
                let fours = normals.chunks(4 * n).zip(steps.chunks_mut(4 * n));
                for (normals, steps) in fours {
                    for (index, row) in factor.chunks_exact(n).enumerate() {
                        // A is zero above its diagonal.
                        let row = &row[..=index];
                        if normals.len() == 4 * n {
                            let sums = dots_in_vectors(simd, normals, n, row);
                            steps.iter_mut().skip(index).step_by(n).zip(sums).for_each(|(step, sum)| *step = sum);
                        } else {
                            for (step, z) in steps.iter_mut().skip(index).step_by(n).zip(normals.chunks_exact(n)) {
                                *step = dot_in_vectors(simd, &z[..=index], row);
                            }
                        }
                    }
                }
            },
        ));
    }

    /// A^-1 y of a step y = A z is z.
    fn turn(&self, normals: &[f64]) -> Vec<f64> {
        normals.to_vec()
    }

    fn update(&mut self, keep: f64, factors: &[f64], rows: &[f64]) {
        let (n, matrix) = (self.n, &mut self.matrix);
        vectorized(
            #[inline(always)]
            || add_squares(matrix, n, keep, factors, rows),
        );
        self.age = self.age.saturating_add(1);
        if f64::from(self.age) > self.interval {
            self.factorize();
        }
    }

    fn largest_variance(&self) -> f64 {
        self.matrix.iter().step_by(self.n + 1).copied().fold(0.0, f64::max)
    }

    /// The squares on the factor's diagonal, which lie between the eigenvalues.
    fn extremes(&self) -> [f64; 2] {
        let ends = self.diagonal().fold([f64::INFINITY, 0.0_f64], |[low, high], x| [low.min(x), high.max(x)]);
        ends.map(|x| x * x)
    }

    fn scale(&mut self, factor: f64) {
        // C = A A^T: the factor scales with the root.
        let root = Scalar::sqrt(factor);
        self.matrix.iter_mut().for_each(|x| *x *= factor);
        self.factor.iter_mut().for_each(|x| *x *= root);
    }

    fn matrix(&self) -> Vec<f64> {
        symmetric(&self.matrix, self.n)
    }

    fn snapshot_interval(genes: usize) -> u32 {
        interval_of_cubes(genes, 100_000_000_000)
    }

    fn state_length(n: usize) -> usize {
        4 + 8 * n * (n + 1)
    }

    fn save(&self, state: &mut Vec<u8>) {
        state.extend(self.age.to_le_bytes());
        for rows in [&self.matrix, &self.factor] {
            for (index, elements) in rows.chunks_exact(self.n).enumerate() {
                push_reals(state, &elements[..=index]);
            }
        }
    }

    fn restore(&mut self, reader: &mut StateReader<'_>) -> Result<(), EvoError> {
        self.age = reader.u32()?;
        for (index, elements) in self.matrix.chunks_exact_mut(self.n).enumerate() {
            bounded(reader, &mut elements[..=index], [-ELEMENT, ELEMENT])?;
        }
        for (index, elements) in self.factor.chunks_exact_mut(self.n).enumerate() {
            let (left, diagonal) = elements[..=index].split_at_mut(index);
            bounded(reader, left, [-ELEMENT, ELEMENT])?;
            bounded(reader, diagonal, DIAGONAL)?;
        }
        Ok(())
    }
}

#[cfg(test)]
mod tests {
    use farsa_num::{Domain, Stream};

    use super::*;

    /// Column after column, element by element.
    fn naive(matrix: &[f64], n: usize) -> Vec<f64> {
        let mut a = vec![0.0; n * n];
        for j in 0..n {
            for i in j..n {
                let sum: f64 = (0..j).map(|k| a[i * n + k] * a[j * n + k]).sum();
                let rest = matrix[i * n + j] - sum;
                a[i * n + j] = if i == j { rest.sqrt() } else { rest / a[j * n + j] };
            }
        }
        a
    }

    fn of(matrix: Vec<f64>, n: usize) -> Cholesky {
        let mut covariance = Cholesky { n, factor: vec![0.0; n * n], matrix, age: 5, interval: 1.0 };
        covariance.factorize();
        covariance
    }

    #[test]
    fn the_factor_is_that_of_the_definition() {
        for n in [1, 2, 3, 4, 5, 7, 8, 9, 16, 23, 40] {
            let mut stream = Stream::new(n as u64, Domain::General, 0, 0, 0);
            let mut rows = vec![0.0; n * n];
            stream.fill_normal(&mut rows);
            let element = |i: usize, j: usize| -> f64 {
                let ridge = if i == j { 0.5 } else { 0.0 };
                ridge + (0..n).map(|k| rows[i * n + k] * rows[j * n + k]).sum::<f64>()
            };
            let matrix: Vec<f64> = (0..n * n).map(|at| element(at / n, at % n)).collect();
            let covariance = of(matrix.clone(), n);
            assert_eq!(covariance.age, 0);
            for (x, wanted) in covariance.factor.iter().zip(naive(&matrix, n)) {
                assert!((x - wanted).abs() < 1e-10 * n as f64, "{n}: {x} {wanted}");
            }
            let mut normals = vec![0.0; 6 * n];
            stream.fill_normal(&mut normals);
            let mut steps = vec![0.0; 6 * n];
            covariance.shape(&normals, &mut steps);
            for (z, y) in normals.chunks(n).zip(steps.chunks(n)) {
                for (i, y) in y.iter().enumerate() {
                    let wanted: f64 = (0..=i).map(|j| covariance.factor[i * n + j] * z[j]).sum();
                    assert!((y - wanted).abs() < 1e-12 * n as f64);
                }
            }
        }
    }

    #[test]
    fn scaling_multiplies_variances_and_their_roots() {
        let whole = || of(vec![4.0, 2.0, 2.0, 5.0], 2);
        let (before, mut after) = (whole(), whole());
        after.scale(0.25);
        assert!(after.matrix().iter().zip(before.matrix()).all(|(a, b)| *a == 0.25 * b));
        assert!(after.factor.iter().zip(&before.factor).all(|(a, b)| *a == 0.5 * b));
        assert_eq!(after.extremes(), [1.0, 1.0]);
    }

    #[test]
    fn what_has_no_factor_gets_the_nearest_or_leaves_all_as_it_is() {
        // A matrix of rank one. The rest of the second variance is rounding.
        let covariance = of(vec![1.0, 1.0, 1.0, 1.0], 2);
        assert_eq!(covariance.factor, [1.0, 0.0, 1.0, 1e-8]);
        assert_eq!(covariance.extremes(), [1e-8 * 1e-8, 1.0]);
        for matrix in [vec![0.0; 4], vec![f64::NAN; 4], vec![1.0, 0.0, f64::INFINITY, 1.0], vec![-1.0, 0.0, 0.0, -2.0]]
        {
            assert_eq!(of(matrix.clone(), 2).age, 5, "{matrix:?}");
        }
    }
}
