//! Functions that never fall where their argument rises, over the floats.

use farsa_num::{Scalar, exp, logistic, tanh};

/// The first two places, as they are visited, between which a function falls or is NaN.
///
/// Visited are pairs of neighbouring floats, every `stride`-th pair, from the lowest to the highest, and both infinities:
/// `1 / stride` of all floats. Only neighbours show a fall of one unit: farther apart it is lost in the rise between them.
fn first_fall(stride: usize, of: impl Fn(f32) -> f32) -> Option<[f32; 2]> {
    let infinity = f32::INFINITY.to_bits();
    let pairs = || (0..infinity).step_by(2 * stride);
    let negative = pairs().rev().flat_map(|bits| [-f32::from_bits(bits + 1), -f32::from_bits(bits)]);
    let positive = pairs().flat_map(|bits| [f32::from_bits(bits), f32::from_bits(bits + 1)]);
    let (mut before, mut last) = (f32::NEG_INFINITY, of(f32::NEG_INFINITY));
    for x in negative.chain(positive).chain([f32::INFINITY]) {
        assert!(before <= x, "{x} after {before}");
        let y = of(x);
        let rises = last <= y;
        if !rises {
            return Some([before, x]);
        }
        (before, last) = (x, y);
    }
    None
}

/// A function goes from `low` to `high` and never falls.
fn never_falls(stride: usize, of: impl Fn(f32) -> f32, ends: [f32; 2]) {
    assert_eq!([f32::NEG_INFINITY, f32::INFINITY].map(&of), ends);
    if let Some([before, x]) = first_fall(stride, &of) {
        panic!("of {x} it is {}, of {before} before {}", of(x), of(before));
    }
}

#[test]
fn over_every_997th_pair() {
    never_falls(997, exp, [0.0, f32::INFINITY]);
    never_falls(997, logistic, [0.0, 1.0]);
    never_falls(997, tanh, [-1.0, 1.0]);
}

/// The logistic function of values 2, which falls by a unit at one of 20 000 floats.
fn logistic_of_values_2(x: f32) -> f32 {
    let e = exp(-Scalar::abs(x));
    if x < 0.0 { e / (1.0 + e) } else { 1.0 / (1.0 + e) }
}

#[test]
fn a_fall_between_neighbours_is_seen() {
    let [before, x] = first_fall(997, logistic_of_values_2).expect("it falls");
    assert_eq!(x, before.next_up());
    assert_eq!(logistic_of_values_2(x), logistic_of_values_2(before).next_down());

    // One fall, by a unit, between a float that is visited and the next.
    let place = f32::from_bits(2 * 997 * 500_000);
    assert!(place.is_normal());
    let falling = |x: f32| if x == place.next_up() { place.next_down() } else { x };
    assert_eq!(first_fall(997, falling), Some([place, place.next_up()]));
    assert_eq!(first_fall(997, |x| -falling(-x)), Some([-place.next_up(), -place]));
    assert_eq!(first_fall(997, |x| if x == place { f32::NAN } else { x }).map(|[_, x]| x), Some(place));
}

// The other two over every float: the activation functions of farsa-nn.
#[test]
#[ignore = "some minutes, by `./ci long`: every float"]
fn exp_over_every_float() {
    never_falls(1, exp, [0.0, f32::INFINITY]);
}
