//! Inverse weights of segments, to which MuJoCo's contact parameters are relative.

use farsa_body::Pose;
use farsa_body::kinematics::KinematicTree;
use farsa_body::ports::BodyId;
use farsa_body::robot::{JointKind, Robot, RobotError, Segment};
use farsa_num::Scalar;

use crate::vector::{cross, dot, sub};

/// Angular and linear part of a motion, or torque and force, at a center of mass in the world's axes.
type Spatial = ([f64; 3], [f64; 3]);

/// A symmetric map from motions to forces or back.
type Matrix = [Spatial; 6];

/// One degree of freedom of a segment with all that hangs on it.
struct Freedom {
    /// Motion at unit speed.
    axis: Spatial,
    /// Force that accelerates the segment so, while what hangs on it is free.
    force: Spatial,
    /// Effort that this takes. With the armature.
    effort: f64,
}

/// Inverse weights of a robot.
pub(crate) struct InverseWeights {
    /// Weights of segments [1/kg].
    pub(crate) bodies: Vec<f64>,
    /// Weights of the joints that turn or slide [1/(kg m2) or 1/kg], and 0 for others.
    pub(crate) joints: Vec<f64>,
}

/// Returns for every segment the acceleration of its center of mass per force on it [1/kg], as the mean over the three
/// directions. All joints are at 0, armatures are included, and nothing else acts. It is 0 for a segment that cannot
/// move.
///
/// MuJoCo's `body_invweight0`, first component. Joints have the acceleration per effort on them, its `dof_invweight0`.
/// Time and memory are proportional to the number of segments. Articulated-body inertias pass from the ends of the
/// trees to their roots ([Featherstone2008] section 7.3). Responses to a force on each segment alone pass back. MuJoCo
/// factorizes the mass matrix instead (section 6.5), which takes time cubic in a chain's length.
///
/// # Errors
/// The errors of [`Robot::validate`].
pub(crate) fn inverse_weights(robot: &Robot) -> Result<InverseWeights, RobotError> {
    let tree = KinematicTree::new(robot)?;
    let poses = tree.poses(&vec![0.0; tree.joints().len()]);
    let centres: Vec<_> = robot.segments.iter().zip(&poses).map(|(s, pose)| pose.transform(s.centre)).collect();
    let step = |i: usize, parent: BodyId| sub(centres[i], centres[parent.index()]);

    let mut inertias: Vec<Matrix> = robot.segments.iter().zip(&poses).map(|(s, pose)| own_inertia(s, pose)).collect();
    let mut freedoms: Vec<Vec<Freedom>> = Vec::with_capacity(robot.segments.len());
    for (i, segment) in robot.segments.iter().enumerate().rev() {
        let mut inertia = inertias[i];
        // Only what turns or slides has an armature.
        let armature = if segment.joint.kind.is_single() { segment.joint.armature } else { 0.0 };
        // A floating joint is six, one after the other: each carries what the ones before it leave.
        let free = axes(segment, &poses[i], centres[i]).into_iter().map(|axis| {
            let force = applied(&inertia, axis);
            let effort = product(axis, force) + armature;
            add_square(&mut inertia, force, -1.0 / effort);
            Freedom { axis, force, effort }
        });
        freedoms.push(free.collect());
        if let Some(parent) = segment.parent {
            let r = step(i, parent);
            let moved = mapped(&inertia, |(torque, force)| (add(torque, cross(r, force)), force));
            for (to, from) in inertias[parent.index()].iter_mut().zip(moved) {
                *to = (add(to.0, from.0), add(to.1, from.1));
            }
        }
    }
    freedoms.reverse();

    let mut yields: Vec<Matrix> = Vec::with_capacity(robot.segments.len());
    let mut joints = vec![0.0; robot.segments.len()];
    for (i, segment) in robot.segments.iter().enumerate() {
        let carried = segment.parent.map(|parent| {
            let r = step(i, parent);
            mapped(&yields[parent.index()], |(turn, slide)| (turn, add(slide, cross(turn, r))))
        });
        let mut matrix = carried.unwrap_or_default();
        if let [Freedom { force, effort, .. }] = &freedoms[i][..] {
            // An effort on the joint accelerates what hangs on it, and by its reaction what carries it.
            joints[i] = (1.0 / effort + product(*force, applied(&matrix, *force)) / (effort * effort)).max(0.0);
        }
        for Freedom { axis, force, effort } in freedoms[i].iter().rev() {
            matrix = mapped(&matrix, |motion| {
                let by = -product(motion, *force) / effort;
                (add(motion.0, axis.0.map(|x| x * by)), add(motion.1, axis.1.map(|x| x * by)))
            });
            add_square(&mut matrix, *axis, 1.0 / effort);
        }
        yields.push(matrix);
    }
    // A segment below the smallest number has no weight either, because `max` drops NaN.
    let mean = |matrix: &Matrix| ((matrix[3].1[0] + matrix[4].1[1] + matrix[5].1[2]) / 3.0).max(0.0);
    Ok(InverseWeights { bodies: yields.iter().map(mean).collect(), joints })
}

