//! Joints that are permanently locked. Worlds treat the connected segments as one body.

use farsa_num::sin_cos;

use crate::pose::{Pose, norm};
use crate::robot::joint::{Joint, JointKind};

impl Joint {
    /// Returns a fixed joint that replaces this joint at the given position (in radians or meters). It has no name, no
    /// armature, damping, spring, friction or largest speed.
    ///
    /// Fixed and floating joints do not have a position. They are fixed at their placement.
    #[must_use]
    pub fn locked(&self, position: f64) -> Self {
        let scaled = |by: f64| {
            let length = norm(&self.axis);
            self.axis.map(|a| a * (by / length))
        };
        let moved = match self.kind {
            JointKind::Revolute => {
                let (sine, cosine) = sin_cos(position / 2.0);
                let [x, y, z] = scaled(sine);
                Pose { position: [0.0; 3], rotation: [x, y, z, cosine] }
            }
            JointKind::Prismatic => Pose::at(scaled(position)),
            JointKind::Fixed | JointKind::Floating => Pose::identity(),
        };
        Self::fixed(self.placement.compose(&moved))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::kinematics::KinematicTree;
    use crate::ports::BodyId;
    use crate::robot::description::{Robot, Segment};
    use crate::robot::mass_properties::MassProperties;

    /// Two segments, the second one's joint about or along a slanted axis that is not of unit length.
    fn robot(joint: Joint) -> Robot {
        let mut robot = Robot::new("pair");
        let ball = MassProperties::sphere(1.0, 0.1);
        let first = Joint::revolute("first", [0.0, 0.0, 1.0], Pose::identity(), [-1.0, 1.0]);
        let base = robot.add_segment(Segment::new("base", None, first, ball));
        robot.add_segment(Segment::new("tip", Some(base), joint, ball));
        robot
    }

    #[test]
    fn what_is_locked_is_where_the_joint_had_it() {
        let placement = Pose { position: [0.1, 0.2, 0.3], rotation: [0.5, -0.5, 0.5, 0.5] };
        for joint in [
            Joint::revolute("joint", [1.0, 2.0, -2.0], placement, [-2.0, 2.0]),
            Joint::prismatic("joint", [1.0, 2.0, -2.0], placement, [-2.0, 2.0]),
        ] {
            let moving = KinematicTree::new(&robot(joint.clone())).expect("a valid robot");
            let locked = KinematicTree::new(&robot(joint.locked(0.7))).expect("a valid robot");
            let tip = BodyId(1).index();
            let [a, b] = [moving.poses(&[0.4, 0.7])[tip], locked.poses(&[0.4])[tip]];
            for point in [[0.0; 3], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0]] {
                let apart = (0..3).map(|k| (a.transform(point)[k] - b.transform(point)[k]).abs());
                assert!(apart.fold(0.0, f64::max) < 1e-12, "{:?}", joint.kind);
            }
        }
        let fixed = Joint::fixed(placement);
        assert_eq!(fixed.locked(3.0), fixed);
    }
}
