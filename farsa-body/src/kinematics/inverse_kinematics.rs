//! Inverse kinematics. It computes joint positions for a given goal.

use alloc::vec::Vec;
use core::fmt;

use farsa_num::Scalar;

use crate::kinematics::goal::{Goal, Miss, Orientation};
use crate::kinematics::tree::{KinematicTree, dot};
use crate::pose::{Pose, norm};

/// Joint positions that were found by inverse kinematics, and the remaining errors.
#[derive(Clone, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct Solution {
    /// Joint positions (in radians or meters), in the order of [`KinematicTree::joints`].
    pub joints: Vec<f64>,
    /// Distance between the point and its desired position (in meters).
    pub position_error: f64,
    /// Angle between the actual and the desired orientation or direction (in radians).
    pub angle_error: f64,
}

/// The reason why no joint positions were found.
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
pub enum InverseKinematicsError {
    /// The robot does not have this body.
    Body {
        /// Index of the body.
        body: usize,
        /// Number of bodies of the robot.
        count: usize,
    },
    /// A value of the goal or of the start is not finite, a direction has zero length, or a quaternion is not
    /// normalized.
    Goal,
    /// The number of start positions differs from the number of joints.
    Start {
        /// Number of start positions.
        given: usize,
        /// Number of joints.
        joints: usize,
    },
    /// All attempts ended outside the tolerances. The goal may be out of reach.
    NotReached {
        /// Solution with the smallest error. You can use it if a rough pose is sufficient.
        closest: Solution,
    },
}

impl fmt::Display for InverseKinematicsError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Body { body, count } => write!(f, "body {body} of {count}"),
            Self::Goal => write!(f, "the goal is not made of finite numbers, directions and unit quaternions"),
            Self::Start { given, joints } => write!(f, "{given} start positions for {joints} joints"),
            Self::NotReached { closest } => {
                write!(f, "the goal was missed by {} m and {} rad", closest.position_error, closest.angle_error)
            }
        }
    }
}

impl core::error::Error for InverseKinematicsError {}

/// Inverse kinematics by damped least squares within the joint limits [Wampler1986]. If the first start does not lead
/// to a solution, it tries other starts that are spread evenly over the joint ranges.
///
/// Deviations: the damping is adapted as in the Levenberg-Marquardt method. A joint that would leave its range is held
/// at the end of the range for this step. Only joints between the body and the world are moved. Note that equal goals
/// and starts always lead to identical bits.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize), serde(default, deny_unknown_fields))]
pub struct InverseKinematics {
    /// Largest position error of a solution in meters. The default is 1e-6.
    pub position_tolerance: f64,
    /// Largest angle error of a solution (in radians). The default is 1e-6.
    pub angle_tolerance: f64,
    /// Distance that is equivalent to an angle error of one radian (in meters). The default is 0.1.
    pub angle_weight: f64,
    /// Fraction of each joint range that can be used, in [0, 1]. It is centered in the range. The default is 1.
    ///
    /// This is useful for muscles, because constant activations hold a joint only within 0.72 of its half range.
    pub range_fraction: f64,
    /// Maximum number of iterations in each attempt. The default is 100.
    pub iterations: usize,
    /// Maximum number of attempts, including the first one. The default is 50.
    pub attempts: usize,
}

impl Default for InverseKinematics {
    fn default() -> Self {
        Self {
            position_tolerance: 1e-6,
            angle_tolerance: 1e-6,
            angle_weight: 0.1,
            range_fraction: 1.0,
            iterations: 100,
            attempts: 50,
        }
    }
}

fn squared(v: &[f64; 6]) -> f64 {
    v.iter().fold(0.0, |sum, x| sum + x * x)
}

/// Solves a x = b by Cholesky's decomposition, or `None` if the symmetric `a` is not positive definite.
fn solve<const N: usize>(mut a: [[f64; N]; N], mut b: [f64; N]) -> Option<[f64; N]> {
    // a = L L^T in its own place, column by column. Then L y = b and L^T x = y.
    for j in 0..N {
        for k in 0..j {
            for i in j..N {
                a[i][j] -= a[i][k] * a[j][k];
            }
        }
        if a[j][j].is_nan() || a[j][j] <= 0.0 {
            return None;
        }
        let pivot = Scalar::sqrt(a[j][j]);
        for i in j..N {
            a[i][j] /= pivot;
        }
    }
    for i in 0..N {
        for k in 0..i {
            b[i] -= a[i][k] * b[k];
        }
        b[i] /= a[i][i];
    }
    for i in (0..N).rev() {
        for k in i + 1..N {
            b[i] -= a[k][i] * b[k];
        }
        b[i] /= a[i][i];
    }
    Some(b)
}

