//! Infrared sensors based on a formula, for planar worlds.

#[cfg(feature = "alloc")]
use alloc::vec::Vec;

use crate::channel::{ChannelError, direction, groups, positive};
use crate::ports::{BodyId, Channels, Kinematics, NearbySurface, Sensor, Sight};
#[cfg(feature = "alloc")]
use crate::robots::mobile::MobileRobot;
#[cfg(feature = "alloc")]
use crate::sensors::beam::Beam;
use crate::sensors::infrared::model::InfraredModel;
use crate::sensors::stance::Stance;

/// A ring of infrared sensors simulated by a formula (see [`InfraredModel`]). Each sensor has one channel in [0, 1].
///
/// The responses to all walls and all other bodies are added, and objects do not hide each other. A response depends on
/// the radius of the object and on the distance between the hull and its nearest point. It also depends on the angle
/// between the axis of the sensor and the bearing of this point from the center of the robot. The range is 33 mm for
/// walls and smaller for cylinders.
///
/// The axes are unit vectors in the frame of the robot and can be stored in any list. Wrap the sensor in
/// [`crate::wrappers::Noisy`] to add noise. See [`crate::sensors::infrared::InfraredRays`] for an example.
#[doc(alias = "proximity")]
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct InfraredFormula<L, B = BodyId> {
    body: B,
    axes: L,
    radius: f32,
    wall: InfraredModel,
}

impl<L: AsRef<[[f32; 2]]>, B> InfraredFormula<L, B> {
    /// Creates a ring of sensors with the given `axes` on the round hull of `body`. The `radius` is given in meters.
    ///
    /// # Errors
    /// Returns [`ChannelError::Groups`] if there are no axes. Returns [`ChannelError::Value`] if an axis is not a unit
    /// vector, or if `radius` is not a finite number > 0.
    pub fn new(body: B, axes: L, radius: f32) -> Result<Self, ChannelError> {
        groups("axes", axes.as_ref().len(), 1)?;
        axes.as_ref().iter().try_for_each(|&axis| direction("length of an axis", axis))?;
        Ok(Self { body, axes, radius: positive("radius", radius)?, wall: InfraredModel::for_radius(0.0) })
    }
}

#[cfg(feature = "alloc")]
impl<B> InfraredFormula<Vec<[f32; 2]>, B> {
    /// Creates the sensors of a robot, in the order of [`crate::robots::InfraredRing::angles`].
    ///
    /// # Errors
    /// Returns the errors of [`InfraredFormula::new`].
    pub fn for_robot(robot: &MobileRobot, body: B) -> Result<Self, ChannelError> {
        let axis = |&angle: &f64| Beam::in_cone(robot.radius, angle, 0.0, 0, 1).direction;
        Self::new(body, robot.infrared.angles.iter().map(axis).collect(), robot.radius as f32)
    }
}

impl<L: AsRef<[[f32; 2]]>, B> Channels for InfraredFormula<L, B> {
    fn channels(&self) -> usize {
        self.axes.as_ref().len()
    }
}

impl<L, B, W> Sensor<W> for InfraredFormula<L, B>
where
    L: AsRef<[[f32; 2]]>,
    B: Copy + PartialEq,
    W: Sight<Body = B> + Kinematics + ?Sized,
{
    fn read(&mut self, world: &W, out: &mut [f32]) {
        let (stance, axes) = (Stance::from_world(world, self.body), self.axes.as_ref());
        let channels = axes.len().min(out.len());
        let out = &mut out[..channels];
        out.fill(0.0);
        // A wall is seen from farthest.
        world.query_near(stance.at, self.radius + self.wall.range(), &mut |near: NearbySurface<B>| {
            if near.body == Some(self.body) {
                return;
            }
            let model = if near.radius > 0.0 { InfraredModel::for_radius(near.radius) } else { self.wall };
            let strength = model.distance_term(near.distance - self.radius);
            if strength > 0.0 {
                let bearing = stance.bearing(&near);
                for (o, axis) in out.iter_mut().zip(axes) {
                    *o += strength * model.angle_term(axis[0] * bearing[0] + axis[1] * bearing[1]);
                }
            }
        });
        for o in out {
            *o = InfraredModel::reading(*o);
        }
    }
}
