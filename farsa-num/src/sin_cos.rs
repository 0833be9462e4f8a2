//! The sine and cosine functions.

use crate::polynomial::polynomial;
use crate::scalar::{Real, Scalar};

/// Computes the sine and the cosine of an angle `x` in radians. Both are accurate to 1.5 units in the last place
/// if |x| <= 10000.
///
/// For larger arguments, the error grows to about the distance between neighboring arguments. The results are NaN for
/// arguments above 2^22 (`f32`) or 2^45 (`f64`), for infinities and for NaN. Note that sin(-0.0) is 0.0.
///
/// ```
/// let (sine, cosine) = farsa_num::sin_cos(core::f64::consts::FRAC_PI_6);
/// assert!((sine - 0.5).abs() < 1e-15 && (cosine - 0.75_f64.sqrt()).abs() < 1e-15);
/// ```
///
/// Source: \[Cody1980\] (x = k pi/2 + r with pi/2 in several short parts), own minimax polynomials on |r| <= pi/4.
#[inline(always)]
pub fn sin_cos<S: Scalar>(x: S) -> (S, S) {
    let double = S::Real::DIGITS > 24;
    // The quadrant is lost for such arguments. NaN reports it, a wrong number would not.
    let limit = x.constant(if double { 35_184_372_088_832.0 } else { 4_194_304.0 });
    let x = S::select(x.abs().le(limit), x, x.constant(f64::NAN));

    let k = (x * x.constant(core::f64::consts::FRAC_2_PI)).round_small();
    // The products of k with all parts except the last are exact up to |x| = 10000. The parts have more digits of pi/2 than the
    // smallest distance of such an x from a multiple of it.
    // The first differences are exact. `rest` is the rounding error of `high` plus the remaining parts.
    let (high, rest) = if double {
        let (h, t) = (x - k * x.constant(1.570_796_326_734_125_6), k * x.constant(6.077_100_506_303_966e-11));
        let high = h - t;
        (high, ((h - high) - t) - k * x.constant(2.022_266_248_795_950_6e-21))
    } else {
        let (h, t) = (
            (x - k * x.constant(1.570_312_5)) - k * x.constant(0.000_483_751_296_997_070_3),
            k * x.constant(7.549_533_620_476_723e-8),
        );
        let high = h - t;
        (
            high,
            (((h - high) - t) - k * x.constant(2.563_282_919_254_561_4e-12))
                - k * x.constant(6.123_234_262_925_839e-17),
        )
    };
    let r = high + rest;
    let z = r * r;
    let (s, c) = if double {
        (
            polynomial!(z; -0.166_666_666_666_666_3, 0.008_333_333_333_321_84, -0.000_198_412_698_293_585_2,
                2.755_731_353_849_133_4e-6, -2.505_073_594_571_15e-8, 1.589_569_396_264_954_6e-10),
            polynomial!(z; 0.041_666_666_666_666_59, -0.001_388_888_888_887_218_6, 0.000_024_801_587_288_295_325,
                -2.755_731_401_508_377e-7, 2.087_567_808_879_956e-9, -1.135_733_824_345_065e-11),
        )
    } else {
        (
            polynomial!(z; -0.166_666_538, 0.008_332_106_28, -0.000_195_078_857),
            polynomial!(z; 0.041_666_645_6, -0.001_388_730_83, 2.443_21e-5),
        )
    };
    let half = x.constant(0.5);
    let one = x.constant(1.0);
    // `high` and `rest` again, not `r`, so that the rounding of `r` counts only in the second order.
    let sine = high + (rest + r * (z * s));
    let cosine = one - (half * z - z * z * c);

    // The quadrant, in -2..=2: both ends are the same half turn.
    let quadrant = k - x.constant(4.0) * (k * x.constant(0.25)).round_small();
    let turn = quadrant.abs();
    let odd = turn.gt(half) & turn.lt(x.constant(1.5));
    let (a, b) = (S::select(odd, cosine, sine), S::select(odd, sine, cosine));
    let a_negative = quadrant.gt(x.constant(1.5)) | quadrant.lt(-half);
    let b_negative = quadrant.gt(half) | quadrant.lt(x.constant(-1.5));
    (S::select(a_negative, -a, a), S::select(b_negative, -b, b))
}
