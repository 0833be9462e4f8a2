//! Motors that are on or off: valves, magnets, lamps.

use embedded_hal::digital::OutputPin;
use farsa_body::ports::{Channels, Motor};

use crate::Fault;

/// `N` outputs that go on above one motor value and off below another.
#[derive(Debug)]
pub struct Switches<P, const N: usize> {
    pins: [P; N],
    on: [bool; N],
    off_below: f32,
    on_above: f32,
    fault: Option<Fault>,
}

impl<P: OutputPin, const N: usize> Switches<P, N> {
    /// Outputs that are off and go on above `on_above`, off again below `off_below`; between them they stay.
    pub fn new(pins: [P; N], off_below: f32, on_above: f32) -> Self {
        Self { pins, on: [false; N], off_below, on_above, fault: None }
    }

    /// What went wrong since this was asked last.
    ///
    /// # Errors
    /// [`Fault::Write`].
    pub fn check(&mut self) -> Result<(), Fault> {
        self.fault.take().map_or(Ok(()), Err)
    }

    /// Gives the pins back.
    pub fn into_pins(self) -> [P; N] {
        self.pins
    }
}

impl<P, const N: usize> Channels for Switches<P, N> {
    fn channels(&self) -> usize {
        N
    }
}

impl<W: ?Sized, P: OutputPin, const N: usize> Motor<W> for Switches<P, N> {
    fn drive(&mut self, y: &[f32], _: &mut W) {
        for ((pin, on), y) in self.pins.iter_mut().zip(&mut self.on).zip(y) {
            // Nothing is above or below a NaN: it is off.
            *on = if *on { *y >= self.off_below } else { *y > self.on_above };
            if pin.set_state((*on).into()).is_err() {
                self.fault = Some(Fault::Write);
            }
        }
    }
}
