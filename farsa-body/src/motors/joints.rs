//! Motors that convert values in [0, 1] to commands for joints.
//!
//! Values outside [0, 1] are clamped, and NaN is treated as 0.

use crate::channel::{ChannelError, finite, finite_range, unit};
use crate::ports::{Actuated, ActuatorId, Channels, Motor};

/// Drives a pair of muscles. The two channels are the activations of the agonist and the antagonist.
///
/// The agonist pulls towards the lower limit of the joint. If only one value is provided, the activation of the
/// antagonist is 0.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct Muscles<A = ActuatorId> {
    pair: A,
}

impl<A> Muscles<A> {
    /// Creates a motor for the given muscle pair.
    pub fn new(pair: A) -> Self {
        Self { pair }
    }
}

impl<A> Channels for Muscles<A> {
    fn channels(&self) -> usize {
        2
    }
}

impl<A: Copy, W: Actuated<Actuator = A> + ?Sized> Motor<W> for Muscles<A> {
    fn drive(&mut self, y: &[f32], world: &mut W) {
        if let Some(&agonist) = y.first() {
            let antagonist = y.get(1).copied().unwrap_or(0.0);
            world.command(self.pair, [unit(agonist), unit(antagonist)]);
        }
    }
}

/// A servo, and its positions at both ends of the channel's range.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct ServoRange<A = ActuatorId> {
    /// Servo that the channel commands.
    pub servo: A,
    /// Desired position at a channel value of 0 (in radians or meters).
    pub from: f32,
    /// Desired position at a channel value of 1 (in radians or meters). It can be lower than `from`.
    pub to: f32,
}

/// Drives several servos with a single channel. The value y sets the desired position of each servo to from + (to -
/// from) y.
///
/// The servos can be stored in an array, a borrowed slice or a `Vec`. Use an array or a `Vec` of these motors to drive
/// several groups.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ServoGroup<L> {
    servos: L,
}

impl<L> ServoGroup<L> {
    /// Creates a motor for the given servos.
    ///
    /// # Errors
    /// Returns [`ChannelError::Range`] if an end of a range is not finite.
    pub fn new<A>(servos: L) -> Result<Self, ChannelError>
    where
        L: AsRef<[ServoRange<A>]>,
    {
        for servo in servos.as_ref() {
            finite_range(servo.from, servo.to)?;
        }
        Ok(Self { servos })
    }
}

impl<L> Channels for ServoGroup<L> {
    fn channels(&self) -> usize {
        1
    }
}

impl<L: AsRef<[ServoRange<W::Actuator>]>, W: Actuated + ?Sized> Motor<W> for ServoGroup<L> {
    fn drive(&mut self, y: &[f32], world: &mut W) {
        if let Some(&y) = y.first() {
            let y = unit(y);
            for servo in self.servos.as_ref() {
                world.command(servo.servo, [servo.from + (servo.to - servo.from) * y, 0.0]);
            }
        }
    }
}

/// Drives a torque motor with one channel. A value y results in 2 y - 1 times the largest torque.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct TorqueMotor<A = ActuatorId> {
    motor: A,
    largest: f32,
}

impl<A> TorqueMotor<A> {
    /// Creates a motor that maps the values 0, 1/2 and 1 to the torques -`largest`, 0 and `largest` (in N m or N).
    ///
    /// # Errors
    /// Returns [`ChannelError::Value`] if `largest` is not finite.
    pub fn new(motor: A, largest: f32) -> Result<Self, ChannelError> {
        Ok(Self { motor, largest: finite("largest", largest)? })
    }
}

impl<A> Channels for TorqueMotor<A> {
    fn channels(&self) -> usize {
        1
    }
}

impl<A: Copy, W: Actuated<Actuator = A> + ?Sized> Motor<W> for TorqueMotor<A> {
    fn drive(&mut self, y: &[f32], world: &mut W) {
        if let Some(&y) = y.first() {
            let y = unit(y);
            world.command(self.motor, [(y + y - 1.0) * self.largest, 0.0]);
        }
    }
}

/// Drives a joint at a desired speed with one channel. A value y results in 2 y - 1 times the largest speed.
///
/// The law of the actuator must be [`Held`](crate::actuators::Held) with zero stiffness and a damping equal to the
/// gain. The torque is then the product of the gain and the speed error, and it is integrated implicitly.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct VelocityMotor<A = ActuatorId> {
    motor: A,
    largest: f32,
    gain: f32,
}

impl<A> VelocityMotor<A> {
    /// Creates a motor that maps the values 0, 1/2 and 1 to the speeds -`largest`, 0 and `largest` (in rad/s or m/s).
    /// The `gain` must be that of the actuator (in N m s/rad or N s/m).
    ///
    /// # Errors
    /// Returns [`ChannelError::Value`] if a number is not finite.
    pub fn new(motor: A, largest: f32, gain: f32) -> Result<Self, ChannelError> {
        Ok(Self { motor, largest: finite("largest", largest)?, gain: finite("gain", gain)? })
    }
}

impl<A> Channels for VelocityMotor<A> {
    fn channels(&self) -> usize {
        1
    }
}

impl<A: Copy, W: Actuated<Actuator = A> + ?Sized> Motor<W> for VelocityMotor<A> {
    fn drive(&mut self, y: &[f32], world: &mut W) {
        if let Some(&y) = y.first() {
            let y = unit(y);
            world.command(self.motor, [(y + y - 1.0) * self.largest * self.gain, 0.0]);
        }
    }
}
