//! The exponential of a symmetric matrix.

use alloc::vec;
use alloc::vec::Vec;

/// 1 / k! for k from 0 to 16.
const INVERSE_FACTORIALS: [f64; 17] = {
    let (mut inverse, mut factorial, mut k) = ([1.0; 17], 1.0, 1);
    while k < 17 {
        factorial *= k as f64;
        inverse[k] = 1.0 / factorial;
        k += 1;
    }
    inverse
};

/// Returns the exponential of a symmetric matrix [n x n], which is symmetric, or `None` if it is not finite.
///
/// Source: \[Moler2003\] method 3, scaling and squaring with a Taylor series. The matrix is halved until its largest sum of
/// magnitudes in a row is at most 1/2, where the rest after degree 16 is below 2^-64. The polynomial of degree 16 takes six
/// products, grouped by four degrees (\[Paterson1973\]). All factors are polynomials of one symmetric matrix, so only the
/// upper half of a product is computed.
pub(super) fn exponential(matrix: &[f64], n: usize) -> Option<Vec<f64>> {
    let norm = matrix.chunks_exact(n).map(|row| row.iter().map(|x| x.abs()).sum()).fold(0.0, f64::max);
    // e^1024 is more than any number. A NaN is found at the end.
    if norm > 1024.0 {
        return None;
    }
    let (mut halvings, mut scale) = (0, 1.0);
    while norm * scale > 0.5 {
        (halvings, scale) = (halvings + 1, 0.5 * scale);
    }
    // exp(A) = exp(A / 2^s)^(2^s), with s halvings.
    let power1: Vec<f64> = matrix.iter().map(|x| scale * x).collect();
    let (mut power2, mut power3, mut power4) = (vec![0.0; n * n], vec![0.0; n * n], vec![0.0; n * n]);
    product(&power1, &power1, &mut power2, n);
    product(&power2, &power1, &mut power3, n);
    product(&power2, &power2, &mut power4, n);
    let mut sum: Vec<f64> = power4.iter().map(|x| INVERSE_FACTORIALS[16] * x).collect();
    let mut other = vec![0.0; n * n];
    // Horner's scheme in A^4: a group has four degrees, and degree 16 starts the sum.
    for group in [12, 8, 4, 0] {
        if group < 12 {
            product(&sum, &power4, &mut other, n);
            core::mem::swap(&mut sum, &mut other);
        }
        let [c0, c1, c2, c3] = [0, 1, 2, 3].map(|degree| INVERSE_FACTORIALS[group + degree]);
        for (((sum, x), x2), x3) in sum.iter_mut().zip(&power1).zip(&power2).zip(&power3) {
            *sum += c1 * x + c2 * x2 + c3 * x3;
        }
        sum.iter_mut().step_by(n + 1).for_each(|diagonal| *diagonal += c0);
    }
    for _ in 0..halvings {
        product(&sum, &sum, &mut other, n);
        core::mem::swap(&mut sum, &mut other);
    }
    sum.iter().all(|x| x.is_finite()).then_some(sum)
}

/// The product of two symmetric matrices [n x n] that commute.
fn product(a: &[f64], b: &[f64], out: &mut [f64], n: usize) {
    for (i, (a, out)) in a.chunks_exact(n).zip(out.chunks_exact_mut(n)).enumerate() {
        // Polynomials of one symmetric matrix commute, so their product is symmetric too.
        let out = &mut out[i..];
        out.fill(0.0);
        for (x, b) in a.iter().zip(b.chunks_exact(n)) {
            out.iter_mut().zip(&b[i..]).for_each(|(out, y)| *out += x * y);
        }
    }
    mirror(out, n);
}

/// Copies the upper half of a matrix [n x n] to the lower one.
pub(super) fn mirror(matrix: &mut [f64], n: usize) {
    for i in 1..n {
        for j in 0..i {
            matrix[i * n + j] = matrix[j * n + i];
        }
    }
}

/// The product of two matrices [n x n].
pub(super) fn multiply(a: &[f64], b: &[f64], n: usize) -> Vec<f64> {
    let mut out = vec![0.0; n * n];
    for (a, out) in a.chunks_exact(n).zip(out.chunks_exact_mut(n)) {
        for (x, b) in a.iter().zip(b.chunks_exact(n)) {
            out.iter_mut().zip(b).for_each(|(out, y)| *out += x * y);
        }
    }
    out
}

#[cfg(test)]
mod tests {
    use super::*;
    use farsa_num::{Stream, exp};

    #[test]
    fn a_two_by_two_has_a_closed_form() {
        for (a, b) in [(0.0, 0.0), (0.1, 0.2), (-3.0, 2.0), (20.0, -30.0), (-600.0, 50.0)] {
            let got = exponential(&[a, b, b, a], 2).unwrap();
            let (plus, minus) = (0.5 * exp(a + b), 0.5 * exp(a - b));
            let want = [plus + minus, plus - minus, plus - minus, plus + minus];
            let size: f64 = plus + minus;
            // Squaring doubles the relative error as often as it is done.
            assert!(got.iter().zip(want).all(|(got, want)| (got - want).abs() <= 1e-12 * size), "{a} {b}: {got:?}");
        }
        assert_eq!(exponential(&[800.0], 1), None);
        assert_eq!(exponential(&[f64::NAN], 1), None);
        assert_eq!(exponential(&[f64::INFINITY], 1), None);
    }

    #[test]
    fn it_is_symmetric_and_has_its_inverse() {
        let mut stream = Stream::from_seed(3);
        for n in [1, 2, 3, 8, 17] {
            let mut matrix = vec![0.0; n * n];
            stream.fill_normal(&mut matrix);
            mirror(&mut matrix, n);
            let negative: Vec<f64> = matrix.iter().map(|x| -x).collect();
            let (e, inverse) = (exponential(&matrix, n).unwrap(), exponential(&negative, n).unwrap());
            let one = multiply(&e, &inverse, n);
            let largest = e.iter().chain(&inverse).fold(1.0, |largest: f64, x| largest.max(x.abs()));
            for i in 0..n {
                for j in 0..n {
                    assert_eq!(e[i * n + j], e[j * n + i]);
                    let want = f64::from(u8::from(i == j));
                    assert!((one[i * n + j] - want).abs() < 1e-14 * largest * largest, "{n}: {one:?}");
                }
            }
        }
    }
}
