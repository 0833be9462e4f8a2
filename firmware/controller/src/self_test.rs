//! The proof that a processor computes what the computer computed that evolved the network.

use farsa_num::{Digest, Domain, Stream};

use crate::{Board, Control, LAYOUT};

/// Fingerprint of the activations and motor values of so many steps over random inputs: the same on every target.
///
/// The robot forgets everything before and after.
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

/// Fills the converters with noise: what stands for a robot where there is none.
pub fn noise_into(board: &mut Board, noise: &mut Stream) {
    // In integers: a program in integers has no use for routines of floats.
    board.readings.fill_with(|| (noise.next_u32() >> 20) as u16);
}
