//! Motors: from values in [0, 1] to commands.
//!
//! A value outside [0, 1] drives like the nearer end, NaN like 0.

use crate::channel::{ChannelError, finite, finite_range, unit};
use crate::ports::{Actuated, ActuatorId, Channels, Motor};

/// Drives one muscle pair, two channels: the activations of agonist and antagonist.
///
/// The agonist pulls towards the joint's lower limit. A slice with one value leaves the antagonist slack.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct Muscles<A = ActuatorId> {
    pair: A,
}

impl<A> Muscles<A> {
    /// A motor of this muscle pair.
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

/// A servo and the positions that it takes at the two ends of its motor's channel.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct ServoRange<A = ActuatorId> {
    /// The servo.
    pub servo: A,
    /// Desired position at channel value 0 [rad or m].
    pub from: f32,
    /// Desired position at channel value 1 [rad or m].
    pub to: f32,
}

/// Drives several servos from one channel: each is commanded to from + (to - from) y.
///
/// The servos are any list: an array, a borrowed slice, a `Vec`. For several groups take an array or a `Vec` of these.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ServoGroup<L> {
    servos: L,
}

impl<L> ServoGroup<L> {
    /// A motor of these servos.
    ///
    /// # Errors
    /// [`ChannelError::Range`] if an end of a servo's range is not finite.
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

/// Drives one torque motor, one channel: the torque is (2 y - 1) times the largest.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct TorqueMotor<A = ActuatorId> {
    motor: A,
    largest: f32,
}

impl<A> TorqueMotor<A> {
    /// A motor that turns the values 0, 1/2 and 1 into the torques -`largest`, 0 and `largest` [N m or N].
    ///
    /// # Errors
    /// [`ChannelError::Value`] if `largest` is not finite.
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

/// Drives one joint at a speed, one channel: the speed is (2 y - 1) times the largest.
///
/// The actuator's law is a [`Held`](crate::actuators::Held) without stiffness whose damping is the gain: its torque is gain times what is
/// lacking of the speed, solved implicitly.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct VelocityMotor<A = ActuatorId> {
    motor: A,
    largest: f32,
    gain: f32,
}

impl<A> VelocityMotor<A> {
    /// Builds a motor that turns the values 0, 1/2 and 1 into the speeds -`largest`, 0 and `largest` [rad/s or m/s].
    /// The actuator has this `gain` [N m s/rad or N s/m].
    ///
    /// # Errors
    /// [`ChannelError::Value`] if a number is not finite.
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
