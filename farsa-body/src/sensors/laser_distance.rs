//! Laser range finders.

use crate::channel::{ChannelError, finite, groups, positive, unit};
use crate::ports::{BodyId, Channels, Kinematics, Rays, Sensor};
use crate::sensors::beam::{Beam, BeamFrame};

/// A sensor that measures distances along several beams. Each beam has one channel in [0, 1]. Its value
/// is distance / range, or 1 if nothing is within the range.
///
/// Distances are measured from the hull. The beams can be stored in any list, for example one created with
/// [`Beam::in_cone`]. Wrap the sensor in [`crate::wrappers::Noisy`] to add noise.
#[doc(alias = "lidar")]
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct LaserDistance<L, B = BodyId> {
    body: B,
    beams: L,
    height: f32,
    range: f32,
}

impl<L: AsRef<[Beam]>, B> LaserDistance<L, B> {
    /// Creates a sensor at `height` (in meters) above the origin of `body`. Its beams have a range of `range` (in
    /// meters) from the hull.
    ///
    /// # Errors
    /// Returns [`ChannelError::Groups`] if there are no beams. Returns [`ChannelError::Value`] if a direction is not a
    /// unit vector, if a number is not finite, or if `range` is not > 0.
    pub fn new(body: B, beams: L, height: f32, range: f32) -> Result<Self, ChannelError> {
        groups("beams", beams.as_ref().len(), 1)?;
        beams.as_ref().iter().try_for_each(Beam::check)?;
        Ok(Self { body, beams, height: finite("height", height)?, range: positive("range", range)? })
    }
}

impl<L: AsRef<[Beam]>, B> Channels for LaserDistance<L, B> {
    fn channels(&self) -> usize {
        self.beams.as_ref().len()
    }
}

impl<L, B, W> Sensor<W> for LaserDistance<L, B>
where
    L: AsRef<[Beam]>,
    B: Copy + PartialEq,
    W: Rays<Body = B> + Kinematics + ?Sized,
{
    fn read(&mut self, world: &W, out: &mut [f32]) {
        let frame = BeamFrame::from_world(world, self.body, self.height);
        for (o, beam) in out.iter_mut().zip(self.beams.as_ref()) {
            *o = frame
                .distance(world, beam, self.range, |_, _| true)
                .map_or(1.0, |distance| unit(distance / self.range));
        }
    }
}
