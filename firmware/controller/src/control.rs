//! What robots in floats and in integers have in common.

use farsa_num::{Digest, Stream};

use crate::{Board, LAYOUT};

/// A robot that can be run, tested and counted, whatever its numbers are.
pub trait Control {
    /// A sensor or motor value.
    type Value: Copy;

    /// What 0.5 is.
    const HALF: Self::Value;

    /// One control step: read, think, drive.
    fn tick(&mut self, board: &mut Board);

    /// The network alone, from these sensor values `[sensors]` to its motor values `[outputs]`.
    fn step(&mut self, x: &[Self::Value; LAYOUT.sensors()]) -> &[Self::Value; LAYOUT.outputs()];

    /// A sensor value in [-10, 10], which leaves units unsaturated and saturated alike.
    fn random(inputs: &mut Stream) -> Self::Value;

    /// Adds the motor values of the last step and the activations of its hidden neurons.
    fn add_to(&self, digest: &mut Digest);

    /// Forgets everything.
    fn reset(&mut self);
}
