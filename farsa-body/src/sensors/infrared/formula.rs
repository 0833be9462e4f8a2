//! Infrared sensors by the analytic model, for worlds of the plane.

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

/// Reads a ring of infrared sensors by the model [`InfraredModel`], one channel each in [0, 1].
///
/// Every wall and every other body adds its response, and nothing hides anything. The response depends on the distance
/// of the nearest point to the hull, the radius, and the angle between the sensor's axis and that point's bearing from
/// the robot's center. The range is the model's: 33 mm for a wall, less for a cylinder.
///
/// The axes are any list of unit vectors in the robot's frame. Wrap it in [`crate::wrappers::Noisy`] for noise, as
/// [`crate::sensors::infrared::InfraredRays`] shows.
#[doc(alias = "proximity")]
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct InfraredFormula<L, B = BodyId> {
    body: B,
    axes: L,
    radius: f32,
    wall: InfraredModel,
}

impl<L: AsRef<[[f32; 2]]>, B> InfraredFormula<L, B> {
    /// A ring of sensors around the round hull of `radius` [m] of `body`, which look along these `axes`.
    ///
    /// # Errors
    /// [`ChannelError::Groups`] if there are no axes, [`ChannelError::Value`] if one is no unit vector or `radius` is not
    /// a finite number > 0.
    pub fn new(body: B, axes: L, radius: f32) -> Result<Self, ChannelError> {
        groups("axes", axes.as_ref().len(), 1)?;
        axes.as_ref().iter().try_for_each(|&axis| direction("length of an axis", axis))?;
        Ok(Self { body, axes, radius: positive("radius", radius)?, wall: InfraredModel::for_radius(0.0) })
    }
}

#[cfg(feature = "alloc")]
impl<B> InfraredFormula<Vec<[f32; 2]>, B> {
    /// The ring of a robot whose body this is, in the order of [`crate::robots::InfraredRing::angles`].
    ///
    /// # Errors
    /// The errors of [`InfraredFormula::new`].
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
