//! Sensors of where bodies are and how they move.

use crate::channel::{ChannelError, finite, write};
use crate::ports::{BodyId, Channels, Kinematics, Sensor};

/// A point fixed to a body.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct Point<B = BodyId> {
    /// The body.
    pub body: B,
    /// The point in the body's frame [m].
    pub at: [f32; 3],
}

impl<B: Copy> Point<B> {
    /// The origin of a body's frame.
    pub fn origin(body: B) -> Self {
        Self { body, at: [0.0; 3] }
    }

    /// Where the point is in the world [m].
    pub fn position<W: Kinematics<Body = B> + ?Sized>(&self, world: &W) -> [f32; 3] {
        world.pose(self.body).transform(self.at)
    }
}

/// The axes in which a vector is read.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Default)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize), serde(rename_all = "kebab-case"))]
pub enum Axes {
    /// The body of the sensor.
    #[default]
    Body,
    /// The world.
    World,
}

/// Reads where a target is relative to a point of the own body, three channels (x, y, z).
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct TargetPosition<B = BodyId> {
    target: Point<B>,
    from: Point<B>,
    axes: Axes,
    scale: f32,
}

impl<B> TargetPosition<B> {
    /// A sensor of `scale` times the way from `from` to `target`. `scale` 1 reads meters, 100 centimeters.
    ///
    /// [`Axes::Body`] are those of the body of `from`.
    ///
    /// # Errors
    /// [`ChannelError::Value`] if a number is not finite.
    pub fn new(target: Point<B>, from: Point<B>, axes: Axes, scale: f32) -> Result<Self, ChannelError> {
        for x in target.at {
            finite("target", x)?;
        }
        for x in from.at {
            finite("from", x)?;
        }
        Ok(Self { target, from, axes, scale: finite("scale", scale)? })
    }
}

impl<B> Channels for TargetPosition<B> {
    fn channels(&self) -> usize {
        3
    }
}

impl<B: Copy, W: Kinematics<Body = B> + ?Sized> Sensor<W> for TargetPosition<B> {
    fn read(&mut self, world: &W, out: &mut [f32]) {
        let target = self.target.position(world);
        let base = world.pose(self.from.body);
        let from = base.transform(self.from.at);
        let way = [target[0] - from[0], target[1] - from[1], target[2] - from[2]];
        let way = match self.axes {
            Axes::Body => base.rotate_back(way),
            Axes::World => way,
        };
        write(out, way.map(|x| x * self.scale));
    }
}

/// Reads the height of a point of a body above the world's origin [m], one channel.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct Height<B = BodyId> {
    point: Point<B>,
}

impl<B> Height<B> {
    /// A sensor of this point's height.
    pub fn new(point: Point<B>) -> Self {
        Self { point }
    }
}

impl<B> Channels for Height<B> {
    fn channels(&self) -> usize {
        1
    }
}

impl<B: Copy, W: Kinematics<Body = B> + ?Sized> Sensor<W> for Height<B> {
    fn read(&mut self, world: &W, out: &mut [f32]) {
        write(out, [self.point.position(world)[2]]);
    }
}

/// Reads a body's position in the world [m] and its orientation as a unit quaternion x, y, z, w: seven channels.
///
/// The quaternion with w >= 0 is read, so that equal orientations have equal readings.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct BodyPose<B = BodyId> {
    body: B,
}

impl<B> BodyPose<B> {
    /// A sensor of this body's pose.
    pub fn new(body: B) -> Self {
        Self { body }
    }
}

impl<B> Channels for BodyPose<B> {
    fn channels(&self) -> usize {
        7
    }
}

impl<B: Copy, W: Kinematics<Body = B> + ?Sized> Sensor<W> for BodyPose<B> {
    fn read(&mut self, world: &W, out: &mut [f32]) {
        let pose = world.pose(self.body);
        let [x, y, z] = pose.position;
        let [qx, qy, qz, qw] = if pose.rotation[3] < 0.0 { pose.rotation.map(|q| -q) } else { pose.rotation };
        write(out, [x, y, z, qx, qy, qz, qw]);
    }
}

/// Reads the velocity of a body's origin [m/s] and its angular velocity [rad/s]: six channels.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct BodyVelocity<B = BodyId> {
    body: B,
    axes: Axes,
}

impl<B> BodyVelocity<B> {
    /// A sensor of this body's velocities, both in the same axes.
    pub fn new(body: B, axes: Axes) -> Self {
        Self { body, axes }
    }
}

impl<B> Channels for BodyVelocity<B> {
    fn channels(&self) -> usize {
        6
    }
}

impl<B: Copy, W: Kinematics<Body = B> + ?Sized> Sensor<W> for BodyVelocity<B> {
    fn read(&mut self, world: &W, out: &mut [f32]) {
        let twist = world.velocity(self.body);
        let (linear, angular) = match self.axes {
            Axes::World => (twist.linear, twist.angular),
            Axes::Body => {
                let pose = world.pose(self.body);
                (pose.rotate_back(twist.linear), pose.rotate_back(twist.angular))
            }
        };
        let ([x, y, z], [wx, wy, wz]) = (linear, angular);
        write(out, [x, y, z, wx, wy, wz]);
    }
}
