//! The loop: read, step, drive.

use farsa_body::ports::{Motor, Sensor};
use farsa_nn::bytes::BytesError;
use farsa_nn::{Controller, LeakyNetwork};
use farsa_num::{Digest, Stream};

use crate::{Analog, Board, Control, LAYOUT, LEAK, Pulse, champion};

/// The inputs of the network at both ends of the converters.
///
/// The order is: joint positions and touch from 0 to 1, the way from the palm to the sphere [cm], the labels of the phases.
pub(crate) const RANGES: [[f32; 2]; LAYOUT.sensors()] = {
    let mut ranges = [[0.0, 1.0]; LAYOUT.sensors()];
    let mut i = 0;
    while i < 3 {
        ranges[23 + i] = [-50.0, 50.0];
        ranges[26 + i] = [0.0, 50.0];
        i += 1;
    }
    ranges
};

/// The controller with its state, all the memory of an episode.
#[derive(Debug)]
pub struct Robot {
    sensors: Analog,
    network: LeakyNetwork<&'static [f32], [f32; LAYOUT.state_len()]>,
    motors: Pulse,
    x: [f32; LAYOUT.sensors()],
    y: [f32; LAYOUT.outputs()],
}

impl Robot {
    /// Builds the champion at rest.
    ///
    /// # Errors
    /// An error of the champion's bytes.
    pub fn new() -> Result<Self, BytesError> {
        let state = [0.0; LAYOUT.state_len()];
        Ok(Self {
            sensors: Analog::new(0, &RANGES),
            network: LeakyNetwork::new(LAYOUT, LEAK, champion()?, state)?,
            motors: Pulse::new(0, LAYOUT.outputs()),
            x: [0.0; LAYOUT.sensors()],
            y: [0.0; LAYOUT.outputs()],
        })
    }

    /// The sensor values of the last tick `[sensors]`.
    pub fn sensed(&self) -> &[f32; LAYOUT.sensors()] {
        &self.x
    }
}

impl Control for Robot {
    type Value = f32;

    const HALF: f32 = 0.5;

    fn tick(&mut self, board: &mut Board) {
        self.sensors.read(board, &mut self.x);
        self.network.step(&self.x, &mut self.y);
        self.motors.drive(&self.y, board);
    }

    fn step(&mut self, x: &[f32; LAYOUT.sensors()]) -> &[f32; LAYOUT.outputs()] {
        self.network.step(x, &mut self.y);
        &self.y
    }

    fn random(inputs: &mut Stream) -> f32 {
        inputs.range(-10.0, 10.0)
    }

    fn add_to(&self, digest: &mut Digest) {
        digest.add_f32s(&self.y);
        digest.add_f32s(self.network.hidden());
    }

    fn reset(&mut self) {
        self.network.reset();
    }
}
