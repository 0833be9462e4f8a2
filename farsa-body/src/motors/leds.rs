//! Motors for the LEDs and the signals of robots.
//!
//! Values outside [0, 1] are clamped, and NaN is treated as 0.

use crate::channel::unit;
use crate::ports::{Actuated, ActuatorId, Channels, Motor};

/// Controls LEDs. Each channel is the brightness of one LED in [0, 1].
///
/// It is not necessary to drive all LEDs of a robot. For example, `Leds::new([leds[0], leds[2]])` drives only red and
/// blue. LEDs that are not driven keep their brightness.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Leds<A = ActuatorId, const N: usize = 3> {
    leds: [A; N],
}

impl<A, const N: usize> Leds<A, N> {
    /// Creates a motor for the given LEDs.
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

/// Sets the signal of a robot with one channel in [0, 1]. Other robots can receive it with a
/// [`crate::sensors::SignalSensor`].
#[doc(alias = "communication")]
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct SignalMotor<A = ActuatorId> {
    signal: A,
}

impl<A> SignalMotor<A> {
    /// Creates a motor for the given signal.
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
