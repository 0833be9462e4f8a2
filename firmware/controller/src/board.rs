//! The interface of a controller to a board: counts of converters and timers.

use farsa_body::ports::{Channels, Motor, Sensor};

use crate::LAYOUT;

/// The counts of converters and timers, in memory that interrupts or DMA access.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Board {
    /// Counts of a 12-bit converter for every sensor `[sensors]`, 0..=4095.
    pub readings: [u16; LAYOUT.sensors()],
    /// Widths of the pulses of every motor `[outputs]`, 0..=[`Pulse::TOP`].
    pub widths: [u16; LAYOUT.outputs()],
}

impl Board {
    /// Readings at 0, motors at rest.
    pub const fn new() -> Self {
        Self { readings: [0; LAYOUT.sensors()], widths: [0; LAYOUT.outputs()] }
    }
}

impl Default for Board {
    fn default() -> Self {
        Self::new()
    }
}

/// Converters of a board, each with the values at both ends of its range.
#[derive(Clone, Copy, Debug)]
pub struct Analog {
    first: usize,
    ranges: &'static [[f32; 2]],
}

impl Analog {
    /// The largest count.
    pub const TOP: u16 = 4095;

    /// The converters from `first` on, as many as there are ranges [least value, largest value].
    pub const fn new(first: usize, ranges: &'static [[f32; 2]]) -> Self {
        Self { first, ranges }
    }
}

impl Channels for Analog {
    fn channels(&self) -> usize {
        self.ranges.len()
    }
}

impl Sensor<Board> for Analog {
    fn read(&mut self, board: &Board, out: &mut [f32]) {
        let readings = board.readings.iter().skip(self.first);
        for ((out, reading), [from, to]) in out.iter_mut().zip(readings).zip(self.ranges) {
            let share = f32::from((*reading).min(Self::TOP)) * (1.0 / 4095.0);
            *out = from + (to - from) * share;
        }
    }
}

/// Timers of a board. A motor value 0..1 is the width of a pulse.
#[derive(Clone, Copy, Debug)]
pub struct Pulse {
    first: usize,
    count: usize,
}

impl Pulse {
    /// The width of a pulse that never ends.
    pub const TOP: u16 = 10_000;

    /// `count` timers from `first` on.
    pub const fn new(first: usize, count: usize) -> Self {
        Self { first, count }
    }
}

impl Channels for Pulse {
    fn channels(&self) -> usize {
        self.count
    }
}

impl Motor<Board> for Pulse {
    fn drive(&mut self, y: &[f32], board: &mut Board) {
        for (y, width) in y.iter().zip(board.widths.iter_mut().skip(self.first)).take(self.count) {
            // A NaN becomes 0: a motor at rest.
            *width = (y.clamp(0.0, 1.0) * f32::from(Self::TOP)) as u16;
        }
    }
}
