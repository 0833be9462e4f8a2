//! Sensors for the position and velocity of bodies.

use crate::channel::{ChannelError, finite, write};
use crate::ports::{BodyId, Channels, Kinematics, Sensor};

/// A point fixed to a body.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct Point<B = BodyId> {
    /// Body to which the point is fixed.
    pub body: B,
    /// Position of the point in the frame of the body (in meters).
    pub at: [f32; 3],
}

impl<B: Copy> Point<B> {
    /// Returns the origin of a body's frame.
    pub fn origin(body: B) -> Self {
        Self { body, at: [0.0; 3] }
    }

    /// Returns the position of the point in the world (in meters).
    pub fn position<W: Kinematics<Body = B> + ?Sized>(&self, world: &W) -> [f32; 3] {
        // Some worlds compute the origin without the rotation.
        if self.at == [0.0; 3] { world.origin(self.body) } else { world.pose(self.body).transform(self.at) }
    }
}

/// The axes in which a vector is measured.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Default)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize), serde(rename_all = "kebab-case"))]
pub enum Axes {
    /// Axes of the body that carries the sensor.
    #[default]
    Body,
    /// Axes of the world.
    World,
}

/// A sensor that measures the position of a target relative to a point of a body. Its three channels are x, y and z.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct TargetPosition<B = BodyId> {
    target: Point<B>,
    from: Point<B>,
    axes: Axes,
    scale: f32,
}

impl<B> TargetPosition<B> {
    /// Creates a sensor that measures the vector from `from` to `target`, multiplied by `scale`. A scale of 1 results
    /// in meters and a scale of 100 in centimeters.
    ///
    /// With [`Axes::Body`], the vector is measured in the frame of the body of `from`.
    ///
    /// # Errors
    /// Returns [`ChannelError::Value`] if a number is not finite.
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

/// A sensor with one channel that measures the height of a point above the origin of the world (in meters).
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct Height<B = BodyId> {
    point: Point<B>,
}

impl<B> Height<B> {
    /// Creates a sensor for the height of the given point.
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

/// A sensor that measures the pose of a body. Its seven channels are the position in the world (in meters) and the
/// orientation as a unit quaternion x, y, z, w.
///
/// The sign of the quaternion is chosen such that w >= 0. Therefore equal orientations always result in equal readings.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct BodyPose<B = BodyId> {
    body: B,
}

impl<B> BodyPose<B> {
    /// Creates a sensor for the pose of the given body.
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

/// A sensor that measures the velocity of a body. Its six channels are the velocity of the origin (in m/s) and the
/// angular velocity (in rad/s).
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct BodyVelocity<B = BodyId> {
    body: B,
    axes: Axes,
}

impl<B> BodyVelocity<B> {
    /// Creates a sensor for the velocities of the given body. Both are measured in the same axes.
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
