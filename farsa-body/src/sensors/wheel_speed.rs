//! Sensors for the speeds of wheels and for external forces on wheeled robots.

use crate::channel::{ChannelError, positive, signed_unit, unit, write};
use crate::ports::{BodyId, Channels, JointId, Joints, Kinematics, Sensor};

/// A sensor that measures the speeds of wheels. Each wheel has one channel in [0, 1]. Its value is 1/2 + speed /
/// (2 largest), or 1/2 at rest.
///
/// Use [`WheelSpeed::signed`] for readings of speed / largest in [-1, 1]. They are 0 at rest. Speeds beyond the
/// largest speed are clamped, and NaN is read like a wheel at rest. Wrap the sensor in [`crate::wrappers::Noisy`] to
/// add noise.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct WheelSpeed<J = JointId, const N: usize = 2> {
    wheels: [J; N],
    largest: f32,
    signed: bool,
}

impl<J, const N: usize> WheelSpeed<J, N> {
    /// Creates a sensor for the given wheels. Their `largest` speed (in rad/s) reads 1, and 0 in the opposite
    /// direction.
    ///
    /// # Errors
    /// Returns [`ChannelError::Value`] if `largest` is not a finite number > 0.
    pub fn new(wheels: [J; N], largest: f32) -> Result<Self, ChannelError> {
        Ok(Self { wheels, largest: positive("largest speed", largest)?, signed: false })
    }

    /// Changes the readings to [-1, 1], with 0 at rest.
    pub fn signed(self) -> Self {
        Self { signed: true, ..self }
    }
}

impl<J, const N: usize> Channels for WheelSpeed<J, N> {
    fn channels(&self) -> usize {
        N
    }
}

impl<J: Copy, const N: usize, W: Joints<Joint = J> + ?Sized> Sensor<W> for WheelSpeed<J, N> {
    fn read(&mut self, world: &W, out: &mut [f32]) {
        for (o, &wheel) in out.iter_mut().zip(&self.wheels) {
            let speed = signed_unit(world.speed(wheel) / self.largest);
            *o = if self.signed { speed } else { unit(0.5 + 0.5 * speed) };
        }
    }
}

/// A sensor that measures in which direction a robot with two wheels is pulled. Its two channels in [-1, 1] are the
/// components ahead and to the left.
///
/// The readings are computed from the difference between the velocity of the robot and the velocity of freely rolling
/// wheels in the frame of the robot. They are (v - radius (left + right) / 2) / largest and sideways / largest. Both
/// are 0 if nothing pushes the robot. If it drives against a wall, the first channel is -v / largest. NaN is replaced
/// by 0. Wrap the sensor in [`crate::wrappers::Noisy`] to add noise.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Traction<B = BodyId, J = JointId> {
    body: B,
    wheels: [J; 2],
    wheel_radius: f32,
    largest: f32,
}

impl<B, J> Traction<B, J> {
    /// Creates a sensor for a robot with a left and a right wheel of the given radius (in meters). A difference of
    /// `largest` (in m/s) results in a reading of 1.
    ///
    /// # Errors
    /// Returns [`ChannelError::Value`] if a number is not finite or not > 0.
    pub fn new(body: B, wheels: [J; 2], wheel_radius: f32, largest: f32) -> Result<Self, ChannelError> {
        let (wheel_radius, largest) = (positive("wheel radius", wheel_radius)?, positive("largest speed", largest)?);
        Ok(Self { body, wheels, wheel_radius, largest })
    }
}

impl<B, J> Channels for Traction<B, J> {
    fn channels(&self) -> usize {
        2
    }
}

impl<B: Copy, J: Copy, W> Sensor<W> for Traction<B, J>
where
    W: Kinematics<Body = B> + Joints<Joint = J> + ?Sized,
{
    fn read(&mut self, world: &W, out: &mut [f32]) {
        let [left, right] = self.wheels.map(|wheel| world.speed(wheel));
        let [ahead, aside, _] = world.pose(self.body).rotate_back(world.velocity(self.body).linear);
        let wanted = self.wheel_radius * 0.5 * (left + right);
        write(out, [ahead - wanted, aside].map(|x| signed_unit(x / self.largest)));
    }
}
