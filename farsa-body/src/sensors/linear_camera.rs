//! A camera with a single row of sectors.

#[cfg(feature = "alloc")]
use alloc::vec::Vec;

use crate::channel::{ChannelError, finite_range, groups, positive};
use crate::ports::{BodyId, Channels, Kinematics, NearbySurface, Sensor, Sight};
use crate::pose::Pose;
use crate::sensors::beam::Beam;
use crate::sensors::stance::Stance;

/// A range of colors that a camera recognizes. The limits apply to red, green and blue separately.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct ColorBand {
    /// Lower limits of red, green and blue.
    pub low: [f32; 3],
    /// Upper limits of red, green and blue.
    pub high: [f32; 3],
}

impl ColorBand {
    /// Returns the range of all colors whose components differ from `color` by at most `tolerance`.
    pub fn around(color: [f32; 3], tolerance: f32) -> Self {
        Self { low: color.map(|x| x - tolerance), high: color.map(|x| x + tolerance) }
    }

    /// Checks that it is finite and does not run backwards.
    pub(crate) fn check(&self) -> Result<(), ChannelError> {
        self.low.into_iter().zip(self.high).try_for_each(|(from, to)| {
            finite_range(from, to)?;
            if from > to { Err(ChannelError::Range { from, to }) } else { Ok(()) }
        })
    }

    /// Returns true if the color is in the range.
    #[inline]
    pub fn shows(&self, color: [f32; 3]) -> bool {
        (0..3).all(|i| self.low[i] <= color[i] && color[i] <= self.high[i])
    }
}

/// A sensor that measures how much of each sector of a robot's view shows each of several colors. It has sectors x
/// colors channels in [0, 1], starting with all colors of the leftmost sector.
///
/// Each sector is sampled by rays. A ray detects the nearest surface, and a channel is the share of rays in its sector
/// that detect its color. Note that colors are never mixed. A ray that detects magenta counts for bands that contain
/// magenta, but not for red or blue. The body of the robot itself is invisible.
///
/// The rays and the bands can be stored in any list. Wrap the sensor in [`crate::wrappers::Noisy`] to add noise. The
/// following example detects red and blue robots on both sides, even if the other LED of a robot is on as well:
///
/// ```
/// # #[cfg(feature = "alloc")] {
/// use farsa_body::ports::{Channels, Sensor};
/// use farsa_body::robots::MobileRobot;
/// use farsa_body::sensors::{ColorBand, LinearCamera};
/// use farsa_body::testing::PlaneWorld;
///
/// let red = ColorBand { low: [0.5, 0.0, 0.0], high: [1.0, 0.3, 1.0] };
/// let blue = ColorBand { low: [0.0, 0.0, 0.5], high: [1.0, 0.3, 1.0] };
/// let mut world = PlaneWorld::new();
/// let robot = world.add_robot(&MobileRobot::marxbot(), [0.0, 0.0], 0.0);
/// world.add_disc([1.0, 0.3], 0.2, [1.0, 0.0, 0.0]);
/// let mut camera = LinearCamera::for_view(robot.body, 1.0, 2, 10, [red, blue], 5.0)?;
/// let mut x = [0.0; 4];
/// camera.read(&world, &mut x);
/// assert_eq!(x, [0.8, 0.0, 0.0, 0.0]);
/// # }
/// # Ok::<(), farsa_body::ChannelError>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct LinearCamera<R, C, B = BodyId> {
    body: B,
    rays: R,
    per_sector: usize,
    bands: C,
    range: f32,
    wedge: Wedge,
}

