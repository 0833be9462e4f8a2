//! The promises of the scalar trait for one lane: powers of two, rounding and NaN.

use farsa_num::{Mask, Real, Scalar};
use proptest::prelude::*;

#[test]
fn exp2_integer_is_exact_over_the_normal_exponents() {
    for n in -126_i32..=127 {
        assert_eq!((n as f32).exp2_integer().to_bits(), ((n + 127) as u32) << 23, "2^{n}");
    }
    for n in -1022_i64..=1023 {
        assert_eq!((n as f64).exp2_integer().to_bits(), ((n + 1023) as u64) << 52, "2^{n}");
    }
    assert_eq!((-0.0_f32).exp2_integer(), 1.0);
    assert_eq!((-0.0_f64).exp2_integer(), 1.0);
}

#[test]
fn constants_round_once() {
    assert_eq!(<f32 as Real>::DIGITS, 24);
    assert_eq!(<f64 as Real>::DIGITS, 53);
    assert_eq!(1.0_f32.constant(0.1), 0.1_f32);
    assert_eq!(1.0_f64.constant(0.1), 0.1_f64);
    assert_eq!(f32::from_f64(16_777_217.0), 16_777_216.0);
    assert_eq!(0.1_f32.to_f64(), 0.100_000_001_490_116_12);
}

/// The tables of `min`, `max` and `clamp` with a NaN in every place.
#[test]
fn nan_goes_where_the_documentation_says() {
    fn check<R: Real + std::fmt::Debug>() {
        let (nan, one, two) = (R::from_f64(f64::NAN), R::from_f64(1.0), R::from_f64(2.0));
        let is_nan = |x: R| !x.ge(x);
        // A NaN on the left loses, on the right wins.
        assert_eq!(Scalar::min(nan, one), one);
        assert_eq!(Scalar::max(nan, one), one);
        assert!(is_nan(Scalar::min(one, nan)));
        assert!(is_nan(Scalar::max(one, nan)));
        assert_eq!(Scalar::clamp(nan, one, two), one);
        for (x, low, high) in [(one, nan, two), (one, one, nan), (nan, nan, nan)] {
            let y = Scalar::clamp(x, low, high);
            assert_eq!(is_nan(y), !high.le(high), "{y:?}");
        }
        assert!(!nan.lt(one) && !nan.le(one) && !nan.gt(one) && !nan.ge(one) && !nan.le(nan));
        assert!(is_nan(R::from_f64(-1.0).sqrt()));
    }
    check::<f32>();
    check::<f64>();
}

#[test]
fn equal_zeros_give_the_right_one() {
    assert_eq!(Scalar::min(0.0_f32, -0.0).to_bits(), (-0.0_f32).to_bits());
    assert_eq!(Scalar::min(-0.0_f32, 0.0).to_bits(), 0);
    assert_eq!(Scalar::max(-0.0_f32, 0.0).to_bits(), 0);
    assert_eq!(Scalar::max(0.0_f32, -0.0).to_bits(), (-0.0_f32).to_bits());
}

#[test]
fn the_mask_of_one_lane_is_its_bool() {
    for mask in [false, true] {
        assert_eq!([Mask::any(mask), Mask::all(mask), mask.lane(0), mask.lane(1)], [mask, mask, mask, false]);
    }
}

#[test]
#[should_panic(expected = "lane 1 of 1")]
fn one_lane_has_no_second() {
    let _ = Scalar::lane(1.0_f32, 1);
}

proptest! {
    #![proptest_config(ProptestConfig { failure_persistence: None, ..ProptestConfig::default() })]

    #[test]
    fn round_small_rounds_ties_to_even(x in -4_194_303.0_f32..4_194_303.0, y in -2.25e15_f64..2.25e15, n in -2_000_000_i32..2_000_000) {
        prop_assert_eq!(x.round_small(), x.round_ties_even());
        prop_assert_eq!(y.round_small(), y.round_ties_even());
        let half = n as f32 + 0.5;
        prop_assert_eq!(half.round_small(), half.round_ties_even());
        prop_assert_eq!(f64::from(half).round_small(), f64::from(half).round_ties_even());
    }

    #[test]
    fn clamp_stays_within(x in any::<f32>(), a in -1e30_f32..1e30, b in -1e30_f32..1e30) {
        let (low, high) = (a.min(b), a.max(b));
        let y = Scalar::clamp(x, low, high);
        prop_assert!((low..=high).contains(&y));
        prop_assert!(x.is_nan() || y == x || x < low || x > high);
    }
}
