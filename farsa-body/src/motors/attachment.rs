//! Attachment devices. Robots use them to hold objects and each other.

use crate::channel::write;
use crate::ports::{Actuated, ActuatorId, BodyId, Channels, Motor, Planar, Sensor};

/// A sensor with one channel that reads 1 if the attachment device of a robot holds something, and 0 otherwise.
#[doc(alias = "gripper")]
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct AttachmentSensor<B = BodyId> {
    body: B,
}

impl<B> AttachmentSensor<B> {
    /// Creates a sensor for the attachment device of the given robot.
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

/// A motor with one channel that controls an attachment device. It holds for values above 0.5 and releases otherwise.
///
/// NaN also releases the device.
#[doc(alias = "gripper")]
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct AttachmentMotor<A = ActuatorId> {
    device: A,
}

impl<A> AttachmentMotor<A> {
    /// Creates a motor for the given attachment device.
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
