//! Forward kinematics, Jacobians and gravity torques of a robot.

use alloc::vec;
use alloc::vec::Vec;

use farsa_num::sin_cos;

use crate::ports::{BodyId, JointId};
use crate::pose::{Pose, cross, norm};
use crate::robot::description::Robot;
use crate::robot::joint::JointKind;
use crate::robot::mass_properties::MassProperties;
use crate::robot::validation::RobotError;

/// One segment with what its joint needs, the axis normalized.
#[derive(Clone, Debug, PartialEq)]
struct Link {
    parent: Option<usize>,
    kind: JointKind,
    axis: [f64; 3],
    placement: Pose<f64>,
    coordinate: Option<usize>,
    body: MassProperties,
}

/// The kinematics of a robot in double precision.
///
/// Joint positions are passed as slices in the order of [`KinematicTree::joints`]. These are all joints that turn or
/// slide. Floating segments remain at the placement of their joint. A world provides the same information about its
/// current state. Use this type for states that are not simulated.
#[derive(Clone, Debug, PartialEq)]
pub struct KinematicTree {
    links: Vec<Link>,
    joints: Vec<JointId>,
    ranges: Vec<[f64; 2]>,
}

pub(crate) fn dot(a: [f64; 3], b: [f64; 3]) -> f64 {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}

pub(crate) fn sub(a: [f64; 3], b: [f64; 3]) -> [f64; 3] {
    [a[0] - b[0], a[1] - b[1], a[2] - b[2]]
}

impl Link {
    /// The motion of the joint at position `q`, as a pose in the joint's frame.
    fn motion(&self, q: f64) -> Pose<f64> {
        match self.kind {
            JointKind::Revolute => {
                let (s, c) = sin_cos(q / 2.0);
                let [x, y, z] = self.axis.map(|a| a * s);
                Pose { rotation: [x, y, z, c], ..Pose::identity() }
            }
            JointKind::Prismatic => Pose::at(self.axis.map(|a| a * q)),
            JointKind::Fixed | JointKind::Floating => Pose::identity(),
        }
    }
}

impl KinematicTree {
    /// Creates the kinematic tree of a robot.
    ///
    /// # Errors
    /// Returns the errors of [`Robot::validate`].
    pub fn new(robot: &Robot) -> Result<Self, RobotError> {
        robot.validate()?;
        let joints: Vec<JointId> = robot.joints().collect();
        let mut coordinate = 0..;
        let links = robot.segments.iter().map(|segment| {
            let joint = &segment.joint;
            let single = joint.kind.is_single();
            let length = norm(&joint.axis);
            Link {
                parent: segment.parent.map(BodyId::index),
                kind: joint.kind,
                axis: if single { joint.axis.map(|x| x / length) } else { [0.0; 3] },
                placement: joint.placement,
                coordinate: if single { coordinate.next() } else { None },
                body: segment.mass_properties(),
            }
        });
        let links = links.collect();
        let ranges = joints.iter().map(|joint| robot.segments[joint.index()].joint.range).collect();
        Ok(Self { links, joints, ranges })
    }

    /// Gets the joints that turn or slide, in the order of the joint positions.
    pub fn joints(&self) -> &[JointId] {
        &self.joints
    }

    /// Gets the ranges of these joints (in radians or meters).
    pub fn ranges(&self) -> &[[f64; 2]] {
        &self.ranges
    }

    /// Returns the index of a joint in the slices of joint positions, or `None` if the joint does not turn or slide.
    pub fn coordinate(&self, joint: JointId) -> Option<usize> {
        self.links.get(joint.index())?.coordinate
    }

    /// Gets the number of segments.
    pub fn bodies(&self) -> usize {
        self.links.len()
    }

    /// Returns the joint positions (in radians or meters) that are as close to 0 as the limits permit.
    pub fn zero(&self) -> Vec<f64> {
        self.ranges.iter().map(|[low, high]| low.max(0.0).min(*high)).collect()
    }

    /// Computes the poses of all segments in the world at the joint positions `q` (in radians or meters).
    ///
    /// If `q` is too short, the missing positions are 0.
    pub fn poses(&self, q: &[f64]) -> Vec<Pose<f64>> {
        let mut poses = Vec::with_capacity(self.links.len());
        self.poses_into(q, &mut poses);
        poses
    }

    /// Computes the same poses as [`KinematicTree::poses`], but replaces the contents of an existing vector.
    pub fn poses_into(&self, q: &[f64], poses: &mut Vec<Pose<f64>>) {
        debug_assert!(q.len() >= self.joints.len(), "{} joint positions for {} joints", q.len(), self.joints.len());
        poses.clear();
        for link in &self.links {
            let joint = match link.parent {
                Some(parent) => poses[parent].compose(&link.placement),
                None => link.placement,
            };
            let q = link.coordinate.and_then(|i| q.get(i)).copied().unwrap_or(0.0);
            poses.push(joint.compose(&link.motion(q)));
        }
    }

