//! Devices by which robots hold on to things and to each other.

use crate::channel::write;
use crate::ports::{Actuated, ActuatorId, BodyId, Channels, Motor, Planar, Sensor};

/// Reads whether a robot's attachment device holds something: 1 if so, else 0. One channel.
#[doc(alias = "gripper")]
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct AttachmentSensor<B = BodyId> {
    body: B,
}

impl<B> AttachmentSensor<B> {
    /// A sensor of the device of this robot.
    pub fn new(body: B) -> Self {
        Self { body }
    }
}

impl<B> Channels for AttachmentSensor<B> {
    fn channels(&self) -> usize {
        1
    }
}

impl<B: Copy, W: Planar<Body = B> + ?Sized> Sensor<W> for AttachmentSensor<B> {
    fn read(&mut self, world: &W, out: &mut [f32]) {
        write(out, [if world.attached(self.body).is_some() { 1.0 } else { 0.0 }]);
    }
}

/// Switches an attachment device, one channel: above 0.5 it holds, else it lets go.
///
/// NaN lets go.
#[doc(alias = "gripper")]
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct AttachmentMotor<A = ActuatorId> {
    device: A,
}

impl<A> AttachmentMotor<A> {
    /// A motor of this device.
    pub fn new(device: A) -> Self {
        Self { device }
    }
}

impl<A> Channels for AttachmentMotor<A> {
    fn channels(&self) -> usize {
        1
    }
}

impl<A: Copy, W: Actuated<Actuator = A> + ?Sized> Motor<W> for AttachmentMotor<A> {
    fn drive(&mut self, y: &[f32], world: &mut W) {
        if let Some(&y) = y.first() {
            world.command(self.device, [if y > 0.5 { 1.0 } else { 0.0 }, 0.0]);
        }
    }
}