impl<R: AsRef<[Beam]>, C: AsRef<[ColorBand]>, B> LinearCamera<R, C, B> {
    /// Creates a camera on `body` with `per_sector` rays in each sector and a range of `range` (in meters). Use
    /// [`Beam::in_view`] to create the rays.
    ///
    /// # Errors
    /// Returns [`ChannelError::Groups`] if the number of rays is not a multiple of `per_sector` or if there are no
    /// bands. Returns [`ChannelError::Range`] if a band is not finite or its ends are in the wrong order. Returns
    /// [`ChannelError::Value`] if a direction is not a unit vector, if a position is not finite, or if `range` is not a
    /// finite number > 0.
    pub fn new(body: B, rays: R, per_sector: usize, bands: C, range: f32) -> Result<Self, ChannelError> {
        groups("rays", rays.as_ref().len(), per_sector)?;
        groups("colours", bands.as_ref().len(), 1)?;
        rays.as_ref().iter().try_for_each(Beam::check)?;
        bands.as_ref().iter().try_for_each(ColorBand::check)?;
        let wedge = Wedge::around(rays.as_ref());
        Ok(Self { body, rays, per_sector, bands, range: positive("range", range)?, wedge })
    }
}

#[cfg(feature = "alloc")]
impl<C: AsRef<[ColorBand]>, B> LinearCamera<Vec<Beam>, C, B> {
    /// Creates a camera at the origin of `body` that looks ahead. The field of view (in radians) is divided into equal
    /// sectors with `per_sector` rays each. A field of view of 2 pi covers all directions.
    ///
    /// # Errors
    /// Returns [`ChannelError::Value`] if the field of view is not between 0 and 2 pi, and the errors of
    /// [`LinearCamera::new`].
    pub fn for_view(
        body: B,
        field_of_view: f64,
        sectors: usize,
        per_sector: usize,
        bands: C,
        range: f32,
    ) -> Result<Self, ChannelError> {
        const FULL: f64 = 2.0 * core::f64::consts::PI;
        if !(field_of_view > 0.0 && field_of_view <= FULL + ROUNDED) {
            return Err(ChannelError::Value { field: "field of view", value: field_of_view as f32 });
        }
        let rays = sectors.saturating_mul(per_sector);
        if rays > MAX_RAYS {
            return Err(ChannelError::Groups { field: "rays", count: rays, size: per_sector });
        }
        let rays = (0..rays).map(|ray| Beam::in_view([0.0; 2], field_of_view, ray, rays)).collect();
        Self::new(body, rays, per_sector, bands, range)
    }
}

/// More rays than this are not needed, and a mistake could run out of memory.
#[cfg(feature = "alloc")]
const MAX_RAYS: usize = 1 << 20;

/// By how much 2 pi in single precision is beyond 2 pi, and a little more [rad].
#[cfg(feature = "alloc")]
const ROUNDED: f64 = 1e-6;

impl<R: AsRef<[Beam]>, C: AsRef<[ColorBand]>, B> Channels for LinearCamera<R, C, B> {
    fn channels(&self) -> usize {
        self.rays.as_ref().len() / self.per_sector * self.bands.as_ref().len()
    }
}

impl<R: AsRef<[Beam]>, C: AsRef<[ColorBand]>, B: Copy + PartialEq> LinearCamera<R, C, B> {
    /// Reads the channels for a given pose of the body and writes them to `out`.
    pub fn read_from<W: Sight<Body = B> + ?Sized>(&self, world: &W, pose: &Pose, out: &mut [f32]) {
        let (stance, bands) = (Stance::from_pose(pose), self.bands.as_ref());
        let (body, wedge, range) = (self.body, &self.wedge, self.range);
        let shows =
            |near: &NearbySurface<B>| near.body != Some(body) && bands.iter().any(|band| band.shows(near.color));
        let shown = Shown::from_world(world, &stance, wedge, range, shows);
        for (values, sector) in out.chunks_mut(bands.len()).zip(self.rays.as_ref().chunks_exact(self.per_sector)) {
            values.fill(0.0);
            for ray in sector.iter().filter(|ray| shown.may_meet(ray)) {
                let (from, direction) = (stance.place(ray.from), stance.turn(ray.direction));
                if let Some(sight) = world.cast_planar(from, direction, range, Some(body)) {
                    for (o, band) in values.iter_mut().zip(bands) {
                        *o += if band.shows(sight.color) { 1.0 } else { 0.0 };
                    }
                }
            }
            for o in values {
                *o /= self.per_sector as f32;
            }
        }
    }
}

