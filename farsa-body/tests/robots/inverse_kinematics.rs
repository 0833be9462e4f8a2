//! Where inverse kinematics begins, and which of several attempts it keeps.

use std::f64::consts::PI;

use crate::shared::apart;
use farsa_body::Pose;
use farsa_body::kinematics::{Goal, InverseKinematics, InverseKinematicsError, KinematicTree, Orientation};
use farsa_body::ports::BodyId;
use farsa_body::robot::{Joint, MassProperties, Robot, Segment};
use proptest::prelude::*;

/// Sliding joints along x, y and z within these ranges: the joint positions are the place of the body.
fn slides(ranges: &[[f64; 2]]) -> (KinematicTree, BodyId) {
    let (mut robot, mut parent) = (Robot::new("slides"), None);
    for (i, (range, name)) in ranges.iter().zip(["x", "y", "z"]).enumerate() {
        let axis = [0, 1, 2].map(|k| if k == i { 1.0 } else { 0.0 });
        let joint = Joint::prismatic(name, axis, Pose::identity(), *range);
        parent = Some(robot.add_segment(Segment::new(name, parent, joint, MassProperties::sphere(1.0, 0.1))));
    }
    (KinematicTree::new(&robot).unwrap(), parent.unwrap())
}

fn goal(body: BodyId, position: [f64; 3]) -> Goal {
    Goal { body, point: [0.0; 3], position, orientation: Orientation::Free }
}

/// Returns the start that is nearest to a place, which is the answer without a step.
fn nearest_start(ranges: &[[f64; 2]], attempts: usize, first: &[f64], position: [f64; 3]) -> Vec<f64> {
    let (tree, body) = slides(ranges);
    let solver = InverseKinematics { attempts, iterations: 0, position_tolerance: 0.0, ..InverseKinematics::default() };
    match solver.solve(&tree, &goal(body, position), first) {
        Err(InverseKinematicsError::NotReached { closest }) => {
            let at = [0, 1, 2].map(|i| closest.joints.get(i).copied().unwrap_or(0.0));
            assert!((closest.position_error - apart(at, position)).abs() < 1e-12, "{closest:?}");
            closest.joints
        }
        Ok(found) => found.joints,
        Err(error) => panic!("{error}"),
    }
}

/// Starts reach from end to end of a range. Half a turn beyond zero or the other end where there is no limit.
#[test]
fn starts_are_spread_over_the_ranges() {
    const NONE: f64 = f64::INFINITY;
    for (range, ends) in [
        ([-1.0, 3.0], [-1.0, 3.0]),
        ([2.0, 2.5], [2.0, 2.5]),
        ([-NONE, NONE], [-PI, PI]),
        ([-NONE, 2.0], [-PI, 2.0]),
        ([-NONE, -2.0], [-2.0 - PI, -2.0]),
        ([-2.0, NONE], [-2.0, PI]),
        ([2.0, NONE], [2.0, 2.0 + PI]),
    ] {
        let [low, high] = ends;
        let first = [f64::midpoint(low, high)];
        for k in 0..=20 {
            let wanted = low + f64::from(k) / 20.0 * (high - low);
            let found = nearest_start(&[range], 200, &first, [wanted, 0.0, 0.0])[0];
            assert!((found - wanted).abs() < 0.015 * (high - low), "{range:?}: {found} for {wanted}");
        }
        // Nothing beyond.
        for (far, end) in [(low - 9.0, low), (high + 9.0, high)] {
            let found = nearest_start(&[range], 200, &first, [far, 0.0, 0.0])[0];
            assert!(low <= found && found <= high && (found - end).abs() < 0.015 * (high - low), "{range:?}: {found}");
        }
    }
}

/// Also of several joints at once: every corner of the box of ranges is looked into.
#[test]
fn starts_are_spread_over_all_joints_together() {
    let ranges = [[-1.0, 1.0], [0.0, 4.0], [-3.0, -1.0]];
    for corner in 0..8 {
        let share = [0, 1, 2].map(|i| if corner >> i & 1 == 1 { 0.9 } else { 0.1 });
        let wanted = [0, 1, 2].map(|i| ranges[i][0] + share[i] * (ranges[i][1] - ranges[i][0]));
        let found = nearest_start(&ranges, 300, &[0.0, 2.0, -2.0], wanted);
        for i in 0..3 {
            let off = (found[i] - wanted[i]).abs() / (ranges[i][1] - ranges[i][0]);
            assert!(off < 0.2, "{found:?} for {wanted:?}");
        }
    }
    // The first attempt is the start, brought into its range.
    assert_eq!(nearest_start(&ranges, 1, &[0.3, 9.0, -2.5], [5.0; 3]), [0.3, 4.0, -2.5]);
    assert_eq!(nearest_start(&ranges, 0, &[0.3, 9.0, -2.5], [5.0; 3]), [0.3, 4.0, -2.5]);
}

proptest! {
    /// The closest error decreases with the number of attempts, and is reported correctly.
    #[test]
    fn the_closest_of_all_attempts_is_kept(position in prop::array::uniform3(-2.0_f64..2.0), angle_weight in 0.05_f64..1.0) {
        let (mut robot, mut parent) = (Robot::new("arm"), None);
        for (name, axis) in [("a", [0.0, 0.0, 1.0]), ("b", [0.0, 1.0, 0.0]), ("c", [0.0, 0.0, 1.0])] {
            let joint = Joint::revolute(name, axis, Pose::at([0.3, 0.0, 0.0]), [-1.5, 1.5]);
            parent = Some(robot.add_segment(Segment::new(name, parent, joint, MassProperties::sphere(1.0, 0.1))));
        }
        let tree = KinematicTree::new(&robot).unwrap();
        let orientation = Orientation::Direction { own: [1.0, 0.0, 0.0], wanted: [0.0, 0.6, 0.8] };
        let goal = Goal { body: parent.unwrap(), point: [0.2, 0.0, 0.0], position, orientation };
        let mut before = f64::INFINITY;
        for attempts in 1..8 {
            let solver = InverseKinematics { attempts, iterations: 2, angle_weight, ..InverseKinematics::default() };
            let (Ok(closest) | Err(InverseKinematicsError::NotReached { closest })) = solver.solve(&tree, &goal, &[0.0; 3])
            else {
                panic!("a wrong question")
            };
            let pose = tree.poses(&closest.joints)[2];
            let (at, along) = (pose.transform([0.2, 0.0, 0.0]), pose.rotate([1.0, 0.0, 0.0]));
            let way = apart(at, position);
            let angle = (0.6 * along[1] + 0.8 * along[2]).clamp(-1.0, 1.0).acos();
            prop_assert!((closest.position_error - way).abs() < 1e-9 && (closest.angle_error - angle).abs() < 1e-6);
            let cost = way.hypot(angle_weight * angle);
            prop_assert!(cost <= before + 1e-9, "{} attempts: {} after {}", attempts, cost, before);
            before = cost;
        }
    }
}