/// The square roots of the primes. Their multiples modulo 1 spread evenly over the unit cube [Richtmyer1951].
fn roots_of_primes() -> impl Iterator<Item = f64> {
    let prime = |n: &u32| (2..*n).all(|d| !n.is_multiple_of(d));
    (2u32..).filter(prime).map(|n| Scalar::sqrt(f64::from(n)))
}

/// Checks the question before the first attempt.
fn check(tree: &KinematicTree, goal: &Goal, start: &[f64]) -> Result<(), InverseKinematicsError> {
    if goal.body.index() >= tree.bodies() {
        return Err(InverseKinematicsError::Body { body: goal.body.index(), count: tree.bodies() });
    }
    if start.len() != tree.joints().len() {
        return Err(InverseKinematicsError::Start { given: start.len(), joints: tree.joints().len() });
    }
    let direction = |v: &[f64; 3]| norm(v).is_finite() && norm(v) > 0.0;
    let turned = match &goal.orientation {
        Orientation::Free => true,
        Orientation::Direction { own, wanted } => direction(own) && direction(wanted),
        Orientation::Full(rotation) => (norm(rotation) - 1.0).abs() <= 1e-6,
    };
    let finite = goal.point.iter().chain(&goal.position).chain(start).all(|x| x.is_finite());
    if turned && finite { Ok(()) } else { Err(InverseKinematicsError::Goal) }
}

impl InverseKinematics {
    /// Searches joint positions for `goal`. The search begins at `start`. It contains one value per joint of the
    /// tree (in radians or meters).
    ///
    /// The start is clamped to the joint limits. Since the first attempt moves continuously from there, the previous
    /// solution is a good start when you follow a path of goals. Joints that do not move the body keep their clamped
    /// start position.
    ///
    /// # Errors
    /// Returns an [`InverseKinematicsError`]. The variant `NotReached` contains the closest solution that was found.
    pub fn solve(&self, tree: &KinematicTree, goal: &Goal, start: &[f64]) -> Result<Solution, InverseKinematicsError> {
        check(tree, goal, start)?;
        let moving: Vec<usize> = tree.path(goal.body).map(|(_, c)| c).collect();
        let mut limits = tree.ranges().to_vec();
        for c in &moving {
            limits[*c] = self.limits(limits[*c]);
        }
        let mut poses = Vec::with_capacity(tree.bodies());
        let first: Vec<f64> = start.iter().zip(&limits).map(|(q, [low, high])| q.max(*low).min(*high)).collect();
        let mut closest: Option<(f64, Solution)> = None;
        for attempt in 0..self.attempts.max(1) {
            let mut q = first.clone();
            if attempt > 0 {
                for (c, root) in moving.iter().zip(roots_of_primes()) {
                    let [low, high] = limits[*c];
                    // Where there is no limit: half a turn (or pi meters) beyond zero or the other end.
                    let low_end = if low.is_finite() { low } else { high.min(0.0) - core::f64::consts::PI };
                    let high_end = if high.is_finite() { high } else { low.max(0.0) + core::f64::consts::PI };
                    // The fractional part of attempt * sqrt(prime), from one end of the range to the other.
                    let x = attempt as f64 * root;
                    q[*c] = low_end + (x - (x as u64) as f64) * (high_end - low_end);
                }
            }
            self.descend(tree, goal, &limits, &mut q, &mut poses);
            let miss = Miss::new(goal, &poses[goal.body.index()]);
            let cost = squared(&miss.weighted(self.angle_weight));
            let found = Solution { joints: q, position_error: norm(&miss.way), angle_error: norm(&miss.turn) };
            if found.position_error <= self.position_tolerance && found.angle_error <= self.angle_tolerance {
                return Ok(found);
            }
            if closest.as_ref().is_none_or(|(least, _)| cost < *least) {
                closest = Some((cost, found));
            }
        }
        let nothing = Solution { joints: first, position_error: f64::INFINITY, angle_error: f64::INFINITY };
        Err(InverseKinematicsError::NotReached { closest: closest.map_or(nothing, |(_, solution)| solution) })
    }

    fn limits(&self, [low, high]: [f64; 2]) -> [f64; 2] {
        let (middle, half) = (f64::midpoint(low, high), (high - low) / 2.0);
        if half.is_finite() && self.range_fraction < 1.0 {
            let half = half * f64::max(self.range_fraction, 0.0);
            [middle - half, middle + half]
        } else {
            [low, high]
        }
    }

