//! How easily a force moves each segment: what another simulator's contact parameters are relative to.

use farsa_body::{JointKind, KinematicTree, Pose, Robot, RobotError};
use farsa_num::Scalar;

use crate::vector::{cross, dot, sub};

/// Angular and linear velocity at unit speed of one degree of freedom.
type Column = ([f64; 3], [f64; 3]);

/// For every segment the acceleration of its centre of mass per force on it [1/kg], mean over the three directions, with
/// all joints at 0, armatures included and nothing else acting; 0 for a segment that cannot move.
///
/// MuJoCo's `body_invweight0`, first component.
///
/// # Errors
/// What [`Robot::validate`] finds.
pub(crate) fn inverse_weights(robot: &Robot) -> Result<Vec<f64>, RobotError> {
    let tree = KinematicTree::new(robot)?;
    let poses = tree.poses(&vec![0.0; tree.joints().len()]);
    let first = first_of(robot);
    let n = first.last().copied().unwrap_or(0);
    let centres: Vec<_> = robot.segments.iter().zip(&poses).map(|(s, pose)| pose.transform(s.centre)).collect();
    let columns: Vec<Vec<(usize, Column)>> =
        (0..robot.segments.len()).map(|i| columns_of(robot, &poses, &first, i, centres[i])).collect();
    // The mass matrix at rest: M = sum over segments of J^T diag(I, m) J, with J the columns at the centre of mass, and the
    // armatures on the diagonal.
    let mut matrix = vec![0.0; n * n];
    for (i, segment) in robot.segments.iter().enumerate() {
        if segment.joint.kind.is_single() {
            matrix[first[i] * (n + 1)] += segment.joint.armature;
        }
        let [xx, yy, zz, xy, xz, yz] = segment.inertia;
        for (a, (turn, slide)) in &columns[i] {
            let [x, y, z] = poses[i].rotate_back(*turn);
            let spin = [xx * x + xy * y + xz * z, xy * x + yy * y + yz * z, xz * x + yz * y + zz * z];
            let spin = poses[i].rotate(spin);
            for (b, (other_turn, other_slide)) in &columns[i] {
                matrix[a * n + b] += dot(*other_turn, spin) + segment.mass * dot(*other_slide, *slide);
            }
        }
    }
    // The weight is tr(J M^-1 J^T) / 3 over the three directions of J's linear part. With M = L L^T each term is the
    // square of L^-1 j, so one forward substitution a direction is enough.
    factorise(&mut matrix, n);
    let mut row = vec![0.0; n];
    let weights = columns.iter().map(|columns| {
        let mut sum = 0.0;
        for k in 0..3 {
            row.fill(0.0);
            for (a, (_, slide)) in columns {
                row[*a] = slide[k];
            }
            sum += half_solved(&matrix, &mut row);
        }
        sum / 3.0
    });
    Ok(weights.collect())
}

/// The first degree of freedom of every segment, and their number behind.
fn first_of(robot: &Robot) -> Vec<usize> {
    let mut first = vec![0];
    let mut n = 0;
    for segment in &robot.segments {
        n += match segment.joint.kind {
            JointKind::Revolute | JointKind::Prismatic => 1,
            JointKind::Floating => 6,
            JointKind::Fixed => 0,
        };
        first.push(n);
    }
    first
}

/// What each degree of freedom that moves segment `i` does to a point of it.
fn columns_of(robot: &Robot, poses: &[Pose<f64>], first: &[usize], mut i: usize, at: [f64; 3]) -> Vec<(usize, Column)> {
    let mut columns = Vec::new();
    loop {
        let joint = &robot.segments[i].joint;
        let arm = sub(at, poses[i].position);
        let length = Scalar::sqrt(dot(joint.axis, joint.axis));
        let axis = poses[i].rotate(joint.axis.map(|x| x / length));
        match joint.kind {
            JointKind::Revolute => columns.push((first[i], (axis, cross(axis, arm)))),
            JointKind::Prismatic => columns.push((first[i], ([0.0; 3], axis))),
            JointKind::Fixed => {}
            JointKind::Floating => {
                for k in 0..3 {
                    let mut unit = [0.0; 3];
                    unit[k] = 1.0;
                    columns.push((first[i] + k, (unit, cross(unit, arm))));
                    columns.push((first[i] + 3 + k, ([0.0; 3], unit)));
                }
            }
        }
        match robot.segments[i].parent {
            Some(parent) => i = parent.index(),
            None => return columns,
        }
    }
}

/// Cholesky's factor L in the lower triangle of a positive definite matrix.
fn factorise(matrix: &mut [f64], n: usize) {
    for j in 0..n {
        for i in j..n {
            let sum: f64 = (0..j).map(|k| matrix[i * n + k] * matrix[j * n + k]).sum();
            let rest = matrix[i * n + j] - sum;
            matrix[i * n + j] = if i == j { Scalar::sqrt(rest) } else { rest / matrix[j * n + j] };
        }
    }
}

/// The square of L^-1 `row`, which is left there.
fn half_solved(factor: &[f64], row: &mut [f64]) -> f64 {
    let n = row.len();
    let mut square = 0.0;
    for i in 0..n {
        let sum: f64 = (0..i).map(|k| factor[i * n + k] * row[k]).sum();
        row[i] = (row[i] - sum) / factor[i * n + i];
        square += row[i] * row[i];
    }
    square
}

#[cfg(test)]
mod tests {
    use super::*;
    use farsa_body::{BodyId, Joint, MassProperties, Segment};

    #[test]
    fn closed_forms() {
        let mut robot = Robot::new("three");
        let ball = MassProperties::sphere(2.0, 0.1);
        robot.add_segment(Segment::new("ball", None, Joint::floating(Pose::at([1.0, 2.0, 3.0])), ball));
        robot.add_segment(Segment::new("post", None, Joint::fixed(Pose::identity()), ball));
        let slide = Joint::prismatic("slide", [0.0, 3.0, 4.0], Pose::identity(), [-1.0, 1.0]).with_armature(1.0);
        robot.add_segment(Segment::new("cart", Some(BodyId(1)), slide, ball));
        let hinge = Joint::revolute("hinge", [0.0, 0.0, 1.0], Pose::identity(), [-1.0, 1.0]);
        robot.add_segment(Segment::new("rod", None, hinge, ball.placed(&Pose::at([0.5, 0.0, 0.0]))));
        let found = inverse_weights(&robot).expect("a valid robot");
        // Free: 1/m. Fixed: 0. Sliding: one direction of three. Turning: r2 / I in one direction of three.
        let about = 0.4 * 2.0 * 0.01 + 2.0 * 0.25;
        for (found, expected) in found.iter().zip([0.5, 0.0, 1.0 / 9.0, 0.25 / about / 3.0]) {
            assert!((found - expected).abs() < 1e-14, "{found} instead of {expected}");
        }
    }
}
