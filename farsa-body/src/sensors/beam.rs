//! Rays that start at the hull of a robot and extend in the plane of its sensors.

use farsa_num::{Scalar, sin_cos};

use crate::channel::{ChannelError, direction, finite};
use crate::ports::{Kinematics, Rays};

/// A ray attached to the hull of a robot. Coordinates are relative to the robot.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct Beam {
    /// Point at which the ray leaves the hull (in meters).
    pub from: [f32; 2],
    /// Direction of the ray as a unit vector.
    pub direction: [f32; 2],
}

impl Beam {
    /// Returns one of several rays that sample a cone. The cone starts at a round hull with the given radius (in
    /// meters), in the direction `angle` (in radians), counter-clockwise from straight ahead.
    ///
    /// All rays of a cone start at the same point. The first ray is `aperture` (in radians) to the right of `angle` and
    /// the last one `aperture` to the left, and the others are evenly distributed between them. A single ray is in the
    /// middle. This function does not need an allocator:
    ///
    /// ```
    /// use farsa_body::sensors::Beam;
    ///
    /// let degree = core::f64::consts::PI / 180.0;
    /// let angles = [30.0 * degree, -30.0 * degree];
    /// let beams: [Beam; 6] = core::array::from_fn(|i| Beam::in_cone(0.035, angles[i / 3], 10.0 * degree, i % 3, 3));
    /// assert_eq!(beams[1].from, beams[2].from);
    /// ```
    pub fn in_cone(radius: f64, angle: f64, aperture: f64, ray: usize, rays: usize) -> Self {
        let last = rays.max(1) - 1;
        // Mirror images have opposite shares, to the bit.
        let share = if last == 0 { 0.0 } else { (2.0 * ray as f64 - last as f64) / last as f64 };
        let (out, along) = (sin_cos(angle), sin_cos(angle + share * aperture));
        Self { from: [(radius * out.1) as f32, (radius * out.0) as f32], direction: [along.1 as f32, along.0 as f32] }
    }

    /// Returns one of several rays that cover a field of view (in radians) around straight ahead, ordered from left to
    /// right. They start at the position `from` in the frame of the robot (in meters).
    ///
    /// The field of view is divided into equal parts, and each ray is in the middle of a part. Therefore the rays are
    /// evenly distributed even if the field of view is a full circle.
    pub fn in_view(from: [f64; 2], field_of_view: f64, ray: usize, rays: usize) -> Self {
        let share = (rays as f64 - 1.0 - 2.0 * ray as f64) / (2.0 * rays.max(1) as f64);
        let (s, c) = sin_cos(share * field_of_view);
        Self { from: from.map(|x| x as f32), direction: [c as f32, s as f32] }
    }

    /// Checks that it has a place and a direction.
    pub(crate) fn check(&self) -> Result<(), ChannelError> {
        for x in self.from {
            finite("place of a beam", x)?;
        }
        direction("length of a beam's direction", self.direction)
    }
}

/// The depth within the hull at which a ray starts [m], so that a robot that touches a wall detects it. It is also the
/// distance outside at which a ray starts where the world shows the hull from within.
const WITHIN: f32 = 1e-3;

/// The plane of a robot's beams in a world.
pub(crate) struct BeamFrame<B> {
    body: B,
    origin: [f32; 3],
    ahead: [f32; 3],
    left: [f32; 3],
}

impl<B: Copy + PartialEq> BeamFrame<B> {
    /// The plane at `height` [m] above the robot's origin.
    #[inline]
    pub(crate) fn from_world<W: Kinematics<Body = B> + ?Sized>(world: &W, body: B, height: f32) -> Self {
        let pose = world.pose(body);
        Self {
            body,
            origin: pose.transform([0.0, 0.0, height]),
            ahead: pose.rotate([1.0, 0.0, 0.0]),
            left: pose.rotate([0.0, 1.0, 0.0]),
        }
    }

    /// Returns the distance from the hull to the first surface on a beam [m], at least 0, or `None` without a surface
    /// within `range` [m]. `asked` receives the beam's start and end [m] and may report that nothing is between them.
    #[inline]
    pub(crate) fn distance<W: Rays<Body = B> + ?Sized>(
        &self,
        world: &W,
        beam: &Beam,
        range: f32,
        mut asked: impl FnMut([f32; 3], [f32; 3]) -> bool,
    ) -> Option<f32> {
        let turn = |[x, y]: [f32; 2]| [0, 1, 2].map(|i| self.ahead[i] * x + self.left[i] * y);
        let (from, along) = (turn(beam.from), turn(beam.direction));
        let at = |out: f32| [0, 1, 2].map(|i| self.origin[i] + from[i] + out * along[i]);
        if !asked(at(-WITHIN), at(range)) {
            return None;
        }
        let hit = world.cast(at(-WITHIN), along, range + WITHIN)?;
        if hit.body == Some(self.body) {
            world.cast(at(WITHIN), along, range - WITHIN).map(|hit| hit.distance + WITHIN)
        } else {
            Some(Scalar::max(hit.distance - WITHIN, 0.0))
        }
    }
}
