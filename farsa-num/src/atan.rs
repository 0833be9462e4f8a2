//! Inverse trigonometric functions. They are computed in `f64` and do not use lanes.

use core::f64::consts::{FRAC_PI_2, FRAC_PI_4, PI};

use crate::polynomial::polynomial;
use crate::scalar::{Real, Scalar};

/// The difference of pi / 2 and its nearest double.
const FRAC_PI_2_REST: f64 = 6.123_233_995_736_766e-17;

/// Computes the angle between the x axis and the point (x, y), in radians. The result is in [-pi, pi] and accurate to
/// 1.5 units in the last place.
///
/// The signs of zero and infinities are handled as in IEEE 754 section 9.2.1. If an argument is NaN, the result is NaN.
/// For `f32`, the result is computed in `f64` and rounded.
///
/// Source: own (one reduction by pi / 4, minimax polynomial on |tan| <= sqrt(2) - 1).
///
/// ```
/// use farsa_num::{atan2, sin_cos};
///
/// let (sine, cosine) = sin_cos(2.5_f64);
/// assert!((atan2(3.0 * sine, 3.0 * cosine) - 2.5).abs() < 1e-15);
/// ```
#[inline(always)]
pub fn atan2<R: Real>(y: R, x: R) -> R {
    R::from_f64(atan2_f64(y.to_f64(), x.to_f64()))
}

/// Computes the arcsine of `x`, in radians. The result is in [-pi/2, pi/2] and accurate to 1 unit in the last place. It
/// is NaN if `x` is outside [-1, 1].
///
/// For `f32`, the result is computed in `f64` and rounded. Source: \[Fdlibm\] `e_asin.c` in outline. Deviation: own
/// minimax polynomial.
#[inline(always)]
pub fn asin<R: Real>(x: R) -> R {
    R::from_f64(asin_f64(x.to_f64()))
}

/// Computes the arccosine of `x`, in radians. The result is in [0, pi] and accurate to 1 unit in the last place. It is
/// NaN if `x` is outside [-1, 1].
///
/// For `f32`, the result is computed in `f64` and rounded. Source: \[Fdlibm\] `e_acos.c` in outline. Deviation: own
/// minimax polynomial.
#[inline(always)]
pub fn acos<R: Real>(x: R) -> R {
    R::from_f64(acos_f64(x.to_f64()))
}

fn atan2_f64(y: f64, x: f64) -> f64 {
    if x.is_nan() || y.is_nan() {
        return f64::NAN;
    }
    let (a, b) = if x.is_infinite() && y.is_infinite() { (1.0, 1.0) } else { (y.abs(), x.abs()) };
    let steep = a > b;
    let (small, large) = if steep { (b, a) } else { (a, b) };
    // Prevents an overflow of the sum below. An underflow does not matter next to so large a number.
    let (small, large) = if large > 1e300 { (small * 1e-10, large * 1e-10) } else { (small, large) };
    let (t, base, rest) = if small > (core::f64::consts::SQRT_2 - 1.0) * large {
        ((small - large) / (small + large), FRAC_PI_4, 0.5 * FRAC_PI_2_REST)
    } else if large > 0.0 {
        (small / large, 0.0, 0.0)
    } else {
        (0.0, 0.0, 0.0)
    };
    let z = t * t;
    let p = polynomial!(z; -0.333_333_333_333_333, 0.199_999_999_999_757_5, -0.142_857_142_820_277_53,
        0.111_111_108_618_584_99, -0.090_908_997_424_107_88, 0.076_920_919_055_813_3, -0.066_634_321_323_142_2,
        0.058_500_880_258_607_085, -0.050_485_116_596_337_136, 0.038_283_547_791_062_31, -0.018_133_083_152_820_226);
    let angle = base + (t + (t * (z * p) + rest));
    let angle = match (steep, x.is_sign_negative()) {
        (false, false) => angle,
        (false, true) => PI - (angle - 2.0 * FRAC_PI_2_REST),
        (true, false) => FRAC_PI_2 - (angle - FRAC_PI_2_REST),
        (true, true) => FRAC_PI_2 + (angle + FRAC_PI_2_REST),
    };
    angle.copysign(y)
}

/// (asin(x) - x) / x for z = x^2 <= 1/4.
fn excess(z: f64) -> f64 {
    z * polynomial!(z; 0.166_666_666_666_666_85, 0.074_999_999_999_862_63, 0.044_642_857_162_575_655,
        0.030_381_943_200_730_566, 0.022_372_202_782_957_776, 0.017_351_808_593_737_993, 0.013_978_675_771_073_862,
        0.011_415_067_613_361_429, 0.010_696_129_628_367_707, 0.004_003_804_881_151_838, 0.021_026_041_805_929_11,
        -0.020_086_293_575_054_714, 0.032_085_934_506_420_916)
}

/// The square root in two parts, the first with its lower half empty, so that twice its double can be subtracted
/// exactly.
fn root(z: f64) -> (f64, f64) {
    let s = crate::square_root::sqrt(z);
    let high = f64::from_bits(s.to_bits() & 0xFFFF_FFFF_0000_0000);
    let low = if s > 0.0 { (z - high * high) / (s + high) } else { 0.0 };
    (high, low)
}

fn asin_f64(x: f64) -> f64 {
    let size = x.abs();
    if size < 0.5 {
        return x + x * excess(x * x);
    }
    // pi/2 - 2 asin(sqrt((1 - |x|) / 2)). The root makes it NaN above 1.
    let z = 0.5 * (1.0 - size);
    let (high, low) = root(z);
    let small = 2.0 * ((high + low) * excess(z) + low) - FRAC_PI_2_REST;
    (FRAC_PI_4 - (small - (FRAC_PI_4 - 2.0 * high))).copysign(x)
}

fn acos_f64(x: f64) -> f64 {
    if x.abs() < 0.5 {
        return FRAC_PI_2 - (x - (FRAC_PI_2_REST - x * excess(x * x)));
    }
    let z = 0.5 * (1.0 - x.abs());
    let (high, low) = root(z);
    let small = (high + low) * excess(z) + low;
    if x > 0.0 { 2.0 * (high + small) } else { PI - 2.0 * (high + (small - FRAC_PI_2_REST)) }
}
