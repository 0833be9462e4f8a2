//! Speeds of wheels and forces on them.

use crate::channel::{ChannelError, positive, signed_unit, unit, write};
use crate::ports::{BodyId, Channels, JointId, Joints, Kinematics, Sensor};

/// Reads how fast wheels turn, one channel each in [0, 1]: 1/2 + speed / (2 largest), 1/2 at rest.
///
/// After [`WheelSpeed::signed`] in [-1, 1]: speed / largest, 0 at rest. A faster wheel reads like one at its largest
/// speed, one whose speed is NaN like one at rest. Wrap it in [`crate::wrappers::Noisy`] for noise.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct WheelSpeed<J = JointId, const N: usize = 2> {
    wheels: [J; N],
    largest: f32,
    signed: bool,
}

impl<J, const N: usize> WheelSpeed<J, N> {
    /// A sensor of these wheels, whose `largest` speed [rad/s] either way reads 0 or 1.
    ///
    /// # Errors
    /// [`ChannelError::Value`] if `largest` is not a finite number > 0.
    pub fn new(wheels: [J; N], largest: f32) -> Result<Self, ChannelError> {
        Ok(Self { wheels, largest: positive("largest speed", largest)?, signed: false })
    }

    /// Makes readings in [-1, 1], with 0 at rest.
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

/// Reads where a robot on two wheels is pulled to, two channels in [-1, 1]: ahead and to the left.
///
/// It is the robot's velocity less the velocity of freely rolling wheels, in the robot's frame, over a largest speed:
/// (v - radius (left + right) / 2) / largest and sideways / largest. It is 0 where nothing pushes the robot. A robot
/// that drives against a wall reads -v / largest ahead. NaN reads as 0. Wrap it in [`crate::wrappers::Noisy`] for
/// noise.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Traction<B = BodyId, J = JointId> {
    body: B,
    wheels: [J; 2],
    wheel_radius: f32,
    largest: f32,
}

impl<B, J> Traction<B, J> {
    /// A sensor of a robot with these wheels, left and right, of `wheel_radius` [m]. A difference of `largest` [m/s]
    /// reads 1.
    ///
    /// # Errors
    /// [`ChannelError::Value`] if a number is not finite or not > 0.
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
