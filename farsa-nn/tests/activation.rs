//! The activation functions over the floats: finite, in range, never falling.

use farsa_nn::Activation;

/// The finite floats in ascending order, every `stride`-th and the greatest.
fn each(stride: usize, mut visit: impl FnMut(f32)) {
    let most = f32::MAX.to_bits();
    visit(f32::MIN);
    (0..=most).rev().step_by(stride).for_each(|bits| visit(-f32::from_bits(bits)));
    (0..=most).step_by(stride).for_each(|bits| visit(f32::from_bits(bits)));
    visit(f32::MAX);
}

fn holds(stride: usize) {
    for activation in Activation::ALL {
        let (low, high) = match activation {
            Activation::Logistic | Activation::Step => (0.0, 1.0),
            Activation::Tanh => (-1.0, 1.0),
            Activation::Linear => (f32::MIN, f32::MAX),
            Activation::Rectified => (0.0, f32::MAX),
        };
        let (mut most, mut last) = (f32::NEG_INFINITY, f32::NEG_INFINITY);
        each(stride, |x| {
            assert!(last <= x, "{x} after {last}");
            last = x;
            let y = activation.of(x);
            assert!(low <= y && y <= high, "{activation} of {x} is {y}");
            assert!(most <= y, "{activation} of {x} is {y}, and was {most} before");
            most = y;
        });
        assert_eq!(most, activation.of(f32::MAX));
    }
}

#[test]
fn every_64th_float() {
    holds(64);
}

#[test]
#[ignore = "some minutes: every float"]
fn every_float() {
    holds(1);
}

#[test]
fn of_what_is_no_number() {
    let of = |x: f32| Activation::ALL.map(|activation| activation.of(x));
    assert_eq!(of(f32::INFINITY), [1.0, 1.0, f32::INFINITY, 1.0, f32::INFINITY]);
    assert_eq!(of(f32::NEG_INFINITY), [0.0, -1.0, f32::NEG_INFINITY, 0.0, 0.0]);
    let [logistic, tanh, linear, step, rectified] = of(f32::NAN);
    assert!(logistic.is_nan() && tanh.is_nan() && linear.is_nan());
    assert_eq!((step, rectified), (0.0, 0.0));
}
