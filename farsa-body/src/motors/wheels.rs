//! Motors of robots on two wheels.
//!
//! As for all motors, a value outside [0, 1] drives like the nearer end, NaN like 0.

use farsa_num::Scalar;

use crate::channel::{ChannelError, positive, unit};
use crate::ports::{Actuated, ActuatorId, Channels, Motor};

/// Drives the left and the right wheel, one channel each: the speed is (2 y - 1) times the largest.
///
/// A shorter slice drives the left wheel only. Wrap it in [`crate::wrappers::Noisy`] for noise.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct WheelVelocity<A = ActuatorId> {
    wheels: [A; 2],
    largest: f32,
}

impl<A> WheelVelocity<A> {
    /// A motor that turns the values 0, 1/2 and 1 into the speeds -`largest`, 0 and `largest` [rad/s]. `wheels` left
    /// and right.
    ///
    /// # Errors
    /// [`ChannelError::Value`] if `largest` is not a finite number > 0.
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

/// Drives both wheels by a speed and a turn, two channels.
///
/// With s = 2 y - 1 of the first channel and t = 2 y - 1 of the second, the left wheel turns at (s - t) and the right
/// at (s + t) times the largest speed. The first channel drives backwards at 0 and forwards at 1, or has s = y after
/// [`SpeedAndTurn::forwards`]. The second turns right at 0 and left at 1.
///
/// If a wheel would exceed the largest speed, both are slowed down by the same factor, so that the robot keeps its
/// curve. A slice with one value drives straight ahead.
///
/// Wrap it in [`crate::wrappers::Noisy`] for noise.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SpeedAndTurn<A = ActuatorId> {
    wheels: [A; 2],
    largest: f32,
    forwards: bool,
}

impl<A> SpeedAndTurn<A> {
    /// A motor of these wheels, left and right, which turn at most at `largest` [rad/s] either way.
    ///
    /// # Errors
    /// [`ChannelError::Value`] if `largest` is not a finite number > 0.
    pub fn new(wheels: [A; 2], largest: f32) -> Result<Self, ChannelError> {
        Ok(Self { wheels, largest: positive("largest speed", largest)?, forwards: false })
    }

    /// Makes a robot that never drives backwards and rests at 0 of the first channel.
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
