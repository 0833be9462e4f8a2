//! Goals for inverse kinematics. They specify the position and the orientation of a body.

use farsa_num::atan2;

use crate::kinematics::tree::{dot, sub};
use crate::ports::BodyId;
use crate::pose::{Pose, cross, norm};

/// The desired orientation of a body.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize), serde(rename_all = "kebab-case"))]
pub enum Orientation {
    /// The orientation is not constrained.
    Free,
    /// A direction of the body must point in a given direction, and rotations about it are not constrained. Both
    /// vectors may have any length greater than zero.
    Direction {
        /// Direction in the frame of the body.
        own: [f64; 3],
        /// Desired direction in the world.
        wanted: [f64; 3],
    },
    /// The orientation is given by a unit quaternion [x, y, z, w] that maps the axes of the body to those of the world.
    Full([f64; 4]),
}

/// The desired position of a point of a body, and the desired orientation of this body.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct Goal {
    /// Body to be moved.
    pub body: BodyId,
    /// Point in the frame of the body (in meters).
    pub point: [f64; 3],
    /// Desired position of the point in the world (in meters).
    pub position: [f64; 3],
    /// Desired orientation of the body.
    pub orientation: Orientation,
}

/// The remaining error at some joint positions.
pub(crate) struct Miss {
    /// Turn [rad, rotation vector] and way [m] to the goal.
    pub(crate) turn: [f64; 3],
    pub(crate) way: [f64; 3],
    /// Direction about which turning does not matter.
    pub(crate) idle: Option<[f64; 3]>,
}

impl Miss {
    pub(crate) fn new(goal: &Goal, pose: &Pose<f64>) -> Self {
        let way = sub(goal.position, pose.transform(goal.point));
        let (turn, idle) = match goal.orientation {
            Orientation::Free => ([0.0; 3], None),
            Orientation::Direction { own, wanted } => {
                let (a, b) = (unit(pose.rotate(own)), unit(wanted));
                (turn_between(a, b), Some(a))
            }
            Orientation::Full(wanted) => {
                let [x, y, z, w] = pose.rotation;
                let back = Pose { position: [0.0; 3], rotation: [-x, -y, -z, w] };
                let [x, y, z, w] = Pose { position: [0.0; 3], rotation: wanted }.compose(&back).rotation;
                // The shorter of the two ways round.
                let v = if w < 0.0 { [-x, -y, -z] } else { [x, y, z] };
                let s = norm(&v);
                let angle = 2.0 * atan2(s, w.abs());
                (if s > 0.0 { v.map(|x| x * (angle / s)) } else { v }, None)
            }
        };
        Self { turn, way, idle }
    }

    /// The error vector of the least squares, angular part first.
    pub(crate) fn weighted(&self, angle_weight: f64) -> [f64; 6] {
        let ([a, b, c], [x, y, z]) = (self.turn.map(|t| t * angle_weight), self.way);
        [a, b, c, x, y, z]
    }
}

fn unit(v: [f64; 3]) -> [f64; 3] {
    let length = norm(&v);
    v.map(|x| x / length)
}

/// The rotation vector that turns the unit vector `a` into `b` on the shortest way. About any perpendicular if they are
/// opposite.
fn turn_between(a: [f64; 3], b: [f64; 3]) -> [f64; 3] {
    let c = cross(a, b);
    let (s, angle) = (norm(&c), atan2(norm(&c), dot(a, b)));
    if s > 1e-9 {
        c.map(|x| x * (angle / s))
    } else if angle < 1.0 {
        c
    } else {
        let aside = if a[0].abs() < 0.6 { [1.0, 0.0, 0.0] } else { [0.0, 1.0, 0.0] };
        unit(cross(a, aside)).map(|x| x * angle)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn opposite_directions_are_turned_round() {
        for a in [[1.0, 0.0, 0.0], [0.0, 0.6, -0.8], [0.0, 0.0, 1.0]] {
            let turn = turn_between(a, a.map(|x: f64| -x));
            assert!((norm(&turn) - core::f64::consts::PI).abs() < 1e-12 && dot(turn, a).abs() < 1e-12);
            assert_eq!(norm(&turn_between(a, a)), 0.0);
        }
    }
}
