//! Infrared sensors simulated by rays. They work in any world that supports ray casts.

#[cfg(feature = "alloc")]
use alloc::vec::Vec;

use farsa_num::Scalar;

use crate::channel::{ChannelError, finite, groups, positive, unit};
use crate::ports::{BodyId, Channels, Kinematics, Rays, Sensor};
#[cfg(feature = "alloc")]
use crate::robots::mobile::MobileRobot;
use crate::sensors::beam::{Beam, BeamFrame};

/// A ring of infrared sensors that measure the proximity of the nearest surface in a cone. Each sensor has one channel
/// in [0, 1]. The reading is 1 - distance / range. It is 1 at the hull and 0 if nothing is within the range.
///
/// The distance is that of the nearest hit of all rays in the cone, measured along the ray from the hull. A larger
/// number of rays detects smaller objects, but does not change the reading for a wall in front of the sensor. Note that
/// a real sensor sums up the light of the whole cone. For a more accurate model, use
/// [`SampledInfrared`](crate::sensors::infrared::SampledInfrared). The robot itself is invisible.
///
/// The beams can be stored in any list and are grouped by sensor. Use a wrapper to add noise:
///
/// ```
/// # #[cfg(feature = "alloc")] {
/// use farsa_body::ports::BodyId;
/// use farsa_body::robots::MobileRobot;
/// use farsa_body::sensors::infrared::InfraredRays;
/// use farsa_body::wrappers::{Noise, Noisy, Saturated};
/// use farsa_num::{Domain, Stream};
///
/// let ring = InfraredRays::for_robot(&MobileRobot::khepera(), BodyId(0))?;
/// let noise = Noisy::new(ring, Noise::Uniform(0.05), Stream::new(7, Domain::Sensor, 0, 0, 0))?;
/// let ring = Saturated::new(noise, 0.0, 1.0)?; // noise is never clamped by itself
/// # }
/// # Ok::<(), farsa_body::ChannelError>(())
/// ```
#[doc(alias = "proximity")]
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct InfraredRays<L, B = BodyId> {
    body: B,
    beams: L,
    rays: usize,
    height: f32,
    range: f32,
}

impl<L: AsRef<[Beam]>, B> InfraredRays<L, B> {
    /// Creates sensors with `rays` beams each. They are located at `height` (in meters) above the origin of `body` and
    /// have a range of `range` (in meters) from the hull.
    ///
    /// # Errors
    /// Returns [`ChannelError::Groups`] if the number of beams is not a multiple of `rays`. Returns
    /// [`ChannelError::Value`] if a direction is not a unit vector, if a number is not finite, or if `range` is not >
    /// 0.
    pub fn new(body: B, beams: L, rays: usize, height: f32, range: f32) -> Result<Self, ChannelError> {
        groups("beams", beams.as_ref().len(), rays)?;
        beams.as_ref().iter().try_for_each(Beam::check)?;
        Ok(Self { body, beams, rays, height: finite("height", height)?, range: positive("range", range)? })
    }
}

impl<L: AsRef<[Beam]>, B: Copy + PartialEq> InfraredRays<L, B> {
    /// Reads the sensors like [`Sensor::read`], but skips rays that cannot hit anything.
    ///
    /// The closure `meets` is called with both ends of a ray (in meters) and returns true if there may be something
    /// between them. Skipped rays read 0.
    #[inline]
    pub fn read_where<W>(&self, world: &W, out: &mut [f32], mut meets: impl FnMut([f32; 3], [f32; 3]) -> bool)
    where
        W: Rays<Body = B> + Kinematics + ?Sized,
    {
        let frame = BeamFrame::from_world(world, self.body, self.height);
        for (o, cone) in out.iter_mut().zip(self.beams.as_ref().chunks_exact(self.rays)) {
            let mut nearest = self.range;
            for beam in cone {
                if let Some(distance) = frame.distance(world, beam, self.range, &mut meets) {
                    nearest = Scalar::min(nearest, distance);
                }
            }
            *o = unit(1.0 - nearest / self.range);
        }
    }
}

#[cfg(feature = "alloc")]
impl<B> InfraredRays<Vec<Beam>, B> {
    /// Creates the sensors of a robot at half its height, in the order of [`crate::robots::InfraredRing::angles`].
    ///
    /// # Errors
    /// Returns the errors of [`InfraredRays::new`].
    pub fn for_robot(robot: &MobileRobot, body: B) -> Result<Self, ChannelError> {
        let (ring, rays) = (&robot.infrared, robot.infrared.rays);
        let cone =
            |&angle: &f64| (0..rays).map(move |ray| Beam::in_cone(robot.radius, angle, ring.aperture, ray, rays));
        let beams = ring.angles.iter().flat_map(cone).collect();
        Self::new(body, beams, rays, (0.5 * robot.height) as f32, ring.range as f32)
    }
}

impl<L: AsRef<[Beam]>, B> Channels for InfraredRays<L, B> {
    fn channels(&self) -> usize {
        self.beams.as_ref().len() / self.rays
    }
}

impl<L, B, W> Sensor<W> for InfraredRays<L, B>
where
    L: AsRef<[Beam]>,
    B: Copy + PartialEq,
    W: Rays<Body = B> + Kinematics + ?Sized,
{
    fn read(&mut self, world: &W, out: &mut [f32]) {
        self.read_where(world, out, |_, _| true);
    }
}
