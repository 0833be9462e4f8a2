//! Motors that are on or off: valves, magnets, lamps.

use embedded_hal::digital::OutputPin;
use farsa_body::ports::{Channels, Motor};

use crate::Fault;

/// `N` outputs that switch on above one motor value and off below another.
#[derive(Debug)]
pub struct Switches<P, const N: usize> {
    pins: [P; N],
    on: [bool; N],
    off_below: f32,
    on_above: f32,
    fault: Option<Fault>,
}

impl<P: OutputPin, const N: usize> Switches<P, N> {
    /// Builds outputs that are off, switch on above `on_above` and off below `off_below`. Between them they do not change.
    pub fn new(pins: [P; N], off_below: f32, on_above: f32) -> Self {
        Self { pins, on: [false; N], off_below, on_above, fault: None }
    }

    /// Returns the fault since the last call.
    ///
    /// # Errors
    /// [`Fault::Write`].
    pub fn check(&mut self) -> Result<(), Fault> {
        self.fault.take().map_or(Ok(()), Err)
    }

    /// Returns the pins.
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
            // A NaN is neither above nor below: the output is off.
            *on = if *on { *y >= self.off_below } else { *y > self.on_above };
            if pin.set_state((*on).into()).is_err() {
                self.fault = Some(Fault::Write);
            }
        }
    }
}