/// The inertia of a segment about its center of mass.
fn own_inertia(segment: &Segment, pose: &Pose<f64>) -> Matrix {
    let [xx, yy, zz, xy, xz, yz] = segment.inertia;
    let mut inertia = Matrix::default();
    for k in 0..3 {
        let mut unit = [0.0; 3];
        unit[k] = 1.0;
        let [x, y, z] = pose.rotate_back(unit);
        let spin = [xx * x + xy * y + xz * z, xy * x + yy * y + yz * z, xz * x + yz * y + zz * z];
        inertia[k].0 = pose.rotate(spin);
        inertia[3 + k].1[k] = segment.mass;
    }
    inertia
}

/// Returns the effect of a joint's degrees of freedom on the segment's center of mass.
fn axes(segment: &Segment, pose: &Pose<f64>, centre: [f64; 3]) -> Vec<Spatial> {
    let joint = &segment.joint;
    let length = Scalar::sqrt(dot(joint.axis, joint.axis));
    let axis = pose.rotate(joint.axis.map(|x| x / length));
    match joint.kind {
        JointKind::Revolute => vec![(axis, cross(axis, sub(centre, pose.position)))],
        JointKind::Prismatic => vec![([0.0; 3], axis)],
        JointKind::Fixed => Vec::new(),
        // Any six directions will do, as it can move in all.
        JointKind::Floating => UNITS.to_vec(),
    }
}

/// Turns about and slides along the world's axes.
const UNITS: Matrix = [
    ([1.0, 0.0, 0.0], [0.0; 3]),
    ([0.0, 1.0, 0.0], [0.0; 3]),
    ([0.0, 0.0, 1.0], [0.0; 3]),
    ([0.0; 3], [1.0, 0.0, 0.0]),
    ([0.0; 3], [0.0, 1.0, 0.0]),
    ([0.0; 3], [0.0, 0.0, 1.0]),
];

fn add(a: [f64; 3], b: [f64; 3]) -> [f64; 3] {
    [a[0] + b[0], a[1] + b[1], a[2] + b[2]]
}

fn product(a: Spatial, b: Spatial) -> f64 {
    dot(a.0, b.0) + dot(a.1, b.1)
}

fn applied(matrix: &Matrix, to: Spatial) -> Spatial {
    let [a, b, c, d, e, f] = matrix.map(|row| product(row, to));
    ([a, b, c], [d, e, f])
}

/// The matrix F M F' of a linear map F.
fn mapped(matrix: &Matrix, map: impl Fn(Spatial) -> Spatial) -> Matrix {
    // The rows mapped are M F'. As M is symmetric, its columns mapped in turn are F M F'.
    let rows = matrix.map(&map);
    let column = |k: usize| if k < 3 { rows.map(|row| row.0[k]) } else { rows.map(|row| row.1[k - 3]) };
    [0, 1, 2, 3, 4, 5].map(|k| {
        let [a, b, c, d, e, f] = column(k);
        map(([a, b, c], [d, e, f]))
    })
}