    /// The segments from `body` to the world whose joints turn or slide, with the place of their joint position.
    pub(crate) fn path(&self, body: BodyId) -> impl Iterator<Item = (usize, usize)> + '_ {
        let mut next = (body.index() < self.links.len()).then_some(body.index());
        let segments = core::iter::from_fn(move || {
            let current = next?;
            next = self.links[current].parent;
            Some(current)
        });
        segments.filter_map(|i| self.links[i].coordinate.map(|coordinate| (i, coordinate)))
    }

    /// The columns of the Jacobian that are not zero, each with its coordinate, as angular and linear part.
    pub(crate) fn columns<'a>(
        &'a self,
        poses: &'a [Pose<f64>],
        body: BodyId,
        at: [f64; 3],
    ) -> impl Iterator<Item = (usize, [f64; 3], [f64; 3])> + 'a {
        self.path(body).map(move |(i, coordinate)| {
            let axis = poses[i].rotate(self.links[i].axis);
            match self.links[i].kind {
                JointKind::Revolute => (coordinate, axis, cross(axis, sub(at, poses[i].position))),
                _ => (coordinate, [0.0; 3], axis),
            }
        })
    }

    /// Computes the Jacobian of a `point` in the frame of `body` (in meters), given the `poses` of all segments. Each
    /// column belongs to a joint. It contains the angular velocity of the body (in rad/s) and the velocity of the point
    /// (in m/s) in the world at unit joint speed.
    ///
    /// # Panics
    /// Panics if there are fewer poses than segments, or if the body does not exist.
    pub fn jacobian(&self, poses: &[Pose<f64>], body: BodyId, point: [f64; 3]) -> Vec<[f64; 6]> {
        let at = poses[body.index()].transform(point);
        let mut jacobian = vec![[0.0; 6]; self.joints.len()];
        for (coordinate, [a, b, c], [x, y, z]) in self.columns(poses, body, at) {
            jacobian[coordinate] = [a, b, c, x, y, z];
        }
        jacobian
    }

    /// Computes the joint torques (in N m) or forces (in newtons) that hold the robot at rest. The vector `gravity` is
    /// given in the axes of the world (in m/s2).
    ///
    /// # Panics
    /// Panics if there are fewer poses than segments.
    pub fn gravity_torques(&self, poses: &[Pose<f64>], gravity: [f64; 3]) -> Vec<f64> {
        // Mass and first moment of everything that a joint carries, summed from the leaves.
        let mut carried: Vec<(f64, [f64; 3])> = self
            .links
            .iter()
            .zip(poses)
            .map(|(link, pose)| {
                let body = &link.body;
                (body.mass, pose.transform(body.centre).map(|x| x * body.mass))
            })
            .collect();
        let mut torques = vec![0.0; self.joints.len()];
        for i in (0..self.links.len()).rev() {
            let link = &self.links[i];
            let (mass, moment) = carried[i];
            if let Some(parent) = link.parent {
                carried[parent].0 += mass;
                for k in 0..3 {
                    carried[parent].1[k] += moment[k];
                }
            }
            if let Some(coordinate) = link.coordinate {
                let axis = poses[i].rotate(link.axis);
                torques[coordinate] = if link.kind == JointKind::Revolute {
                    let origin = poses[i].position;
                    let arm = [0, 1, 2].map(|k| moment[k] - mass * origin[k]);
                    -dot(axis, cross(arm, gravity))
                } else {
                    -mass * dot(axis, gravity)
                };
            }
        }
        torques
    }
}

#[cfg(test)]
pub(crate) mod tests {
    use super::*;
    use crate::robot::description::Segment;
    use crate::robot::joint::Joint;
    use alloc::format;
    use nalgebra::{Isometry3, Quaternion, Translation3, Unit, UnitQuaternion, Vector3};

    /// A tree of nine segments: a fixed, a floating and two sliding ones among the turning, turned frames, a fork.
    pub(crate) fn tree() -> Robot {
        let mut robot = Robot::new("tree");
        let unit = |q: [f64; 4]| q.map(|x| x / norm(&q));
        for i in 0..9u16 {
            let x = f64::from(i);
            let placement = Pose {
                position: [0.1 - 0.01 * x, 0.03 * x - 0.1, 0.05 + 0.01 * x],
                rotation: unit([0.2 * x - 0.7, 0.5 - 0.1 * x, 0.3, 0.9]),
            };
            let axis = [0.3 * x - 1.0, 0.7, 0.4 * x - 1.5];
            let name = format!("joint{i}");
            let (parent, joint) = match i {
                0 => (None, Joint::revolute(&name, axis, placement, [-3.0, 3.0])),
                2 | 6 => (Some(i - 1), Joint::prismatic(&name, axis, placement, [-0.3, 0.3])),
                3 => (Some(i - 1), Joint::fixed(placement)),
                5 => (Some(2), Joint::revolute(&name, axis, placement, [-2.0, -0.5])),
                8 => (None, Joint::floating(placement)),
                _ => (Some(i - 1), Joint::revolute(&name, axis, placement, [-2.0, 2.0])),
            };
            let body =
                MassProperties::cuboid(0.5 + 0.1 * x, [0.03, 0.02, 0.04]).placed(&Pose::at([0.02, -0.01 * x, 0.03]));
            robot.add_segment(Segment::new(&format!("segment{i}"), parent.map(BodyId), joint, body));
        }
        robot
    }

