//! Eigenvalues and eigenvectors of a symmetric matrix.

use alloc::vec;
use alloc::vec::Vec;

use farsa_num::fearless_simd::{Simd, dispatch};
use farsa_num::{Instructions, Scalar};

use crate::covariance::linear::{add_scaled, dot_in_vectors, dots_in_vectors};

/// The largest number of QL iterations of one eigenvalue. Two are usual.
const ITERATIONS: usize = 60;
/// Columns of eigenvectors that are rotated together, so that they stay in the cache.
const STRIP: usize = 32;
/// Rows that reflections are applied to together, so that they stay in the cache.
const ROWS: usize = 8;

/// A symmetric matrix as the sum of its eigenvalues times the squares of its eigenvectors.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct SymmetricEigen {
    /// The eigenvalues \[n\], rising.
    pub(super) values: Vec<f64>,
    /// The eigenvectors [n x n], of length 1, one after the other in the order of their values.
    pub(super) vectors: Vec<f64>,
}

/// A rotation of the eigenvectors with the numbers `index` and `index` + 1.
struct Rotation {
    index: usize,
    cosine: f64,
    sine: f64,
}

impl SymmetricEigen {
    /// Decomposes a matrix [n x n] given by its lower triangle. Returns `None` if a number is not finite or the iterations
    /// do not converge.
    ///
    /// Householder's reduction to a tridiagonal matrix, then QL iterations with implicit shifts. They take of the order of
    /// n^3 operations, in a fixed order and with no function but the square root.
    ///
    /// Source: \[Smith1976\] procedures TRED2 and IMTQL2. Deviations: the transformation is stored transposed, so that all
    /// loops run along rows. Rotations are collected and applied strip by strip. Lengths are scaled by the larger
    /// component.
    pub(super) fn from_lower(matrix: &[f64], n: usize) -> Option<Self> {
        dispatch!(Instructions::detect().level(), simd => simd.vectorize(
            #[inline(always)]
            || Self::decompose(simd, matrix, n),
        ))
    }

    #[inline(always)]
    fn decompose<V: Simd>(simd: V, matrix: &[f64], n: usize) -> Option<Self> {
        let lower = |(row, elements): (usize, &[f64])| elements.iter().take(row + 1).all(|x| x.is_finite());
        if !matrix.chunks_exact(n.max(1)).enumerate().all(lower) {
            return None;
        }
        let mut reduced = matrix.to_vec();
        let (mut diagonal, mut off, halves) = tridiagonalize(simd, &mut reduced, n);
        let vectors = accumulate(simd, &reduced, &halves, n);
        // At most two buffers of n^2 numbers are allocated at a time.
        drop(reduced);
        let mut strips = into_strips(&vectors, n);
        drop(vectors);
        iterate(&mut diagonal, &mut off, &mut strips)?;
        let mut order: Vec<usize> = (0..n).collect();
        order.sort_by(|&a, &b| diagonal[a].total_cmp(&diagonal[b]));
        let values = order.iter().map(|&index| diagonal[index]).collect();
        let mut vectors = vec![0.0; n * n];
        for (row, &index) in vectors.chunks_exact_mut(n.max(1)).zip(&order) {
            for (strip, part) in row.chunks_mut(STRIP).enumerate() {
                part.copy_from_slice(&strips[strip * n + index][..part.len()]);
            }
        }
        Some(Self { values, vectors })
    }
}

