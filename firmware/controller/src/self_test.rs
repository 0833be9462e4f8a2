//! The proof that a processor computes what the computer computed that evolved the network.

use farsa_num::{Digest, Domain, Stream};

use crate::{Analog, Board, LAYOUT, Robot};

/// Fingerprint of the activations and motor values of so many steps over random inputs: the same on every target.
///
/// The robot forgets everything before and after.
pub fn self_test(robot: &mut Robot, steps: u32) -> u64 {
    robot.reset();
    let mut inputs = Stream::new(2010, Domain::Network, 0, 0, 0);
    let mut digest = Digest::new();
    for _ in 0..steps {
        // Units left unsaturated and saturated alike.
        let x: [f32; LAYOUT.sensors()] = core::array::from_fn(|_| inputs.range(-10.0, 10.0));
        let y = robot.step(&x);
        digest.add_f32s(y);
        digest.add_f32s(robot.hidden());
    }
    robot.reset();
    digest.finish()
}

/// Fills the converters with noise: what stands for a robot where there is none.
pub fn noise_into(board: &mut Board, noise: &mut Stream) {
    board.readings.fill_with(|| (noise.uniform() * (f32::from(Analog::TOP) + 1.0)) as u16);
}
