//! Standard normal distribution.

use farsa_num::exp;

/// 1 / sqrt(2 pi).
const DENSITY_AT_0: f64 = 0.398_942_280_401_432_7;
/// Value from which the continued fraction converges faster than the series.
const FAR: f64 = 2.5;
/// Number of terms of the fraction, enough for all digits.
const TERMS: u32 = 200;

/// Computes the probability of a value above `z`, or NaN for NaN.
///
/// Source: [Abramowitz1964] 26.2.11 (series) and 26.2.14 (continued fraction, evaluated from its end). Relative error below
/// 1e-13 up to z = 30.
pub(crate) fn upper_tail(z: f64) -> f64 {
    if z < 0.0 {
        return 1.0 - upper_tail(-z);
    }
    let density = DENSITY_AT_0 * exp(-0.5 * z * z);
    if z >= FAR {
        let fraction = (1..=TERMS).rev().fold(z, |below, term| z + f64::from(term) / below);
        return density / fraction;
    }
    let (mut term, mut sum, mut odd) = (z, z, 1.0);
    while term > 1e-18 * sum {
        odd += 2.0;
        term *= z * z / odd;
        sum += term;
    }
    // Comparisons with NaN are false.
    0.5 - density * sum
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::figures::fixture::fixture;

    #[test]
    fn the_tail_is_that_of_scipy() {
        for case in fixture("normal") {
            let [z, p] = ["z", "p"].map(|name| case[name].as_f64().unwrap());
            let probability = upper_tail(z);
            assert!((probability - p).abs() <= 1e-13 * p, "{z}: {probability:e} where SciPy has {p:e}");
        }
        assert_eq!((upper_tail(0.0), upper_tail(60.0)), (0.5, 0.0));
        assert!(upper_tail(f64::NAN).is_nan());
    }
}