/// The diagonal \[n\], the off-diagonal (number i couples i and i + 1) and half the squared lengths of the Householder
/// vectors. The vectors replace the lower triangle, and row i has i elements.
///
/// The update after a reflection and the product that the next one needs go through the matrix together.
#[inline(always)]
fn tridiagonalize<V: Simd>(simd: V, matrix: &mut [f64], n: usize) -> (Vec<f64>, Vec<f64>, Vec<f64>) {
    let (mut off, mut halves) = (vec![0.0; n], vec![0.0; n]);
    // The vector u and the product q of the reflection before, whose update is still to be done.
    let (mut before, mut pending) = ([vec![0.0; n], vec![0.0; n]], false);
    let mut product = vec![0.0; n];
    for row in (1..n).rev() {
        let (above, below) = matrix.split_at_mut(row * n);
        let [u, q] = &before;
        if pending {
            update(&mut below[..=row], row, u, q);
        }
        let (vector, product) = (&mut below[..row], &mut product[..row]);
        let last = row - 1;
        // Scaled, so that no square overflows, and none underflows that counts.
        let scale = vector[..last].iter().fold(0.0_f64, |scale, x| scale.max(x.abs()));
        // The row is already tridiagonal. Its entry in `halves` stays 0, which marks a reflection as the identity.
        if scale == 0.0 {
            off[last] = vector[last];
            // No product follows that could take the pending update along.
            if pending {
                for (index, elements) in above.chunks_exact_mut(n).enumerate() {
                    update(&mut elements[..=index], index, u, q);
                }
            }
            pending = false;
            continue;
        }
        let scale = scale.max(vector[last].abs());
        for x in vector.iter_mut() {
            *x /= scale;
        }
        // u = x - length e_last and H = I - u u^T / half, where half = |u|^2 / 2 = |x|^2 - x_last length. The sign of
        // the length prevents cancellation in u_last.
        let square = dot_in_vectors(simd, vector, vector);
        let length = if vector[last] < 0.0 { Scalar::sqrt(square) } else { -Scalar::sqrt(square) };
        off[last] = scale * length;
        let half = square - vector[last] * length;
        vector[last] -= length;
        halves[row] = half;
        // A u: the lower triangle once along its rows and once along its columns.
        for (index, elements) in above.chunks_exact_mut(n).enumerate() {
            if pending {
                update(&mut elements[..=index], index, u, q);
            }
            product[index] = dot_in_vectors(simd, &elements[..=index], &vector[..=index]);
            add_scaled(&mut product[..index], vector[index], &elements[..index]);
        }
        // H A H = A - u q^T - q u^T, where p = A u and q = p / half - (u^T p) / (2 half^2) u.
        let shift = dot_in_vectors(simd, vector, product) / (half + half) / half;
        let [u, q] = &mut before;
        for (((q, u), p), x) in q.iter_mut().zip(u).zip(&*product).zip(&*vector) {
            (*q, *u) = (*p / half - shift * x, *x);
        }
        pending = true;
    }
    if pending {
        let [u, q] = &before;
        update(&mut matrix[..1], 0, u, q);
    }
    ((0..n).map(|index| matrix[index * n + index]).collect(), off, halves)
}

/// Takes what a reflection changes off the first elements of a row.
#[inline(always)]
fn update(elements: &mut [f64], row: usize, vector: &[f64], product: &[f64]) {
    let (u, q) = (vector[row], product[row]);
    for ((x, other_q), other_u) in elements.iter_mut().zip(product).zip(vector) {
        *x -= u * other_q + q * other_u;
    }
}

/// The product of the Householder reflections, transposed [n x n].
#[inline(always)]
fn accumulate<V: Simd>(simd: V, reduced: &[f64], halves: &[f64], n: usize) -> Vec<f64> {
    let mut vectors = vec![0.0; n * n];
    (0..n).for_each(|index| vectors[index * n + index] = 1.0);
    // Rows do not depend on each other: a few at a time stay in the cache while all reflections pass.
    for (block, rows) in vectors.chunks_mut(ROWS * n.max(1)).enumerate() {
        let rows_len = rows.len();
        for row in (block * ROWS + 1..n).filter(|&row| halves[row] > 0.0) {
            let vector = &reduced[row * n..][..row];
            // Vector `row` is zero from element `row` on, so it leaves the later rows of the identity as they are.
            let touched = n * ROWS.min(row - block * ROWS);
            let rows = &mut rows[..touched.min(rows_len)];
            let mut fours = rows.chunks_exact_mut(4 * n);
            for four in &mut fours {
                let products = dots_in_vectors(simd, four, n, vector);
                for (elements, product) in four.chunks_exact_mut(n).zip(products) {
                    add_scaled(elements, -(product / halves[row]), vector);
                }
            }
            for elements in fours.into_remainder().chunks_exact_mut(n) {
                let projection = dot_in_vectors(simd, &elements[..row], vector) / halves[row];
                add_scaled(elements, -projection, vector);
            }
        }
    }
    vectors
}

