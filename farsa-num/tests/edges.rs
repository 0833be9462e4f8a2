//! Infinities, zeros, NaN and the laws that hold exactly.

use farsa_num::{Real, acos, asin, atan2, exp, ln, logistic, sin_cos, tanh};
use proptest::prelude::*;

fn is_nan<R: Real>(x: R) -> bool {
    x.to_f64().is_nan()
}

fn edges<R: Real + core::fmt::Debug>() {
    let of = R::from_f64;
    let (infinity, nan) = (of(f64::INFINITY), of(f64::NAN));
    let same = |x: R, y: f64| assert_eq!(x.to_f64().to_bits(), y.to_bits(), "{x:?} is not {y:?}");

    same(exp(infinity), f64::INFINITY);
    same(exp(-infinity), 0.0);
    same(exp(of(0.0)), 1.0);
    same(exp(of(-0.0)), 1.0);
    assert!(is_nan(exp(nan)));

    same(logistic(infinity), 1.0);
    same(logistic(-infinity), 0.0);
    same(logistic(of(0.0)), 0.5);
    same(logistic(of(-0.0)), 0.5);
    assert!(is_nan(logistic(nan)));

    same(tanh(infinity), 1.0);
    same(tanh(-infinity), -1.0);
    same(tanh(of(0.0)), 0.0);
    assert!(is_nan(tanh(nan)));

    same(sin_cos(of(0.0)).0, 0.0);
    same(sin_cos(of(0.0)).1, 1.0);
    for lost in [infinity, -infinity, nan, of(1e20)] {
        assert!(is_nan(sin_cos(lost).0) && is_nan(sin_cos(lost).1));
    }

    same(ln(of(1.0)), 0.0);
    same(ln(of(0.0)), f64::NEG_INFINITY);
    same(ln(of(-0.0)), f64::NEG_INFINITY);
    same(ln(infinity), f64::INFINITY);
    assert!(is_nan(ln(of(-1.0))) && is_nan(ln(nan)) && is_nan(ln(-infinity)));

    same(asin(of(0.0)), 0.0);
    same(acos(of(1.0)), 0.0);
    same(asin(of(-1.0)), of(-core::f64::consts::FRAC_PI_2).to_f64());
    same(acos(of(-1.0)), of(core::f64::consts::PI).to_f64());
    for outside in [of(1.000_001), of(-1.000_001), infinity, nan] {
        assert!(is_nan(asin(outside)) && is_nan(acos(outside)));
    }

    let turn = |share: f64| of(core::f64::consts::PI * share).to_f64();
    for (y, x, share) in [
        (0.0, 1.0, 0.0),
        (0.0, -1.0, 1.0),
        (0.0, 0.0, 0.0),
        (0.0, -0.0, 1.0),
        (1.0, 0.0, 0.5),
        (1.0, -0.0, 0.5),
        (1.0, 1.0, 0.25),
        (1.0, -1.0, 0.75),
        (f64::INFINITY, 1.0, 0.5),
        (f64::INFINITY, f64::INFINITY, 0.25),
        (f64::INFINITY, f64::NEG_INFINITY, 0.75),
        (1.0, f64::INFINITY, 0.0),
        (1.0, f64::NEG_INFINITY, 1.0),
    ] {
        same(atan2(of(y), of(x)), turn(share));
        same(atan2(of(-y), of(x)), -turn(share));
    }
    assert!(is_nan(atan2(nan, of(1.0))) && is_nan(atan2(of(1.0), nan)));
}

#[test]
fn edges_of_single_precision() {
    edges::<f32>();
    // The last finite result, the first infinite one, and the last above zero.
    assert!(exp(88.722_83_f32).is_finite() && exp(88.722_84_f32).is_infinite());
    assert!(exp(-103.972_f32) > 0.0 && exp(-103.973_f32) == 0.0);
    assert_eq!(logistic(f32::MAX), 1.0);
    assert_eq!(logistic(f32::MIN), 0.0);
}

#[test]
fn edges_of_double_precision() {
    edges::<f64>();
    assert!(exp(709.782_712_893_384_f64).is_finite() && exp(709.782_712_893_385_f64).is_infinite());
    assert!(exp(-745.133_219_101_941_1_f64) > 0.0 && exp(-745.133_219_101_942_f64) == 0.0);
    assert_eq!(atan2(f64::MAX, f64::MAX), core::f64::consts::FRAC_PI_4);
    // Their sum overflows.
    assert!((atan2(f64::MAX, 0.5 * f64::MAX) - atan2(2.0, 1.0)).abs() < 1e-15);
    assert_eq!(atan2(f64::from_bits(1), f64::from_bits(1)), core::f64::consts::FRAC_PI_4);
}

proptest! {
    #![proptest_config(ProptestConfig { failure_persistence: None, ..ProptestConfig::default() })]

    #[test]
    fn results_stay_in_their_ranges(x in prop::num::f32::NORMAL | prop::num::f32::SUBNORMAL | prop::num::f32::ZERO) {
        prop_assert!(exp(x) >= 0.0);
        prop_assert!((0.0..=1.0).contains(&logistic(x)));
        prop_assert!((-1.0..=1.0).contains(&tanh(x)));
        prop_assert_eq!(tanh(-x), -tanh(x));
        if x.abs() <= 4_194_304.0 {
            let (s, c) = sin_cos(x);
            prop_assert!((-1.0..=1.0).contains(&s) && (-1.0..=1.0).contains(&c));
            prop_assert!(x.abs() > 1e4 || (s * s + c * c - 1.0).abs() < 3e-7);
            prop_assert_eq!(sin_cos(-x), (-s, c));
        }
    }

    #[test]
    fn inverses_invert(x in -1.0_f64..1.0, y in -700.0_f64..700.0, angle in -3.1_f64..3.1) {
        prop_assert!((sin_cos(asin(x)).0 - x).abs() < 1e-15);
        prop_assert!((sin_cos(acos(x)).1 - x).abs() < 1e-15);
        prop_assert!((ln(exp(y)) - y).abs() < 2e-13);
        let (s, c) = sin_cos(angle);
        prop_assert!((atan2(s, c) - angle).abs() < 1e-15);
    }

    /// Seen on every `f32` once.
    #[test]
    fn exp_never_falls(x in -104.0_f32..89.0) {
        prop_assert!(exp(x) <= exp(x.next_up()));
    }
}
