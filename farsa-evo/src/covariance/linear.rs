//! Sums over rows of numbers, in an order that is fixed and fits vector instructions.

/// Partial sums of a dot product.
const SUMS: usize = 8;

/// The dot product, in eight partial sums of which each takes every eighth product.
pub(super) fn dot(a: &[f64], b: &[f64]) -> f64 {
    let ((a, a_rest), (b, b_rest)) = (a.as_chunks::<SUMS>(), b.as_chunks::<SUMS>());
    let mut sums = [0.0; SUMS];
    for (a, b) in a.iter().zip(b) {
        for (sum, (a, b)) in sums.iter_mut().zip(a.iter().zip(b)) {
            *sum += a * b;
        }
    }
    let rest = a_rest.iter().zip(b_rest).fold(0.0, |sum, (a, b)| sum + a * b);
    let [s0, s1, s2, s3, s4, s5, s6, s7] = sums;
    (((s0 + s4) + (s2 + s6)) + ((s1 + s5) + (s3 + s7))) + rest
}

/// Adds `factor` times a row.
pub(super) fn add_scaled(sum: &mut [f64], factor: f64, row: &[f64]) {
    sum.iter_mut().zip(row).for_each(|(sum, x)| *sum += factor * x);
}

/// Adds the sum of rows that lie `stride` apart, each times its factor, in their order.
pub(super) fn add_rows(sum: &mut [f64], factors: &[f64], rows: &[f64], stride: usize) {
    let (fours, rest) = factors.as_chunks::<4>();
    let mut blocks = rows.chunks_exact(4 * stride);
    for (&[a, b, c, d], block) in fours.iter().zip(&mut blocks) {
        let (first, second) = block.split_at(2 * stride);
        let ((r0, r1), (r2, r3)) = (first.split_at(stride), second.split_at(stride));
        for ((((sum, x0), x1), x2), x3) in sum.iter_mut().zip(r0).zip(r1).zip(r2).zip(r3) {
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

    use super::*;

    #[test]
    fn sums_are_those_of_the_plain_loops() {
        for n in 0..40_u32 {
            let a: Vec<f64> = (0..n).map(|i| f64::from(i) - 3.0).collect();
            let b: Vec<f64> = (0..n).map(|i| f64::from(i * i % 17)).collect();
            assert_eq!(dot(&a, &b), a.iter().zip(&b).map(|(a, b)| a * b).sum::<f64>());
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
