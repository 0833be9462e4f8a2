//! The loop in integers, without a float between the counts of the converters and the widths of the pulses.

use farsa_nn::Controller;
use farsa_nn::bytes::BytesError;
use farsa_nn::quantized::QuantizedNetwork;
use farsa_num::{Digest, Stream};

use crate::champion::read_fixed;
use crate::robot::RANGES;
use crate::{Analog, Board, Control, INPUT_BITS, LAYOUT, LEAK, Pulse, fixed_champion};

/// Fraction bits of the factor of a count.
const FACTOR_BITS: u32 = 16;

/// For every converter the sensor value at 0 and the value of a count, in units of 2^-16 of a sensor value.
const SCALES: [(i16, u32); LAYOUT.sensors()] = {
    let unit = (1 << INPUT_BITS) as f64;
    let mut scales = [(0, 0); LAYOUT.sensors()];
    let mut i = 0;
    while i < scales.len() {
        let [from, to] = RANGES[i];
        let factor = (to - from) as f64 * unit * (1 << FACTOR_BITS) as f64 / Analog::TOP as f64;
        scales[i] = ((from as f64 * unit) as i16, (factor + 0.5) as u32);
        i += 1;
    }
    scales
};

/// The controller in integers with its state, as [`Robot`](crate::Robot).
#[derive(Debug)]
pub struct FixedRobot {
    network: QuantizedNetwork<&'static [i16], [i32; LAYOUT.state_len()]>,
    x: [i16; LAYOUT.sensors()],
    y: [i16; LAYOUT.outputs()],
}

impl FixedRobot {
    /// Builds the champion at rest.
    ///
    /// # Errors
    /// An error of the champion's bytes.
    pub fn new() -> Result<Self, BytesError> {
        let (scale, parameters) = read_fixed(fixed_champion())?;
        Ok(Self {
            network: QuantizedNetwork::new(LAYOUT, LEAK, scale, parameters, [0; LAYOUT.state_len()])?,
            x: [0; LAYOUT.sensors()],
            y: [0; LAYOUT.outputs()],
        })
    }

    /// Replaces the network by one of the same shape, for example from a wire. The state is unchanged.
    ///
    /// # Errors
    /// An error of the bytes. Then nothing is changed.
    pub fn replace(&mut self, bytes: &'static [u8]) -> Result<(), BytesError> {
        let (scale, parameters) = read_fixed(bytes)?;
        self.network.set_parameters(scale, parameters)?;
        Ok(())
    }

    /// The sensor values of the last tick `[sensors]`.
    pub fn sensed(&self) -> &[i16; LAYOUT.sensors()] {
        &self.x
    }
}

impl Control for FixedRobot {
    type Value = i16;

    const HALF: i16 = 1 << (INPUT_BITS - 1);

    fn tick(&mut self, board: &mut Board) {
        for ((x, reading), (from, factor)) in self.x.iter_mut().zip(&board.readings).zip(&SCALES) {
            let more = (u32::from((*reading).min(Analog::TOP)) * factor + (1 << (FACTOR_BITS - 1))) >> FACTOR_BITS;
            // At most the 100 units of the range: 51 200, from -25 600 on.
            *x = from.wrapping_add_unsigned(more as u16);
        }
        self.network.step_quantized(&self.x, &mut self.y);
        for (y, width) in self.y.iter().zip(&mut board.widths) {
            *width = ((u32::from(y.unsigned_abs()) * u32::from(Pulse::TOP)) >> 15) as u16;
        }
    }

    fn step(&mut self, x: &[i16; LAYOUT.sensors()]) -> &[i16; LAYOUT.outputs()] {
        self.network.step_quantized(x, &mut self.y);
        &self.y
    }

    fn random(inputs: &mut Stream) -> i16 {
        const TEN: i16 = 10 << INPUT_BITS;
        inputs.below(2 * TEN as u32 + 1) as i16 - TEN
    }

    fn add_to(&self, digest: &mut Digest) {
        self.y.iter().for_each(|y| digest.add_bytes(&y.to_le_bytes()));
        self.network.hidden().iter().for_each(|h| digest.add_bytes(&h.to_le_bytes()));
    }

    fn reset(&mut self) {
        self.network.reset();
    }
}
