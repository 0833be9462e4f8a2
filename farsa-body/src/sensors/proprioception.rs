//! Sensors of the body's own joints.

use crate::channel::{ChannelError, finite_range, write};
use crate::ports::{Channels, JointId, Joints, Sensor};

/// Reads one joint's position as a fraction of a range: (q - from) / (to - from), one channel.
///
/// The value is not clamped: a joint pushed beyond its range reads below 0 or above 1. A range may run downwards: a
/// finger that flexes towards -90 degrees reads q / (-90 degrees) with `from` 0 and `to` -pi/2. For a list of joints
/// take an array or a `Vec` of these.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct JointPosition<J = JointId> {
    joint: J,
    from: f32,
    span: f32,
}

impl<J> JointPosition<J> {
    /// A sensor that reads 0 at joint position `from` and 1 at `to` [rad or m].
    ///
    /// # Errors
    /// [`ChannelError::Range`] if the two are equal or not finite.
    pub fn new(joint: J, from: f32, to: f32) -> Result<Self, ChannelError> {
        finite_range(from, to)?;
        let span = to - from;
        // A span that underflowed would divide by zero as surely as an empty one.
        if span == 0.0 { Err(ChannelError::Range { from, to }) } else { Ok(Self { joint, from, span }) }
    }
}

impl<J> Channels for JointPosition<J> {
    fn channels(&self) -> usize {
        1
    }
}

impl<J: Copy, W: Joints<Joint = J> + ?Sized> Sensor<W> for JointPosition<J> {
    fn read(&mut self, world: &W, out: &mut [f32]) {
        write(out, [(world.position(self.joint) - self.from) / self.span]);
    }
}

/// Reads one joint's speed [rad/s or m/s], one channel. Wrap it in [`crate::wrappers::Scaled`] for other units.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct JointSpeed<J = JointId> {
    joint: J,
}

impl<J> JointSpeed<J> {
    /// A sensor of this joint's speed.
    pub fn new(joint: J) -> Self {
        Self { joint }
    }
}

impl<J> Channels for JointSpeed<J> {
    fn channels(&self) -> usize {
        1
    }
}

impl<J: Copy, W: Joints<Joint = J> + ?Sized> Sensor<W> for JointSpeed<J> {
    fn read(&mut self, world: &W, out: &mut [f32]) {
        write(out, [world.speed(self.joint)]);
    }
}
