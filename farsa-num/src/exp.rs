//! The exponential function, and two activation functions based on it.

use crate::polynomial::polynomial;
use crate::scalar::{Real, Scalar};

/// Computes the exponential function e^x. The result is accurate to 1 unit in the last place, even if it is subnormal.
///
/// If the result exceeds the largest number, it is infinity. If it is too small for any number, it is 0. The result is
/// NaN if `x` is NaN.
///
/// ```
/// assert!((farsa_num::exp(1.0_f64) - core::f64::consts::E).abs() < 1e-15);
/// assert_eq!([-104.0_f32, 89.0].map(farsa_num::exp), [0.0, f32::INFINITY]);
/// ```
///
/// Source: \[Tang1989\] in outline (x = k ln 2 + r by \[Cody1980\], a polynomial, 2^k). Deviations: no table is used.
/// The polynomial is our minimax approximation on |r| <= 0.347. The factor 2^k is applied in two steps, so that both
/// exponents stay within the normal range.
#[inline(always)]
pub fn exp<S: Scalar>(x: S) -> S {
    let double = S::Real::DIGITS > 24;
    // Above this the last product overflows by itself. A NaN passes: the comparison is false.
    let high = x.constant(if double { 710.0 } else { 89.0 });
    let x = S::select(x.gt(high), high, x);
    // Below this the last product underflows by itself. A NaN passes.
    let low = x.constant(if double { -746.0 } else { -105.0 });
    let x = S::select(x.lt(low), low, x);

    let k = (x * x.constant(core::f64::consts::LOG2_E)).round_small();
    // The high part of ln 2 is short enough for its product with k to be exact.
    let (ln2_high, ln2_low) = if double {
        (0.693_147_180_560_117_7, -1.723_944_452_561_483_5e-13)
    } else {
        (0.693_145_751_953_125, 1.428_606_765_330_187e-6)
    };
    let high = x - k * x.constant(ln2_high);
    let low = k * x.constant(ln2_low);
    let r = high - low;
    let q = if double {
        polynomial!(r; 0.5, 0.166_666_666_666_666_7, 0.041_666_666_666_666_685, 0.008_333_333_333_326_082,
            0.001_388_888_888_887_429_4, 0.000_198_412_698_750_056_7, 0.000_024_801_587_347_587_177,
            2.755_725_516_624_523_3e-6, 2.755_725_267_329_236_6e-7, 2.510_531_411_653_494_5e-8,
            2.092_167_017_912_071e-9)
    } else {
        polynomial!(r; 0.5, 0.166_665_763, 0.041_666_373_6, 0.008_363_237_6, 0.001_394_121_56)
    };
    // `high` and `low` again, not `r`, so that the rounding of `r` counts only in the second order.
    let p = (high + (r * r * q - low)) + x.constant(1.0);
    let half = (k * x.constant(0.5)).round_small();
    p * half.exp2_integer() * (k - half).exp2_integer()
}

/// Computes the logistic function 1 / (1 + e^-x). The result is accurate to 2.5 units in the last place.
///
/// The result is always in [0, 1], or NaN if `x` is NaN. For `f32` the function is monotonic. If the result would be
/// subnormal, it is 0 instead.
///
/// ```
/// use farsa_num::logistic;
///
/// assert_eq!([-100.0_f32, 0.0, 100.0].map(logistic), [0.0, 0.5, 1.0]);
/// assert_eq!(logistic(-2.0_f32), 0.11920292);
/// ```
#[inline(always)]
pub fn logistic<S: Scalar>(x: S) -> S {
    let one = x.constant(1.0);
    // This form never falls. e^x / (1 + e^x) would have subnormal results, but it can fall.
    one / (one + exp(-x))
}

/// Computes the hyperbolic tangent. The result is accurate to 1.5 units in the last place.
///
/// The result is always in [-1, 1], or NaN if `x` is NaN. The function is exactly odd, except that tanh(-0.0) is 0.0.
///
/// Source: own minimax polynomial in x^2 for |x| < 0.5625, and 1 - 2 / (e^2x + 1) beyond.
#[inline(always)]
pub fn tanh<S: Scalar>(x: S) -> S {
    let size = x.abs();
    let z = x * x;
    let p = if S::Real::DIGITS > 24 {
        polynomial!(z; -0.333_333_333_333_333_15, 0.133_333_333_333_274_43, -0.053_968_253_963_609_52,
            0.021_869_488_369_965_193, -0.008_863_232_208_269_65, 0.003_592_087_063_318_557_3,
            -0.001_455_505_913_718_838_6, 0.000_588_276_385_168_073_7, -0.000_232_920_615_501_209_45,
            0.000_082_616_730_160_723_67, -0.000_019_042_789_254_514_275)
    } else {
        polynomial!(z; -0.333_333_135, 0.133_324_34, -0.053_835_209_5, 0.020_997_433, -0.006_164_790_6)
    };
    let small = x + x * (z * p);
    let one = x.constant(1.0);
    let large = one - x.constant(2.0) / (exp(size + size) + one);
    let large = S::select(x.lt(x.constant(0.0)), -large, large);
    S::select(size.lt(x.constant(0.5625)), small, large)
}
