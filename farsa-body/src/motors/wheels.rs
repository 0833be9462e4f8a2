//! Motors for robots with two wheels.
//!
//! Values outside [0, 1] are clamped, and NaN is treated as 0.

use farsa_num::Scalar;

use crate::channel::{ChannelError, positive, unit};
use crate::ports::{Actuated, ActuatorId, Channels, Motor};

/// Drives the left and the right wheel with one channel each. A value y results in 2 y - 1 times the largest speed.
///
/// If only one value is provided, only the left wheel is driven. Wrap the motor in [`crate::wrappers::Noisy`] to add
/// noise.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct WheelVelocity<A = ActuatorId> {
    wheels: [A; 2],
    largest: f32,
}

impl<A> WheelVelocity<A> {
    /// Creates a motor that maps the values 0, 1/2 and 1 to the speeds -`largest`, 0 and `largest` (in rad/s). The left
    /// wheel comes first.
    ///
    /// # Errors
    /// Returns [`ChannelError::Value`] if `largest` is not a finite number > 0.
    pub fn new(wheels: [A; 2], largest: f32) -> Result<Self, ChannelError> {
        Ok(Self { wheels, largest: positive("largest speed", largest)? })
    }
}

impl<A> Channels for WheelVelocity<A> {
    fn channels(&self) -> usize {
        2
    }
}

impl<A: Copy, W: Actuated<Actuator = A> + ?Sized> Motor<W> for WheelVelocity<A> {
    fn drive(&mut self, y: &[f32], world: &mut W) {
        for (&wheel, &y) in self.wheels.iter().zip(y) {
            let y = unit(y);
            world.command(wheel, [(y + y - 1.0) * self.largest, 0.0]);
        }
    }
}

/// Drives both wheels with two channels that control the speed and the turn.
///
/// Let s = 2 y - 1 for the first channel and t = 2 y - 1 for the second one. The left wheel turns at (s - t) and the
/// right wheel at (s + t) times the largest speed. The robot drives backwards if the first channel is 0 and forwards if
/// it is 1. After [`SpeedAndTurn::forwards`], s = y is used instead. The robot turns right if the second channel is 0
/// and left if it is 1.
///
/// If a wheel would exceed the largest speed, both wheels are slowed down by the same factor, so that the curvature of
/// the path is preserved. If only one value is provided, the robot drives straight ahead. Wrap the motor in
/// [`crate::wrappers::Noisy`] to add noise.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SpeedAndTurn<A = ActuatorId> {
    wheels: [A; 2],
    largest: f32,
    forwards: bool,
}

impl<A> SpeedAndTurn<A> {
    /// Creates a motor for the left and the right wheel. Their largest speed in both directions is `largest` (in
    /// radians per second).
    ///
    /// # Errors
    /// Returns [`ChannelError::Value`] if `largest` is not a finite number > 0.
    pub fn new(wheels: [A; 2], largest: f32) -> Result<Self, ChannelError> {
        Ok(Self { wheels, largest: positive("largest speed", largest)?, forwards: false })
    }

    /// Changes the first channel such that the robot never drives backwards. It stops at 0.
    pub fn forwards(self) -> Self {
        Self { forwards: true, ..self }
    }
}

impl<A> Channels for SpeedAndTurn<A> {
    fn channels(&self) -> usize {
        2
    }
}

impl<A: Copy, W: Actuated<Actuator = A> + ?Sized> Motor<W> for SpeedAndTurn<A> {
    fn drive(&mut self, y: &[f32], world: &mut W) {
        let Some(&speed) = y.first() else { return };
        let both_ways = |y: f32| y + y - 1.0;
        let speed = if self.forwards { unit(speed) } else { both_ways(unit(speed)) };
        let turn = both_ways(y.get(1).map_or(0.5, |&y| unit(y)));
        let speeds = [speed - turn, speed + turn];
        let fastest = Scalar::max(Scalar::max(speeds[0].abs(), speeds[1].abs()), 1.0);
        for (&wheel, speed) in self.wheels.iter().zip(speeds) {
            world.command(wheel, [speed / fastest * self.largest, 0.0]);
        }
    }
}