    pub(crate) const Q: [f64; 7] = [0.4, -1.1, 0.12, 0.8, -0.6, -0.2, 1.9];

    #[test]
    fn poses_are_products_of_isometries() {
        let robot = tree();
        let tree = KinematicTree::new(&robot).expect("a valid tree");
        let joints: Vec<usize> = tree.joints().iter().map(|j| j.index()).collect();
        assert_eq!(joints, [0, 1, 2, 4, 5, 6, 7]);
        assert_eq!(tree.coordinate(JointId(4)), Some(3));
        assert_eq!(tree.coordinate(JointId(3)), None);
        assert_eq!(tree.zero(), [0.0, 0.0, 0.0, 0.0, -0.5, 0.0, 0.0]);
        let poses = tree.poses(&Q);
        let mut frames: Vec<Isometry3<f64>> = Vec::new();
        for (i, segment) in robot.segments.iter().enumerate() {
            let [x, y, z] = segment.joint.placement.position;
            let [a, b, c, w] = segment.joint.placement.rotation;
            let turn = UnitQuaternion::from_quaternion(Quaternion::new(w, a, b, c));
            let placed = Isometry3::from_parts(Translation3::new(x, y, z), turn);
            let axis = Unit::new_normalize(Vector3::from(segment.joint.axis));
            let q = tree.coordinate(JointId(i as u16)).map_or(0.0, |c| Q[c]);
            let moved = match segment.joint.kind {
                JointKind::Revolute => {
                    Isometry3::from_parts(Translation3::identity(), UnitQuaternion::from_axis_angle(&axis, q))
                }
                JointKind::Prismatic => Isometry3::translation(axis.x * q, axis.y * q, axis.z * q),
                _ => Isometry3::identity(),
            };
            let parent = segment.parent.map_or(Isometry3::identity(), |p| frames[p.index()]);
            frames.push(parent * placed * moved);
            let point = [0.3, -0.2, 0.1];
            let expected = frames[i] * nalgebra::Point3::from(point);
            let got = poses[i].transform(point);
            assert!((0..3).all(|k| (got[k] - expected[k]).abs() < 1e-14), "segment {i}: {got:?} {expected}");
        }
    }

    #[test]
    fn jacobian_is_the_derivative() {
        let tree = KinematicTree::new(&tree()).expect("a valid tree");
        let point = [0.1, -0.05, 0.2];
        for body in [2, 4, 7, 8].map(BodyId) {
            let jacobian = tree.jacobian(&tree.poses(&Q), body, point);
            let h = 1e-6;
            for c in 0..Q.len() {
                let moved = |by: f64| {
                    let mut q = Q;
                    q[c] += by;
                    tree.poses(&q)[body.index()]
                };
                let (plus, minus) = (moved(h), moved(-h));
                let linear = sub(plus.transform(point), minus.transform(point)).map(|x| x / (2.0 * h));
                // Twice the vector part of the turn from minus to plus.
                let [x, y, z, w] = minus.rotation;
                let back = Pose { position: [0.0; 3], rotation: [-x, -y, -z, w] };
                let turn = plus.compose(&back).rotation;
                let angular = [0, 1, 2].map(|k| turn[k] * 2.0 * turn[3] / (2.0 * h));
                for k in 0..3 {
                    assert!((jacobian[c][k] - angular[k]).abs() < 1e-9, "body {body:?}, joint {c}, angular {k}");
                    assert!((jacobian[c][k + 3] - linear[k]).abs() < 1e-9, "body {body:?}, joint {c}, linear {k}");
                }
            }
        }
    }

    #[test]
    fn gravity_torques_are_the_slope_of_the_energy() {
        let tree = KinematicTree::new(&tree()).expect("a valid tree");
        let gravity = [0.5, -1.0, -9.81];
        let energy = |q: &[f64]| -> f64 {
            let poses = tree.poses(q);
            tree.links.iter().zip(&poses).map(|(l, p)| -l.body.mass * dot(gravity, p.transform(l.body.centre))).sum()
        };
        let torques = tree.gravity_torques(&tree.poses(&Q), gravity);
        for c in 0..Q.len() {
            let (mut plus, mut minus) = (Q, Q);
            plus[c] += 1e-5;
            minus[c] -= 1e-5;
            let slope = (energy(&plus) - energy(&minus)) / 2e-5;
            assert!((torques[c] - slope).abs() < 1e-7, "joint {c}: {} instead of {slope}", torques[c]);
        }
    }
}
