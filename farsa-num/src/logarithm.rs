//! The natural logarithm.

use crate::polynomial::polynomial;
use crate::scalar::{Real, Scalar};

/// Computes the natural logarithm. The result is accurate to 1 unit in the last place.
///
/// The result is negative infinity for zero, infinity for infinity, and NaN for negative arguments. For `f32`, it is
/// computed in `f64` and rounded.
///
/// Source: \[Tang1990\] in outline (x = 2^k m with m around 1, a series in (m - 1) / (m + 1)). Deviations: no table,
/// own minimax polynomial.
#[inline(always)]
pub fn ln<R: Real>(x: R) -> R {
    R::from_f64(ln_f64(x.to_f64()))
}

fn ln_f64(x: f64) -> f64 {
    if x.is_nan() || x < 0.0 {
        return f64::NAN;
    }
    if x == 0.0 {
        return f64::NEG_INFINITY;
    }
    if x == f64::INFINITY {
        return x;
    }
    // A subnormal number has no exponent bits. Multiply by 2^54 to make it normal.
    let (x, shift) = if x < f64::MIN_POSITIVE { (x * 1.801_439_850_948_198_4e16, 1023.0 + 54.0) } else { (x, 1023.0) };
    of_normal(x, shift)
}

/// The logarithm of a number in [2^-1000, 1], without the special cases.
#[inline(always)]
pub(crate) fn ln_of_unit(x: f64) -> f64 {
    of_normal(x, 1023.0)
}

/// The logarithm of a positive normal number with an exponent biased by `shift`.
#[inline(always)]
fn of_normal(x: f64, shift: f64) -> f64 {
    const MANTISSA: u64 = 0x000F_FFFF_FFFF_FFFF;
    const ONE: u64 = 0x3FF0_0000_0000_0000;
    const SQRT_HALF: u64 = 0x3FE6_A09E_667F_3BCD;
    // So that m = x / 2^k is in [sqrt(1/2), sqrt(2)).
    let bits = x.to_bits() + (ONE - SQRT_HALF);
    let k = f64::from((bits >> 52) as u32) - shift;
    let f = f64::from_bits((bits & MANTISSA) + SQRT_HALF) - 1.0;

    let s = f / (2.0 + f);
    let z = s * s;
    let r = z * polynomial!(z; 0.666_666_666_666_671_3, 0.399_999_999_995_219_5, 0.285_714_287_229_638_15,
        0.222_222_002_675_258_6, 0.181_834_874_381_965_22, 0.153_157_976_168_813_7, 0.147_802_591_069_620_51);
    let h = 0.5 * f * f;
    // k ln2_high is exact. Small terms are summed first.
    k * 0.693_147_180_601_954_5 - ((h - (s * (h + r) - k * 4.200_915_072_681_084_6e-11)) - f)
}
