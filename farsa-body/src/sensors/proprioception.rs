//! Sensors for the positions and speeds of joints.

use crate::channel::{ChannelError, finite_range, write};
use crate::ports::{Channels, JointId, Joints, Sensor};

/// A sensor with one channel that measures the position of a joint relative to a range. The value is (q - from) /
/// (to - from).
///
/// The reading is not clamped. It is below 0 or above 1 if the joint is pushed beyond the range. It is also possible to
/// use a decreasing range. For example, a finger that flexes towards -90 degrees can be measured with `from` 0 and `to`
/// -pi/2. Use an array or a `Vec` of these sensors to measure several joints.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct JointPosition<J = JointId> {
    joint: J,
    from: f32,
    span: f32,
}

impl<J> JointPosition<J> {
    /// Creates a sensor that reads 0 at the joint position `from` and 1 at `to` (in radians or meters).
    ///
    /// # Errors
    /// Returns [`ChannelError::Range`] if the two positions are equal or not finite.
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

/// A sensor with one channel that measures the speed of a joint (in radians or meters per second). Wrap it in
/// [`crate::wrappers::Scaled`] to use other units.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct JointSpeed<J = JointId> {
    joint: J,
}

impl<J> JointSpeed<J> {
    /// Creates a sensor for the speed of the given joint.
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