impl<R, C, B, W> Sensor<W> for LinearCamera<R, C, B>
where
    R: AsRef<[Beam]>,
    C: AsRef<[ColorBand]>,
    B: Copy + PartialEq,
    W: Sight<Body = B> + Kinematics + ?Sized,
{
    fn read(&mut self, world: &W, out: &mut [f32]) {
        self.read_from(world, &world.pose(self.body), out);
    }
}

/// The part of the plane that the rays of a camera cross, in the robot's frame. It contains all within an angle to both
/// sides of straight ahead, and a little more.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Wedge {
    /// Cosine and sine of the angle. Both are 0 for an angle beyond 90 degrees, because its wedge has no edge.
    edge: [f32; 2],
    /// Largest distance of a ray's start from the robot's origin [m].
    aside: f32,
}

impl Wedge {
    fn around(rays: &[Beam]) -> Self {
        let least = rays.iter().map(|ray| ray.direction[0]).fold(1.0, f32::min);
        let widest = rays.iter().map(|ray| ray.direction[1].abs()).fold(0.0, f32::max);
        let edge = if least > 0.0 { [least, widest] } else { [0.0; 2] };
        Self { edge, aside: rays.iter().map(|ray| ray.from[0].abs() + ray.from[1].abs()).fold(0.0, f32::max) }
    }

    /// Returns whether something round may reach into it. Sometimes also if it does not.
    #[inline]
    fn may_hold(&self, Round { centre: [x, y], room }: &Round) -> bool {
        let [cosine, sine] = self.edge;
        // Beyond the near edge by more than the radius. All rays are on the other side of the edge's line.
        let outside = y.abs() * cosine - x * sine > room + self.aside;
        !outside
    }
}

/// Surfaces with colors of the camera's bands. Only a ray that may hit one of them can change the reading.
struct Shown {
    rounds: [Round; MAX_SHOWN],
    count: usize,
    /// True if a wall has such a color, or if there are more bodies than room. Every ray may then hit something.
    anywhere: bool,
}

/// A round body, in the robot's frame.
#[derive(Clone, Copy)]
struct Round {
    centre: [f32; 2],
    /// Its radius and a little more, for rounding [m].
    room: f32,
}

/// As many bodies as there usually are. With more it does not pay to try each before every ray.
const MAX_SHOWN: usize = 16;

impl Shown {
    #[inline]
    fn from_world<W: Sight + ?Sized>(
        world: &W,
        stance: &Stance,
        wedge: &Wedge,
        range: f32,
        shows: impl Fn(&NearbySurface<W::Body>) -> bool,
    ) -> Self {
        let nothing = Round { centre: [0.0; 2], room: 0.0 };
        let mut shown = Self { rounds: [nothing; MAX_SHOWN], count: 0, anywhere: false };
        world.query_near(stance.at, wedge.aside + range, &mut |near| {
            if shown.anywhere || !shows(&near) {
                return;
            }
            // The middle is a radius behind the nearest point, and undefined from close by.
            let round = near.body.is_some() && near.radius > 0.0;
            if !(round && near.distance > 0.5 * near.radius) {
                shown.anywhere = true;
                return;
            }
            let further = (near.distance + near.radius) / near.distance;
            let centre = stance.way_to(near.point).map(|x| x * further);
            let away = centre[0].abs() + centre[1].abs() + wedge.aside;
            let round = Round { centre, room: 1.01 * near.radius + 1e-3 * away };
            if !wedge.may_hold(&round) {
                return;
            }
            match shown.rounds.get_mut(shown.count) {
                Some(next) => {
                    *next = round;
                    shown.count += 1;
                }
                None => shown.anywhere = true,
            }
        });
        shown
    }

    /// Returns whether a ray of unit direction may hit such a surface. It may be true for a ray that does not.
    #[inline]
    fn may_meet(&self, ray: &Beam) -> bool {
        let (from, direction) = (ray.from, ray.direction);
        self.anywhere
            || self.rounds[..self.count].iter().any(|Round { centre, room }| {
                let [x, y] = [centre[0] - from[0], centre[1] - from[1]];
                let (along, across) = (x * direction[0] + y * direction[1], x * direction[1] - y * direction[0]);
                // NaN is never "no".
                !(along < -room || across.abs() > *room)
            })
    }
}