/// The QL iterations: the diagonal becomes the eigenvalues, the rows in strips the eigenvectors.
#[inline(always)]
fn iterate(diagonal: &mut [f64], off: &mut [f64], strips: &mut [[f64; STRIP]]) -> Option<()> {
    let n = diagonal.len();
    let mut rotations: Vec<Rotation> = Vec::new();
    for first in 0..n {
        for iteration in 0.. {
            // An element below the rounding of its neighbors splits the matrix.
            let negligible = |&i: &usize| off[i].abs() <= f64::EPSILON * (diagonal[i].abs() + diagonal[i + 1].abs());
            let end = (first..n - 1).find(negligible).unwrap_or(n - 1);
            if end == first {
                break;
            }
            if iteration == ITERATIONS {
                return None;
            }
            // The shift is the eigenvalue of the leading 2 x 2 matrix that is nearer to its first element. The sign
            // of the root prevents cancellation.
            let slope = (diagonal[first + 1] - diagonal[first]) / (2.0 * off[first]);
            let root = length(slope, 1.0);
            let root = if slope < 0.0 { slope - root } else { slope + root };
            let mut g = diagonal[end] - diagonal[first] + off[first] / root;
            let (mut sine, mut cosine, mut shift, mut split) = (1.0, 1.0, 0.0, false);
            for index in (first..end).rev() {
                let (f, b) = (sine * off[index], cosine * off[index]);
                let r = length(f, g);
                off[index + 1] = r;
                // Both f and g are 0, so no rotation is defined, and the matrix splits here.
                if r == 0.0 {
                    diagonal[index + 1] -= shift;
                    split = true;
                    break;
                }
                (sine, cosine) = (f / r, g / r);
                g = diagonal[index + 1] - shift;
                let r = (diagonal[index] - g) * sine + 2.0 * cosine * b;
                shift = sine * r;
                diagonal[index + 1] = g + shift;
                g = cosine * r - b;
                rotations.push(Rotation { index, cosine, sine });
            }
            if !split {
                diagonal[first] -= shift;
                off[first] = g;
            }
            off[end] = 0.0;
        }
        // Batches bound the memory to the order of n rotations, and long ones load each strip less often.
        if rotations.len() >= 8 * n {
            rotate(strips, n, &rotations);
            rotations.clear();
        }
    }
    rotate(strips, n, &rotations);
    diagonal.iter().all(|x| x.is_finite()).then_some(())
}

/// The columns of rows [n x n] as strips that lie one after the other [strips x n].
fn into_strips(rows: &[f64], n: usize) -> Vec<[f64; STRIP]> {
    let mut strips = vec![[0.0; STRIP]; n * n.div_ceil(STRIP)];
    for (index, row) in rows.chunks_exact(n.max(1)).enumerate() {
        for (strip, part) in row.chunks(STRIP).enumerate() {
            strips[strip * n + index][..part.len()].copy_from_slice(part);
        }
    }
    strips
}

/// Applies rotations to rows in strips, in their order.
#[inline(always)]
fn rotate(strips: &mut [[f64; STRIP]], n: usize, rotations: &[Rotation]) {
    for strip in strips.chunks_exact_mut(n.max(1)) {
        // Indices fall by one within a sweep, so the row of the next rotation stays in the cache.
        for sweep in rotations.chunk_by(|rotation, next| rotation.index == next.index + 1) {
            let (Some(first), Some(last)) = (sweep.first(), sweep.last()) else { continue };
            // Two successive rotations share a row. It stays in `kept` and is stored once.
            let mut kept = strip[first.index + 1];
            for &Rotation { index, cosine, sine } in sweep {
                let [lower, done] = &mut strip[index..index + 2] else { continue };
                for ((x, y), done) in lower.iter().zip(&mut kept).zip(done) {
                    (*y, *done) = (cosine * *x - sine * *y, sine * *x + cosine * *y);
                }
            }
            strip[last.index] = kept;
        }
    }
}

/// The length of a vector, without overflow.
#[inline(always)]
fn length(a: f64, b: f64) -> f64 {
    let (large, small) = if a.abs() > b.abs() { (a.abs(), b.abs()) } else { (b.abs(), a.abs()) };
    if large == 0.0 {
        return 0.0;
    }
    let ratio = small / large;
    large * Scalar::sqrt(1.0 + ratio * ratio)
}

#[cfg(test)]
mod tests {
    use farsa_num::Stream;

    use super::*;

