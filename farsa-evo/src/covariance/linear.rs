//! Sums over rows of numbers, in an order that is fixed and fits vector instructions.

use farsa_num::fearless_simd::{Simd, SimdBase, f64x8};

/// Partial sums of a dot product.
const SUMS: usize = 8;

/// The dot product, in eight partial sums of which each takes every eighth product.
#[inline(always)]
pub(super) fn dot(a: &[f64], b: &[f64]) -> f64 {
    let ((a, a_rest), (b, b_rest)) = (a.as_chunks::<SUMS>(), b.as_chunks::<SUMS>());
    let mut sums = [0.0; SUMS];
    for (a, b) in a.iter().zip(b) {
        for (sum, (a, b)) in sums.iter_mut().zip(a.iter().zip(b)) {
            *sum += a * b;
        }
    }
    // Lanes 4 apart are added first, then 2, then 1, as vectors are halved. All forms have this order and thus equal
    // bits.
    let rest = a_rest.iter().zip(b_rest).fold(0.0, |sum, (a, b)| sum + a * b);
    let [s0, s1, s2, s3, s4, s5, s6, s7] = sums;
    (((s0 + s4) + (s2 + s6)) + ((s1 + s5) + (s3 + s7))) + rest
}

/// The same in vectors: the compiler makes narrower ones of the loop above.
#[inline(always)]
pub(super) fn dot_in_vectors<V: Simd>(simd: V, a: &[f64], b: &[f64]) -> f64 {
    let ((a, a_rest), (b, b_rest)) = (a.as_chunks::<SUMS>(), b.as_chunks::<SUMS>());
    let mut sums = f64x8::splat(simd, 0.0);
    for (a, b) in a.iter().zip(b) {
        sums += f64x8::from_slice(simd, a) * f64x8::from_slice(simd, b);
    }
    let rest = a_rest.iter().zip(b_rest).fold(0.0, |sum, (a, b)| sum + a * b);
    let mut all = [0.0; SUMS];
    sums.store_slice(&mut all);
    let [s0, s1, s2, s3, s4, s5, s6, s7] = all;
    (((s0 + s4) + (s2 + s6)) + ((s1 + s5) + (s3 + s7))) + rest
}

/// The dot products of four rows, `stride` apart, with one vector. Each has the bits of [`dot`].
#[inline(always)]
pub(super) fn dots_in_vectors<V: Simd>(simd: V, rows: &[f64], stride: usize, vector: &[f64]) -> [f64; 4] {
    let (blocks, rest) = vector.as_chunks::<SUMS>();
    let row = |index: usize| rows.get(index * stride..index * stride + vector.len()).unwrap_or_default();
    let rows = [row(0), row(1), row(2), row(3)].map(<[f64]>::as_chunks::<SUMS>);
    let [r0, r1, r2, r3] = rows.map(|(blocks, _)| blocks);
    // One load of the vector serves four rows, and the four sums do not wait for each other.
    let mut sums = [f64x8::splat(simd, 0.0); 4];
    for ((((v, a), b), c), d) in blocks.iter().zip(r0).zip(r1).zip(r2).zip(r3) {
        let v = f64x8::from_slice(simd, v);
        for (sum, row) in sums.iter_mut().zip([a, b, c, d]) {
            *sum += f64x8::from_slice(simd, row) * v;
        }
    }
    let mut products = [0.0; 4];
    for ((product, (_, row_rest)), sums) in products.iter_mut().zip(rows).zip(sums) {
        let rest = row_rest.iter().zip(rest).fold(0.0, |sum, (a, b)| sum + a * b);
        let mut all = [0.0; SUMS];
        sums.store_slice(&mut all);
        let [s0, s1, s2, s3, s4, s5, s6, s7] = all;
        *product = (((s0 + s4) + (s2 + s6)) + ((s1 + s5) + (s3 + s7))) + rest;
    }
    products
}

/// Adds `factor` times a row.
#[inline(always)]
pub(super) fn add_scaled(sum: &mut [f64], factor: f64, row: &[f64]) {
    sum.iter_mut().zip(row).for_each(|(sum, x)| *sum += factor * x);
}

/// Adds the sum of rows that lie `stride` apart, each times its factor, in their order.
#[inline(always)]
pub(super) fn add_rows(sum: &mut [f64], factors: &[f64], rows: &[f64], stride: usize) {
    let (fours, rest) = factors.as_chunks::<4>();
    let mut blocks = rows.chunks_exact(4 * stride);
    for (&[a, b, c, d], block) in fours.iter().zip(&mut blocks) {
        let (first, second) = block.split_at(2 * stride);
        let ((r0, r1), (r2, r3)) = (first.split_at(stride), second.split_at(stride));
        for ((((sum, x0), x1), x2), x3) in sum.iter_mut().zip(r0).zip(r1).zip(r2).zip(r3) {
            // The parentheses keep the order of four single rows, and with it the bits.
            *sum = (((*sum + a * x0) + b * x1) + c * x2) + d * x3;
        }
    }
    for (&factor, row) in rest.iter().zip(blocks.remainder().chunks_exact(stride)) {
        add_scaled(sum, factor, row);
    }
}

#[cfg(test)]
mod tests {
    use alloc::vec;
    use alloc::vec::Vec;

    use farsa_num::Instructions;
    use farsa_num::fearless_simd::dispatch;

    use super::*;

    #[test]
    fn sums_are_those_of_the_plain_loops() {
        for n in 0..40_u32 {
            let a: Vec<f64> = (0..n).map(|i| f64::from(i) - 3.0).collect();
            let b: Vec<f64> = (0..n).map(|i| f64::from(i * i % 17)).collect();
            assert_eq!(dot(&a, &b), a.iter().zip(&b).map(|(a, b)| a * b).sum::<f64>());
            let rows: Vec<f64> = (0..4 * (n + 3)).map(|i| f64::from(i * 5 % 13) / 3.0).collect();
            let stride = n as usize + 3;
            let want = [0, 1, 2, 3].map(|row| dot(&rows[row * stride..][..n as usize], &b));
            for instructions in Instructions::available() {
                dispatch!(instructions.level(), simd => {
                    assert_eq!(dot_in_vectors(simd, &a, &b), dot(&a, &b));
                    assert_eq!(dots_in_vectors(simd, &rows, stride, &b), want);
                });
            }
        }
        let (stride, columns) = (5, 3);
        for count in 0..11_u32 {
            let rows: Vec<f64> = (0..count * 5).map(|i| f64::from(i * 7 % 11)).collect();
            let factors: Vec<f64> = (0..count).map(|i| f64::from(i) - 4.0).collect();
            let mut sum = vec![2.0; columns];
            add_rows(&mut sum, &factors, &rows, stride);
            let naive = |column: usize| {
                2.0 + factors.iter().zip(rows.chunks(stride)).map(|(f, row)| f * row[column]).sum::<f64>()
            };
            assert_eq!(sum, [naive(0), naive(1), naive(2)]);
        }
    }
}
