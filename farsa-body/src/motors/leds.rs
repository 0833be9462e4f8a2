//! LEDs and signals of robots.
//!
//! As for all motors, a value outside [0, 1] drives like the nearer end, NaN like 0.

use crate::channel::unit;
use crate::ports::{Actuated, ActuatorId, Channels, Motor};

/// Lights LEDs, one channel each: its brightness in [0, 1].
///
/// All three of a robot, or some of them: `Leds::new([leds[0], leds[2]])` are red and blue. An LED that is not driven
/// stays as it is.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Leds<A = ActuatorId, const N: usize = 3> {
    leds: [A; N],
}

impl<A, const N: usize> Leds<A, N> {
    /// A motor of these LEDs.
    pub fn new(leds: [A; N]) -> Self {
        Self { leds }
    }
}

impl<A, const N: usize> Channels for Leds<A, N> {
    fn channels(&self) -> usize {
        N
    }
}

impl<A: Copy, const N: usize, W: Actuated<Actuator = A> + ?Sized> Motor<W> for Leds<A, N> {
    fn drive(&mut self, y: &[f32], world: &mut W) {
        for (&led, &y) in self.leds.iter().zip(y) {
            world.command(led, [unit(y), 0.0]);
        }
    }
}

/// Sets the signal of a robot for the [`crate::sensors::SignalSensor`]s of other robots, one channel in [0, 1].
#[doc(alias = "communication")]
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct SignalMotor<A = ActuatorId> {
    signal: A,
}

impl<A> SignalMotor<A> {
    /// A motor of this signal.
    pub fn new(signal: A) -> Self {
        Self { signal }
    }
}

impl<A> Channels for SignalMotor<A> {
    fn channels(&self) -> usize {
        1
    }
}

impl<A: Copy, W: Actuated<Actuator = A> + ?Sized> Motor<W> for SignalMotor<A> {
    fn drive(&mut self, y: &[f32], world: &mut W) {
        if let Some(&y) = y.first() {
            world.command(self.signal, [unit(y), 0.0]);
        }
    }
}
