//! The test that a processor computes the same bits as the computer that evolved the network.

use farsa_num::{Digest, Domain, Stream};

use crate::{Board, Control, LAYOUT};

/// Computes a fingerprint of activations and motor values over a number of steps with random inputs, the same on every target.
///
/// The robot is reset before and after.
pub fn self_test<R: Control>(robot: &mut R, steps: u32) -> u64 {
    robot.reset();
    let mut inputs = Stream::new(2010, Domain::Network, 0, 0, 0);
    let mut digest = Digest::new();
    for _ in 0..steps {
        let x: [R::Value; LAYOUT.sensors()] = core::array::from_fn(|_| R::random(&mut inputs));
        robot.step(&x);
        robot.add_to(&mut digest);
    }
    robot.reset();
    digest.finish()
}

/// Fills the converters with noise instead of readings of a robot.
pub fn noise_into(board: &mut Board, noise: &mut Stream) {
    // In integers, so a program in integers links no routines of floats.
    board.readings.fill_with(|| (noise.next_u32() >> 20) as u16);
}