/// Adds `by` v v' to a matrix.
fn add_square(matrix: &mut Matrix, v: Spatial, by: f64) {
    let components = [v.0[0], v.0[1], v.0[2], v.1[0], v.1[1], v.1[2]];
    for (row, x) in matrix.iter_mut().zip(components) {
        let x = x * by;
        *row = (add(row.0, v.0.map(|y| x * y)), add(row.1, v.1.map(|y| x * y)));
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::vector::norm;
    use farsa_body::robot::{Joint, MassProperties};
    use proptest::prelude::*;

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
        let weights = inverse_weights(&robot).expect("a valid robot").bodies;
        // Free: 1/m. Fixed: 0. Sliding: one direction of three. Turning: r2 / I in one direction of three.
        let about = 0.4 * 2.0 * 0.01 + 2.0 * 0.25;
        for (weights, expected) in weights.iter().zip([0.5, 0.0, 1.0 / 9.0, 0.25 / about / 3.0]) {
            assert!((weights - expected).abs() < 1e-14, "{weights} instead of {expected}");
        }
    }

    /// The degrees of freedom that move a segment, each by its number, with what it does to a point.
    fn columns(
        robot: &Robot,
        poses: &[Pose<f64>],
        first: &[usize],
        mut i: usize,
        at: [f64; 3],
    ) -> Vec<(usize, Spatial)> {
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
                    let units = UNITS.map(|(turn, slide)| (turn, add(slide, cross(turn, arm))));
                    columns.extend(units.into_iter().enumerate().map(|(k, unit)| (first[i] + k, unit)));
                }
            }
            match robot.segments[i].parent {
                Some(parent) => i = parent.index(),
                None => return columns,
            }
        }
    }

    /// Computes the definition: tr(J M^-1 J') / 3 with J of the center of mass, and M = L L' the full mass matrix.
    fn dense(robot: &Robot) -> Vec<f64> {
        let tree = KinematicTree::new(robot).expect("a valid robot");
        let poses = tree.poses(&vec![0.0; tree.joints().len()]);
        let mut n = 0;
        let first = robot.segments.iter().map(|segment| {
            let own = n;
            n += match segment.joint.kind {
                JointKind::Revolute | JointKind::Prismatic => 1,
                JointKind::Floating => 6,
                JointKind::Fixed => 0,
            };
            own
        });
        let first: Vec<usize> = first.collect();
        let centres: Vec<_> = robot.segments.iter().zip(&poses).map(|(s, pose)| pose.transform(s.centre)).collect();
        let columns: Vec<_> = (0..first.len()).map(|i| columns(robot, &poses, &first, i, centres[i])).collect();
        let mut matrix = vec![0.0; n * n];
        for (i, segment) in robot.segments.iter().enumerate() {
            if segment.joint.kind.is_single() {
                matrix[first[i] * (n + 1)] += segment.joint.armature;
            }
            let inertia = own_inertia(segment, &poses[i]);
            for (a, motion) in &columns[i] {
                for (b, other) in &columns[i] {
                    matrix[a * n + b] += product(*other, applied(&inertia, *motion));
                }
            }
        }
        for j in 0..n {
            for i in j..n {
                let sum: f64 = (0..j).map(|k| matrix[i * n + k] * matrix[j * n + k]).sum();
                let rest = matrix[i * n + j] - sum;
                matrix[i * n + j] = if i == j { Scalar::sqrt(rest) } else { rest / matrix[j * n + j] };
            }
        }
        // Each term of the trace is the square of L^-1 j.
        let weight = |columns: &Vec<(usize, Spatial)>| {
            let mut sum = 0.0;
            for k in 0..3 {
                let mut row = vec![0.0; n];
                for (a, motion) in columns {
                    row[*a] = motion.1[k];
                }
                for i in 0..n {
                    let known: f64 = (0..i).map(|k| matrix[i * n + k] * row[k]).sum();
                    row[i] = (row[i] - known) / matrix[i * n + i];
                    sum += row[i] * row[i];
                }
            }
            sum / 3.0
        };
        columns.iter().map(weight).collect()
    }

    /// A segment: which of those before it carries it, how, with which armature, from where, and what body it is.
    type Draw = (prop::sample::Index, u8, f64, [f64; 3], [f64; 4], ([f64; 3], f64));

    fn draws(most: usize) -> impl Strategy<Value = Vec<Draw>> {
        let three = || prop::array::uniform3(-1.0..1.0_f64);
        let armature = prop_oneof![Just(0.0), 0.001..1.0_f64];
        let turn = prop::array::uniform4(-1.0..1.0_f64).prop_filter("a direction", |q| norm(q) > 0.1);
        let one = (any::<prop::sample::Index>(), any::<u8>(), armature, three(), turn, (three(), 0.1..10.0_f64));
        prop::collection::vec(one, 1..most)
    }

    /// Builds a robot of such segments. `on` returns the parent for the draw and the segment's number.
    fn drawn(draws: &[Draw], on: impl Fn(&prop::sample::Index, usize) -> Option<usize>) -> Robot {
        let mut robot = Robot::new("drawn");
        for (i, (parent, kind, armature, at, turn, (centre, mass))) in draws.iter().enumerate() {
            let placement = Pose { position: *at, rotation: turn.map(|x| x / norm(turn)) };
            let (name, axis) = (format!("j{i}"), [at[1], 1.5, at[0]]);
            let parent = on(parent, i).map(|parent| BodyId(parent as u16));
            let joint = match (kind % 8, parent) {
                (0, None) | (7, _) => Joint::fixed(placement),
                (1..4, None) => Joint::floating(placement),
                (4, _) => Joint::prismatic(&name, axis, placement, [-1.0, 1.0]),
                _ => Joint::revolute(&name, axis, placement, [-1.0, 1.0]),
            };
            let half = centre.map(|x| 0.2 + 0.1 * x);
            let body = MassProperties::cuboid(*mass, half).placed(&Pose { position: *centre, ..placement });
            robot.add_segment(Segment::new(&format!("s{i}"), parent, joint.with_armature(*armature), body));
        }
        robot
    }

    /// Computes the largest difference from the definition, relative to the weight itself.
    fn difference(robot: &Robot) -> f64 {
        let weights = inverse_weights(robot).expect("a valid robot").bodies;
        let pairs = weights.iter().zip(dense(robot));
        pairs.map(|(a, b)| if *a == b { 0.0 } else { (a - b).abs() / b.abs().max(1e-300) }).fold(0.0, f64::max)
    }

    proptest! {
        #[test]
        fn trees_forests_and_chains_are_by_definition(draws in draws(40), shape in 0..3) {
            let robot = drawn(&draws, |draw, i| match shape {
                // One place more than there are segments: the world.
                0 => Some(draw.index(i + 1)).filter(|parent| *parent < i),
                1 => i.checked_sub(1 + draw.index(3)),
                _ => i.checked_sub(1),
            });
            prop_assert!(difference(&robot) < 1e-10, "{:e}", difference(&robot));
        }
    }

    /// Against the definition in decimal numbers of 40 digits. In doubles it is off by 6e-8 here, as the mass matrix of
    /// a long chain is nearly singular.
    #[test]
    fn a_long_chain_loses_no_digits() {
        let mut robot = Robot::new("chain");
        for i in 0..300_u16 {
            let joint = Joint::revolute(&format!("j{i}"), [0.0, 1.0, 0.2], Pose::at([0.0, 0.05, 0.2]), [-1.0, 1.0]);
            let body = MassProperties::cuboid(1.0, [0.05, 0.04, 0.1]).placed(&Pose::at([0.0, 0.0, 0.1]));
            robot.add_segment(Segment::new(&format!("s{i}"), i.checked_sub(1).map(BodyId), joint, body));
        }
        let weights = inverse_weights(&robot).expect("a valid robot").bodies;
        let exact = [0.1299419849484253, 0.1961330474749258, 0.19851258709911557, 0.27848049008710474];
        for (i, exact) in [0, 1, 150, 299].into_iter().zip(exact) {
            assert!((weights[i] / exact - 1.0).abs() < 1e-14, "{} instead of {exact}", weights[i]);
        }
    }

    /// A square matrix of all degrees of freedom would be 1.2 TB here.
    #[test]
    fn many_segments_take_no_more_than_their_number() {
        let mut robot = Robot::new("many");
        let ball = MassProperties::sphere(2.0, 0.1);
        for i in 0..65_535_u16 {
            let (parent, joint) = match i.checked_sub(1) {
                Some(parent) if i > 60_000 => {
                    let hinge = Joint::revolute(&format!("j{i}"), [0.0, 1.0, 0.0], Pose::at([0.1; 3]), [-1.0, 1.0]);
                    (Some(BodyId(parent)), hinge)
                }
                _ => (None, Joint::floating(Pose::at([f64::from(i), 0.0, 0.0]))),
            };
            robot.add_segment(Segment::new(&format!("s{i}"), parent, joint, ball));
        }
        let weights = inverse_weights(&robot).expect("a valid robot").bodies;
        assert!(weights[..60_000].iter().all(|weight| *weight == 0.5));
        assert!(
            weights[60_000..].iter().all(|weight| *weight > 0.0 && *weight < 0.5),
            "what carries or hangs is heavier"
        );
    }

    #[test]
    fn what_numbers_cannot_say_is_no_weight() {
        let mut robot = Robot::new("extremes");
        for (i, scale) in [1e-100, 1e-10, 1e10, 1e100].into_iter().enumerate() {
            let inertia = [scale, scale, scale, 0.0, 0.0, 0.0];
            let mass = scale * scale * scale;
            let body = MassProperties { mass, centre: [1e150, 0.0, 0.0], inertia };
            let hinge = Joint::revolute(&format!("j{i}"), [0.0, 1.0, 0.0], Pose::at([1e200; 3]), [-1.0, 1.0]);
            robot.add_segment(Segment::new(&format!("s{i}"), i.checked_sub(1).map(|i| BodyId(i as u16)), hinge, body));
        }
        let weights = inverse_weights(&robot).expect("a valid robot").bodies;
        assert!(weights.iter().all(|weight| *weight >= 0.0), "{weights:?}");
    }
}
