//! A lane of an actuator's effort is the effort of that lane alone, bit for bit, at every instruction set of this
//! machine.

use farsa_body::actuators::{Effort, Held, Law, MusclePair, Servo, Torque};
use farsa_num::fearless_simd::{dispatch, f32x8, f32x16};
use farsa_num::{Instructions, Scalar};

/// Position, speed, two commands.
type Input = [f32; 4];

fn laws() -> [Law<f32>; 5] {
    [
        Law::MusclePair(MusclePair::thesis(3000.0, 0.01, [-1.9, 1.57])),
        Law::MusclePair(MusclePair::original(300.0, 0.01, [-2.97, 0.0], 0.7)),
        Law::Servo(Servo { stiffness: 1.0, damping: 0.04, limit: 0.3 }),
        Law::Torque(Torque { limit: 0.5 }),
        Law::Held(Held { stiffness: 2.0, damping: 0.1 }),
    ]
}

/// Rest, saturation, both sides of the active part's ends, blow-up, NaN, neighbors in different phases.
fn inputs() -> Vec<Input> {
    let mut inputs = vec![];
    let positions = [-1.9, 0.31, f32::NAN, -40.0, 1.6, -0.0, 0.0, -3.2, 1e30, -1.0, f32::NEG_INFINITY, 0.77, -2.97];
    for (i, q) in positions.into_iter().enumerate() {
        for (j, w) in [0.0, -0.0, 3.5, -17.0, f32::NAN].into_iter().enumerate() {
            for (k, c) in [[0.0, 0.0], [1.0, 0.3], [0.2, 0.9], [-0.7, 0.5]].into_iter().enumerate() {
                let mix = (i * 7 + j * 3 + k * 11) as f32;
                inputs.push([q + if q.is_finite() { mix * 1e-3 } else { 0.0 }, w, c[0], c[1]]);
            }
        }
    }
    inputs
}

#[inline(always)]
fn run<S: Scalar<Real = f32>>(simd: S::Simd, law: &Law<f32>, inputs: &[Input]) -> Vec<[f32; 3]> {
    let mut results = vec![];
    for chunk in inputs.chunks(S::LANES) {
        let mut lanes = [S::splat(simd, 0.0); 4];
        for (i, input) in chunk.iter().enumerate() {
            for (lane, x) in lanes.iter_mut().zip(input) {
                lane.set_lane(i, *x);
            }
        }
        let [q, w, a, b] = lanes;
        let Effort { torque, stiffness, damping } = law.effort(q, w, [a, b]);
        results.extend((0..chunk.len()).map(|i| [torque, stiffness, damping].map(|x| x.lane(i))));
    }
    results
}

#[test]
fn a_lane_is_the_law_alone() {
    let inputs = inputs();
    let all: Vec<Instructions> = Instructions::available().collect();
    println!("instructions that ran: {all:?}");
    for law in laws() {
        let alone = run::<f32>((), &law, &inputs);
        for instructions in &all {
            let eight = dispatch!(instructions.level(), simd => run::<f32x8<_>>(simd, &law, &inputs));
            let sixteen = dispatch!(instructions.level(), simd => run::<f32x16<_>>(simd, &law, &inputs));
            for (width, lanes) in [(8, eight), (16, sixteen)] {
                for ((input, want), got) in inputs.iter().zip(&alone).zip(&lanes) {
                    let same = |w: &f32, g: &f32| w.to_bits() == g.to_bits() || w.is_nan() && g.is_nan();
                    let equal = want.iter().zip(got).all(|(w, g)| same(w, g));
                    assert!(
                        equal,
                        "{law:?} of {input:?}: {want:?} alone, {got:?} in {width} lanes at {instructions:?}"
                    );
                }
            }
        }
    }
}
