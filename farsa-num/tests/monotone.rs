//! Functions that never fall where their argument rises, over the floats.

use farsa_num::{exp, logistic, tanh};

/// Checks every `stride`-th float, both zeros and both infinities: a function goes from `low` to `high` and never falls.
fn never_falls(stride: usize, of: impl Fn(f32) -> f32, [low, high]: [f32; 2]) {
    let (mut before, mut last) = (f32::NEG_INFINITY, of(f32::NEG_INFINITY));
    assert_eq!(last, low);
    let mut visit = |x: f32| {
        assert!(before <= x, "{x} after {before}");
        let y = of(x);
        assert!(last <= y && y <= high, "of {x} it is {y}, after {last} of {before}");
        (before, last) = (x, y);
    };
    let infinity = f32::INFINITY.to_bits();
    (0..infinity).rev().step_by(stride).for_each(|bits| visit(-f32::from_bits(bits)));
    visit(-0.0);
    (0..=infinity).step_by(stride).for_each(|bits| visit(f32::from_bits(bits)));
    visit(f32::INFINITY);
    assert_eq!(last, high);
}

#[test]
fn over_every_997th_float() {
    never_falls(997, exp, [0.0, f32::INFINITY]);
    never_falls(997, logistic, [0.0, 1.0]);
    never_falls(997, tanh, [-1.0, 1.0]);
}

// The other two over every float: the activation functions of farsa-nn.
#[test]
#[ignore = "some minutes, by `./ci long`: every float"]
fn exp_over_every_float() {
    never_falls(1, exp, [0.0, f32::INFINITY]);
}
