//! The activation functions over the floats: finite, in range, never falling.

use farsa_nn::Activation;

/// The finite floats in ascending order: pairs of neighbours, every `stride`-th pair, so that `1 / stride` of all floats are
/// visited, and both ends.
///
/// Neighbours, because a fall of one unit between two of them is lost in the rise between floats farther apart.
fn each(stride: usize, mut visit: impl FnMut(f32)) {
    let pairs = || (0..f32::INFINITY.to_bits()).step_by(2 * stride);
    visit(f32::MIN);
    pairs().rev().for_each(|bits| [bits + 1, bits].into_iter().for_each(|bits| visit(-f32::from_bits(bits))));
    pairs().for_each(|bits| [bits, bits + 1].into_iter().for_each(|bits| visit(f32::from_bits(bits))));
    visit(f32::MAX);
}

/// Where a function first falls, or leaves its range, over the floats that [`each`] visits.
fn first_miss(stride: usize, of: impl Fn(f32) -> f32, [low, high]: [f32; 2]) -> Option<f32> {
    let (mut most, mut last, mut miss) = (f32::NEG_INFINITY, f32::NEG_INFINITY, None);
    each(stride, |x| {
        assert!(last <= x, "{x} after {last}");
        last = x;
        let y = of(x);
        let holds = low <= y && y <= high && most <= y;
        if !holds && miss.is_none() {
            miss = Some(x);
        }
        most = y;
    });
    miss
}

fn holds(stride: usize) {
    for activation in Activation::ALL {
        let range = match activation {
            Activation::Logistic | Activation::Step => [0.0, 1.0],
            Activation::Tanh => [-1.0, 1.0],
            Activation::Linear => [f32::MIN, f32::MAX],
            Activation::Rectified => [0.0, f32::MAX],
        };
        if let Some(x) = first_miss(stride, |x| activation.apply(x), range) {
            panic!(
                "{activation} of {x} is {}, and {} of the float before",
                activation.apply(x),
                activation.apply(x.next_down())
            );
        }
    }
}

#[test]
fn every_64th_pair_of_floats() {
    holds(64);
}

#[test]
fn a_fall_between_neighbours_is_seen() {
    // The logistic function of values 2, which falls by a unit at one of 20 000 floats.
    let logistic = |x: f32| {
        let e = farsa_num::exp(-x.abs());
        if x < 0.0 { e / (1.0 + e) } else { 1.0 / (1.0 + e) }
    };
    let x = first_miss(64, logistic, [0.0, 1.0]).expect("it falls");
    assert_eq!(logistic(x), logistic(x.next_down()).next_down());

    // One fall, by a unit, between a float that is visited and the next.
    let place = f32::from_bits(2 * 64 * 8_000_000);
    let falling = |x: f32| if x == place.next_up() { place.next_down() } else { x };
    let range = [f32::MIN, f32::MAX];
    assert_eq!(first_miss(64, falling, range), Some(place.next_up()));
    assert_eq!(first_miss(64, |x| -falling(-x), range), Some(-place));
    assert_eq!(first_miss(64, |x| x, [f32::MIN, 1.0]), Some(1.0_f32.next_up()));
}

#[test]
#[ignore = "some minutes: every float"]
fn every_float() {
    holds(1);
}

#[test]
fn of_what_is_no_number() {
    let of = |x: f32| Activation::ALL.map(|activation| activation.apply(x));
    assert_eq!(of(f32::INFINITY), [1.0, 1.0, f32::INFINITY, 1.0, f32::INFINITY]);
    assert_eq!(of(f32::NEG_INFINITY), [0.0, -1.0, f32::NEG_INFINITY, 0.0, 0.0]);
    let [logistic, tanh, linear, step, rectified] = of(f32::NAN);
    assert!(logistic.is_nan() && tanh.is_nan() && linear.is_nan());
    assert_eq!((step, rectified), (0.0, 0.0));
}