    /// Moves `q` to the nearest minimum of the error. Leaves the segments' poses there in `poses`.
    fn descend(
        &self,
        tree: &KinematicTree,
        goal: &Goal,
        limits: &[[f64; 2]],
        q: &mut [f64],
        poses: &mut Vec<Pose<f64>>,
    ) {
        let body = goal.body.index();
        tree.poses_into(q, poses);
        let mut miss = Miss::new(goal, &poses[body]);
        let mut error = miss.weighted(self.angle_weight);
        let mut damping = 1e-3;
        let mut next = q.to_vec();
        for _ in 0..self.iterations {
            if norm(&miss.way) <= 0.01 * self.position_tolerance && norm(&miss.turn) <= 0.01 * self.angle_tolerance {
                break;
            }
            // J J' + damping, over the joints that the error does not press against a limit.
            let at = poses[body].transform(goal.point);
            let mut free = Vec::new();
            let mut a = [[0.0; 6]; 6];
            for (c, mut angular, linear) in tree.columns(poses, goal.body, at) {
                // A turn about the desired direction changes nothing.
                if let Some(idle) = miss.idle {
                    let along = dot(angular, idle);
                    angular = [0, 1, 2].map(|k| angular[k] - along * idle[k]);
                }
                if goal.orientation == Orientation::Free {
                    angular = [0.0; 3];
                }
                let ([r, s, t], [x, y, z]) = (angular.map(|w| w * self.angle_weight), linear);
                let column = [r, s, t, x, y, z];
                // J^T e of this joint: which way it would go. At an end of its range it is let go only back into it.
                let pull = (0..6).fold(0.0, |sum, k| sum + column[k] * error[k]);
                let [low, high] = limits[c];
                if (q[c] <= low && pull < 0.0) || (q[c] >= high && pull > 0.0) {
                    continue;
                }
                for i in 0..6 {
                    for j in 0..6 {
                        a[i][j] += column[i] * column[j];
                    }
                }
                free.push((c, column));
            }
            for i in 0..6 {
                a[i][i] += damping;
            }
            let Some(y) = solve(a, error) else { break };
            next.copy_from_slice(q);
            let mut largest = 0.0;
            for (c, column) in &free {
                // dq = J^T (J J^T + damping 1)^-1 e [Wampler1986].
                let step = (0..6).fold(0.0, |sum, k| sum + column[k] * y[k]);
                // A joint that turns by more than this has left the region where the Jacobian means anything.
                let [low, high] = limits[*c];
                next[*c] = (q[*c] + step.clamp(-0.5, 0.5)).max(low).min(high);
                largest = f64::max(largest, (next[*c] - q[*c]).abs());
            }
            tree.poses_into(&next, poses);
            let moved = Miss::new(goal, &poses[body]);
            let left = moved.weighted(self.angle_weight);
            // Levenberg-Marquardt: a step that helps is kept and the next is longer, else it is taken back and the next
            // is shorter.
            if squared(&left) < squared(&error) {
                q.copy_from_slice(&next);
                (miss, error) = (moved, left);
                damping = f64::max(damping * 0.2, 1e-14);
            } else {
                tree.poses_into(q, poses);
                damping *= 5.0;
            }
            if largest < 1e-13 {
                break;
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::kinematics::tree::sub;
    use crate::kinematics::tree::tests::{Q, tree};
    use crate::ports::BodyId;
    use crate::robot::description::{Robot, Segment};
    use crate::robot::joint::Joint;
    use crate::robot::mass_properties::MassProperties;
    use nalgebra::{SMatrix, SVector};

    /// Two links of 0.3 and 0.2 m that turn about z.
    fn planar(range: [f64; 2]) -> KinematicTree {
        planar_within([range; 2])
    }

    /// Builds the planar chain with a range for each joint.
    fn planar_within(ranges: [[f64; 2]; 2]) -> KinematicTree {
        let mut robot = Robot::new("planar");
        let body = MassProperties::sphere(1.0, 0.1);
        let mut parent = None;
        for (name, at, range) in [("shoulder", 0.0, ranges[0]), ("elbow", 0.3, ranges[1])] {
            let joint = Joint::revolute(name, [0.0, 0.0, 1.0], Pose::at([at, 0.0, 0.0]), range);
            parent = Some(robot.add_segment(Segment::new(name, parent, joint, body)));
        }
        KinematicTree::new(&robot).expect("a valid robot")
    }

    fn tip(position: [f64; 3]) -> Goal {
        Goal { body: BodyId(1), point: [0.2, 0.0, 0.0], position, orientation: Orientation::Free }
    }

    #[test]
    fn two_links_follow_the_law_of_cosines() {
        let tree = planar([-3.0, 3.0]);
        for (x, y) in [(0.3, 0.2), (-0.2, 0.35), (0.1, 0.1), (0.05, -0.4)] {
            let solution = InverseKinematics::default().solve(&tree, &tip([x, y, 0.0]), &[0.1, 0.1]).expect("in reach");
            let cos_elbow: f64 = (x * x + y * y - 0.3 * 0.3 - 0.2 * 0.2) / (2.0 * 0.3 * 0.2);
            let (_, cos) = farsa_num::sin_cos(solution.joints[1]);
            assert!((cos - cos_elbow).abs() < 1e-5, "elbow at {}", solution.joints[1]);
        }
    }

    #[test]
    fn out_of_reach_stretches_towards_the_goal() {
        let error = InverseKinematics::default().solve(&planar([-3.0, 3.0]), &tip([0.3, 0.4, 0.1]), &[0.1, 0.1]);
        let Err(InverseKinematicsError::NotReached { closest }) = error else { panic!("{error:?}") };
        // The reach is 0.5 m in the plane, the goal 0.5 m away and 0.1 m above it.
        assert!((closest.position_error - 0.1).abs() < 1e-4, "{closest:?}");
        let limited = InverseKinematics::default().solve(&planar([-0.2, 0.2]), &tip([0.0, 0.4, 0.0]), &[0.0, 0.0]);
        let Err(InverseKinematicsError::NotReached { closest }) = limited else { panic!("{limited:?}") };
        assert_eq!(closest.joints, [0.2, 0.2]);
        let half = InverseKinematics { range_fraction: 0.5, ..InverseKinematics::default() };
        let Err(InverseKinematicsError::NotReached { closest }) =
            half.solve(&planar([-0.2, 0.2]), &tip([0.0, 0.4, 0.0]), &[0.0, 0.0])
        else {
            panic!("in reach")
        };
        assert_eq!(closest.joints, [0.1, 0.1]);
    }

    /// With one start, and with fewer steps than it takes where the damping does not fall.
    fn at_the_first_attempt(tree: &KinematicTree, goals: &[[f64; 2]]) {
        let solver = InverseKinematics { attempts: 1, iterations: 25, ..InverseKinematics::default() };
        for [x, y] in goals {
            let solution =
                solver.solve(tree, &tip([*x, *y, 0.0]), &[0.1, 0.1]).unwrap_or_else(|e| panic!("{x} {y}: {e}"));
            let [shoulder, both] =
                [solution.joints[0], solution.joints[0] + solution.joints[1]].map(farsa_num::sin_cos);
            let at = [0.3 * shoulder.1 + 0.2 * both.1, 0.3 * shoulder.0 + 0.2 * both.0];
            assert!((at[0] - x).abs() < 1e-6 && (at[1] - y).abs() < 1e-6, "{at:?} for {x} {y}");
        }
    }

    #[test]
    fn goals_behind_a_stretched_arm_are_reached() {
        // Full steps of Gauss and Newton miss them: long ones are shortened, and those that do not help are taken back.
        at_the_first_attempt(&planar([-3.0, 3.0]), &[[-0.3, 0.3], [-0.25, 0.4], [-0.2, 0.25], [-0.2, 0.35]]);
    }

    #[test]
    fn a_joint_at_its_limit_leaves_the_way_to_the_others() {
        let tree = planar_within([[-0.5, 0.5], [-3.0, 3.0]]);
        at_the_first_attempt(&tree, &[[0.15, -0.3], [0.2, -0.25], [0.25, -0.25], [0.3, -0.2]]);
    }

    #[test]
    fn metres_are_weighed_against_radians() {
        // For a link of length l and a desired angle a, l^2 (2 - 2 cos q) + (w (a - q))^2 is least.
        let (length, wanted, tree) = (0.2, 1.0, planar([-3.0, 3.0]));
        let (sine, cosine) = farsa_num::sin_cos(wanted / 2.0);
        let orientation = Orientation::Full([0.0, 0.0, sine, cosine]);
        let goal = Goal { body: BodyId(0), point: [length, 0.0, 0.0], position: [length, 0.0, 0.0], orientation };
        let usual = InverseKinematics { attempts: 1, ..InverseKinematics::default() };
        for (weight, solver) in [(0.1, usual), (0.4, InverseKinematics { angle_weight: 0.4, ..usual })] {
            let error = solver.solve(&tree, &goal, &[0.0; 2]);
            let Err(InverseKinematicsError::NotReached { closest }) = error else { panic!("{error:?}") };
            let q = closest.joints[0];
            let slope = length * length * farsa_num::sin_cos(q).0 - weight * weight * (wanted - q);
            assert!(slope.abs() < 1e-9, "{weight}: {slope} at {q}");
        }
    }

    #[test]
    fn wrong_questions() {
        let (tree, solver) = (planar([-3.0, 3.0]), InverseKinematics::default());
        let goal = tip([0.3, 0.2, 0.0]);
        let missing = Goal { body: BodyId(2), ..goal };
        assert_eq!(solver.solve(&tree, &missing, &[0.0; 2]), Err(InverseKinematicsError::Body { body: 2, count: 2 }));
        assert_eq!(solver.solve(&tree, &goal, &[0.0]), Err(InverseKinematicsError::Start { given: 1, joints: 2 }));
        let direction = Orientation::Direction { own: [0.0; 3], wanted: [0.0, 0.0, 1.0] };
        for wrong in [
            Goal { position: [f64::NAN, 0.0, 0.0], ..goal },
            Goal { orientation: direction, ..goal },
            Goal { orientation: Orientation::Full([0.0, 0.0, 0.0, 2.0]), ..goal },
        ] {
            assert_eq!(solver.solve(&tree, &wrong, &[0.0; 2]), Err(InverseKinematicsError::Goal));
        }
    }

    #[test]
    fn poses_that_exist_are_found() {
        let robot = tree();
        let tree = KinematicTree::new(&robot).expect("a valid tree");
        let (body, point) = (BodyId(7), [0.02, 0.03, -0.04]);
        let solver = InverseKinematics::default();
        for k in 0..20 {
            let x = f64::from(k) * 0.37;
            let wanted: Vec<f64> = tree
                .ranges()
                .iter()
                .zip(Q)
                .map(|([low, high], q)| low + (high - low) * (0.5 + 0.4 * farsa_num::sin_cos(x + 7.0 * q).0))
                .collect();
            let pose = tree.poses(&wanted)[7];
            let own = [0.3, -0.5, 1.1];
            for orientation in [
                Orientation::Free,
                Orientation::Direction { own, wanted: pose.rotate(own).map(|x| 3.0 * x) },
                Orientation::Full(pose.rotation.map(|x| -x)),
            ] {
                let goal = Goal { body, point, position: pose.transform(point), orientation };
                let solution =
                    solver.solve(&tree, &goal, &tree.zero()).unwrap_or_else(|e| panic!("{k} {orientation:?}: {e}"));
                // Judged by the poses alone.
                let reached = tree.poses(&solution.joints)[7];
                assert!(norm(&sub(reached.transform(point), goal.position)) < 1e-6);
                match orientation {
                    Orientation::Free => {}
                    Orientation::Direction { own, .. } => {
                        assert!(norm(&sub(reached.rotate(own), pose.rotate(own))) < 2e-6);
                    }
                    Orientation::Full(_) => {
                        for axis in [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0]] {
                            assert!(norm(&sub(reached.rotate(axis), pose.rotate(axis))) < 2e-6);
                        }
                    }
                }
                for (q, [low, high]) in solution.joints.iter().zip(tree.ranges()) {
                    assert!(low <= q && q <= high, "{q} outside [{low}, {high}]");
                }
                // The segment's path is 0, 1, 2, 5, 6, 7: joint 4 had nothing to do with it.
                assert_eq!(solution.joints[3], tree.zero()[3]);
                assert_eq!(solver.solve(&tree, &goal, &tree.zero()).as_ref(), Ok(&solution), "the same bits again");
            }
        }
    }

    #[test]
    fn cholesky_solves_as_nalgebra_does() {
        let root =
            SMatrix::<f64, 6, 6>::from_fn(|i, j| ((i * 7 + j * 3) % 11) as f64 - 4.0 + if i == j { 9.0 } else { 0.0 });
        let a = root * root.transpose();
        let b = SVector::<f64, 6>::from_fn(|i, _| i as f64 - 2.5);
        let expected = a.cholesky().expect("positive definite").solve(&b);
        let rows: [[f64; 6]; 6] = core::array::from_fn(|i| core::array::from_fn(|j| a[(i, j)]));
        let got = solve(rows, b.into()).expect("positive definite");
        assert!(got.iter().zip(expected.iter()).all(|(x, y)| (x - y).abs() < 1e-12));
        assert_eq!(solve([[1.0, 2.0], [2.0, 1.0]], [0.0, 0.0]), None);
    }
}
