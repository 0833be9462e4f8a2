//! The common interface of robots in floats and in integers.

use farsa_num::{Digest, Stream};

use crate::{Board, LAYOUT};

/// A robot that can be run, tested and counted, with any type of number.
pub trait Control {
    /// A sensor or motor value.
    type Value: Copy;

    /// The value of 0.5.
    const HALF: Self::Value;

    /// Runs one control step: read, step, drive.
    fn tick(&mut self, board: &mut Board);

    /// Steps the network alone, from sensor values `[sensors]` to motor values `[outputs]`.
    fn step(&mut self, x: &[Self::Value; LAYOUT.sensors()]) -> &[Self::Value; LAYOUT.outputs()];

    /// Draws a sensor value in [-10, 10], a range with saturated and unsaturated units.
    fn random(inputs: &mut Stream) -> Self::Value;

    /// Adds the motor values of the last step and the activations of its hidden neurons.
    fn add_to(&self, digest: &mut Digest);

    /// Resets the state.
    fn reset(&mut self);
}
