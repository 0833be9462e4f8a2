//! The position and heading of a mobile robot in the plane.

use farsa_num::Scalar;

use crate::ports::{Kinematics, NearbySurface};
use crate::pose::Pose;

/// The pose of a robot in the plane. A tilted one is seen from above.
#[derive(Clone, Copy)]
pub(crate) struct Stance {
    /// Where its origin is [m].
    pub(crate) at: [f32; 2],
    /// Unit vector of its x axis.
    pub(crate) ahead: [f32; 2],
}

impl Stance {
    #[inline]
    pub(crate) fn from_world<W: Kinematics + ?Sized>(world: &W, body: W::Body) -> Self {
        Self::from_pose(&world.pose(body))
    }

    #[inline]
    pub(crate) fn from_pose(pose: &Pose) -> Self {
        let [x, y, _] = pose.rotate([1.0, 0.0, 0.0]);
        let length = Scalar::sqrt(x * x + y * y);
        // A robot whose x axis is vertical has no heading, and gets the world's x axis.
        let ahead = if length > 0.0 { [x / length, y / length] } else { [1.0, 0.0] };
        Self { at: [pose.position[0], pose.position[1]], ahead }
    }

    /// A vector of the robot's frame in the world's axes.
    #[inline]
    pub(crate) fn turn(&self, [x, y]: [f32; 2]) -> [f32; 2] {
        let [c, s] = self.ahead;
        [c * x - s * y, s * x + c * y]
    }

    /// A point of the robot's frame [m] in the world [m].
    #[inline]
    pub(crate) fn place(&self, point: [f32; 2]) -> [f32; 2] {
        let [x, y] = self.turn(point);
        [self.at[0] + x, self.at[1] + y]
    }

    /// The way from the robot's origin to a point of the world [m], in the robot's frame.
    #[inline]
    pub(crate) fn way_to(&self, [x, y]: [f32; 2]) -> [f32; 2] {
        let ([c, s], dx, dy) = (self.ahead, x - self.at[0], y - self.at[1]);
        [c * dx + s * dy, c * dy - s * dx]
    }

    /// The unit vector towards the nearest point of a surface, in the robot's frame.
    ///
    /// Within a round body that is the way out of it turned round, so that it points to the body's center all the same.
    /// Straight ahead where the point is the origin itself.
    #[inline]
    pub(crate) fn bearing<B>(&self, near: &NearbySurface<B>) -> [f32; 2] {
        let [x, y] = self.way_to(near.point);
        let length = Scalar::sqrt(x * x + y * y);
        let length = if near.distance < 0.0 { -length } else { length };
        if length == 0.0 { [1.0, 0.0] } else { [x / length, y / length] }
    }
}