    /// The eigenvalues, rising, by cyclic Jacobi rotations.
    fn jacobi(matrix: &[f64], n: usize) -> Vec<f64> {
        let mut a = matrix.to_vec();
        for _ in 0..60 {
            for p in 0..n {
                for q in p + 1..n {
                    if a[p * n + q] == 0.0 {
                        continue;
                    }
                    let theta = (a[q * n + q] - a[p * n + p]) / (2.0 * a[p * n + q]);
                    let t = if theta < 0.0 { -1.0 } else { 1.0 } / (theta.abs() + Scalar::sqrt(theta * theta + 1.0));
                    let c = 1.0 / Scalar::sqrt(t * t + 1.0);
                    let s = t * c;
                    for k in 0..n {
                        let (x, y) = (a[k * n + p], a[k * n + q]);
                        (a[k * n + p], a[k * n + q]) = (c * x - s * y, s * x + c * y);
                    }
                    for k in 0..n {
                        let (x, y) = (a[p * n + k], a[q * n + k]);
                        (a[p * n + k], a[q * n + k]) = (c * x - s * y, s * x + c * y);
                    }
                }
            }
        }
        let mut values: Vec<f64> = (0..n).map(|k| a[k * n + k]).collect();
        values.sort_by(f64::total_cmp);
        values
    }

    /// Compares with Jacobi's values, rebuilds the matrix, and multiplies the eigenvectors.
    fn check(matrix: &[f64], n: usize) {
        let SymmetricEigen { values, vectors } = SymmetricEigen::from_lower(matrix, n).unwrap();
        let size = matrix.iter().fold(0.0_f64, |size, x| size.max(x.abs())).max(1e-300);
        for (found, expected) in values.iter().zip(jacobi(matrix, n)) {
            assert!((found - expected).abs() <= 1e-12 * size * n as f64, "n = {n}: {found} for {expected}");
        }
        for i in 0..n {
            for j in 0..n {
                let rebuilt: f64 = (0..n).map(|k| values[k] * vectors[k * n + i] * vectors[k * n + j]).sum();
                assert!((rebuilt - matrix[i * n + j]).abs() <= 1e-12 * size, "n = {n}: element {i}, {j}");
                let product: f64 = (0..n).map(|k| vectors[i * n + k] * vectors[j * n + k]).sum();
                assert!((product - f64::from(u8::from(i == j))).abs() <= 1e-12, "n = {n}: vectors {i}, {j}");
            }
        }
    }

    fn symmetric(n: usize, mut element: impl FnMut(usize, usize) -> f64) -> Vec<f64> {
        let mut matrix = vec![0.0; n * n];
        for i in 0..n {
            for j in 0..=i {
                let x = element(i, j);
                (matrix[i * n + j], matrix[j * n + i]) = (x, x);
            }
        }
        matrix
    }

    #[test]
    fn random_matrices_are_rebuilt() {
        let mut stream = Stream::from_seed(1);
        for n in (1..24).chain([31, 32, 33, 47, 60]) {
            check(&symmetric(n, |_, _| stream.normal_pair_f64()[0]), n);
        }
    }

    #[test]
    fn degenerate_matrices_are_rebuilt() {
        for n in [1, 2, 3, 8, 40] {
            check(&symmetric(n, |_, _| 0.0), n);
            check(&symmetric(n, |_, _| 1.0), n);
            check(&symmetric(n, |i, j| f64::from(u8::from(i == j))), n);
            check(&symmetric(n, |i, j| f64::from(u8::from(i == j)) * (1 + i / 2) as f64), n);
            check(&symmetric(n, |i, j| f64::from(u8::from(i == j + 1))), n);
            check(&symmetric(n, |i, j| 1e-200 / (1 + i + j) as f64), n);
            check(&symmetric(n, |i, j| 1e100 / (1 + i + j) as f64), n);
            check(&symmetric(n, |i, j| if i == j { [1e-9, 1.0, 1e9][i % 3] } else { 0.0 }), n);
            check(&symmetric(n, |i, j| if i / 3 == j / 3 { 1.0 + (i % 3 + j % 3) as f64 } else { 0.0 }), n);
        }
    }

    #[test]
    fn only_the_lower_triangle_is_read_and_no_infinity_is_taken() {
        let mut matrix = symmetric(5, |i, j| (i * j) as f64 - 2.0);
        let plain = SymmetricEigen::from_lower(&matrix, 5);
        assert!(plain.is_some());
        (matrix[3], matrix[9]) = (f64::NAN, 7.0);
        assert_eq!(SymmetricEigen::from_lower(&matrix, 5), plain);
        for wrong in [f64::NAN, f64::INFINITY] {
            matrix[15] = wrong;
            assert_eq!(SymmetricEigen::from_lower(&matrix, 5), None);
        }
    }
}
