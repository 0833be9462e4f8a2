//! Start of a trial as a keyframe of a MuJoCo model.

use std::collections::BTreeMap;

use farsa_body::ports::BodyId;
use farsa_body::robot::{JointKind, Robot};
use farsa_body::{Pose, Recorder};
use farsa_models::mjcf::Keyframe;
use farsa_num::atan2;

use crate::experiment::episode::EpisodeId;
use crate::experiment::evaluator::{Evaluation, Evaluator};

/// Greatest distance of a body from its place in the recording [m, or parts of a unit quaternion].
const CLOSE: f64 = 1e-4;

/// Poses of the first tick, by the number of the body.
#[derive(Default)]
struct FirstTick {
    poses: BTreeMap<usize, Pose<f64>>,
    scalars: Vec<f64>,
    ended: bool,
}

impl Recorder for FirstTick {
    fn pose(&mut self, body: BodyId, pose: Pose) {
        if !self.ended {
            self.poses.insert(body.index(), pose.cast());
        }
    }

    fn scalars(&mut self, values: &[f64]) {
        if !self.ended {
            self.scalars = values.into();
        }
    }

    fn tick(&mut self, _: f64) {
        self.ended = true;
    }
}

/// Returns the start of the first trial of seed 0, or `None` if it does not fit the robot.
///
/// Without parameters the controller has those in the middle of their ranges.
pub(crate) fn start_of_trial(
    evaluator: &mut dyn Evaluator,
    robot: &Robot,
    parameters: Option<&[f32]>,
) -> Option<Keyframe> {
    let info = evaluator.info();
    let middle = || info.parameters.iter().map(|parameter| f64::midpoint(parameter.ends[0], parameter.ends[1]) as f32);
    let parameters: Vec<f32> = parameters.map_or_else(|| middle().collect(), <[f32]>::to_vec);
    let opponents = vec![parameters.as_slice(); info.populations.len().saturating_sub(1)];
    let mut first = FirstTick::default();
    let evaluation = Evaluation { opponents: &opponents, ..Evaluation::new(&parameters, EpisodeId::default()) };
    if !evaluator.record_start(evaluation, &mut first) {
        return None;
    }
    // A recording of several robots has no wheels, and an export has the first robot alone.
    let alone = || first.poses.iter().take(1).map(|(body, pose)| (*body, *pose)).collect();
    // Several joints of one body have a single recorded pose, but a column each.
    let columns = || info.schema.scalars.iter().zip(&first.scalars);
    let of_column = |i: usize| {
        let name = &robot.segments[i].joint.name;
        columns().find(|(column, _)| column.group == "joint" && column.name == *name).map(|(_, value)| *value)
    };
    let unknown = |_| None;
    let found = keyframe(robot, &first.poses, unknown).or_else(|| keyframe(robot, &alone(), unknown));
    found.or_else(|| keyframe(robot, &first.poses, of_column))
}

/// Computes the positions of joints that bring the bodies to their recorded poses.
///
/// Segments between the joints of one body are not recorded: a slider among them has the position that its nearest
/// recorded descendant requires, and a hinge is at 0, unless `known` has its position.
fn keyframe(
    robot: &Robot,
    recorded: &BTreeMap<usize, Pose<f64>>,
    known: impl Fn(usize) -> Option<f64>,
) -> Option<Keyframe> {
    let mut poses: Vec<Pose<f64>> = Vec::with_capacity(robot.segments.len());
    let mut positions = vec![0.0; robot.segments.len()];
    let mut bodies = Vec::new();
    for (i, segment) in robot.segments.iter().enumerate() {
        let joint = &segment.joint;
        let parent = segment.parent.map_or(Pose::identity(), |parent| poses[parent.index()]);
        let rest = parent.compose(&joint.placement);
        let pose = match joint.kind {
            JointKind::Fixed => rest,
            JointKind::Floating => {
                let pose = recorded.get(&i).copied().unwrap_or(rest);
                bodies.push((BodyId(u16::try_from(i).ok()?), pose));
                pose
            }
            JointKind::Prismatic => {
                let way = descendant(robot, recorded, i).map_or([0.0; 3], |at| rest.transform_back(at.position));
                positions[i] = known(i).unwrap_or_else(|| (0..3).map(|k| way[k] * joint.axis[k]).sum());
                rest.compose(&Pose::at(joint.axis.map(|x| x * positions[i])))
            }
            JointKind::Revolute => {
                let of_pose = || recorded.get(&i).map_or(0.0, |pose| angle(&rest, pose, joint.axis, joint.range));
                positions[i] = known(i).unwrap_or_else(of_pose);
                let (sine, cosine) = farsa_num::sin_cos(positions[i] / 2.0);
                let [x, y, z] = joint.axis.map(|part| part * sine);
                rest.compose(&Pose { position: [0.0; 3], rotation: [x, y, z, cosine] })
            }
        };
        poses.push(pose);
    }
    let reached = recorded.iter().all(|(i, pose)| poses.get(*i).is_none_or(|found| is_close(found, pose)));
    let joints = robot.joints().map(|joint| positions[joint.index()]).collect();
    reached.then(|| Keyframe { name: "start".into(), joints, bodies })
}

/// Returns the pose of the nearest recorded segment from `i` on down its chain.
fn descendant<'r>(robot: &Robot, recorded: &'r BTreeMap<usize, Pose<f64>>, i: usize) -> Option<&'r Pose<f64>> {
    let mut next = i;
    loop {
        if let Some(pose) = recorded.get(&next) {
            return Some(pose);
        }
        next = (next + 1..robot.segments.len())
            .find(|child| robot.segments[*child].parent.is_some_and(|parent| parent.index() == next))?;
    }
}

/// Returns the angle about an axis between two rotations, within the range if a full turn leads there [rad].
fn angle(from: &Pose<f64>, to: &Pose<f64>, axis: [f64; 3], [low, high]: [f64; 2]) -> f64 {
    let [x, y, z, w] = from.rotation;
    let back = Pose { position: [0.0; 3], rotation: [-x, -y, -z, w] };
    let [x, y, z, w] = back.compose(&Pose { position: [0.0; 3], rotation: to.rotation }).rotation;
    let turn = core::f64::consts::TAU;
    let angle = 2.0 * atan2(x * axis[0] + y * axis[1] + z * axis[2], w);
    let turns = [0.0, -turn, turn].map(|whole| angle + whole);
    // The recording has single precision.
    turns.into_iter().find(|x| (low - CLOSE..=high + CLOSE).contains(x)).map_or(angle, |x| x.clamp(low, high))
}

fn is_close(a: &Pose<f64>, b: &Pose<f64>) -> bool {
    let far = (0..3).map(|k| (a.position[k] - b.position[k]).abs()).fold(0.0, f64::max);
    let same: f64 = a.rotation.iter().zip(&b.rotation).map(|(a, b)| a * b).sum();
    far < CLOSE * (1.0 + b.position.iter().fold(0.0, |far: f64, x| far.max(x.abs()))) && same.abs() > 1.0 - CLOSE
}

#[cfg(test)]
mod tests {
    use super::*;
    use farsa_body::kinematics::KinematicTree;
    use farsa_body::robot::MassProperties;
    use farsa_body::robots::ArmAndHand;

    #[test]
    fn an_arm_comes_to_its_recorded_poses() {
        let robot = ArmAndHand::default().robot().expect("a robot");
        let wanted: Vec<f64> = robot
            .joints()
            .map(|joint| {
                let [low, high] = robot.segments[joint.index()].joint.range;
                low + 0.3 * (high - low)
            })
            .collect();
        let poses = KinematicTree::new(&robot).expect("a tree").poses(&wanted);
        let mut recorded: BTreeMap<usize, Pose<f64>> = poses.into_iter().enumerate().collect();
        let found = keyframe(&robot, &recorded, |_| None).expect("a keyframe");
        let worst = found.joints.iter().zip(&wanted).map(|(a, b)| (a - b).abs()).fold(0.0, f64::max);
        assert!(worst < 1e-9, "{worst}");
        // A body that no joint can reach.
        recorded.entry(3).and_modify(|pose| pose.position[0] += 0.01);
        assert!(keyframe(&robot, &recorded, |_| None).is_none());
    }

    #[test]
    fn sliders_without_recording_carry_the_recorded_body() {
        let mut robot = Robot::new("ball");
        let at = Pose::planar([1.0, 2.0], 0.5);
        let body = robot.add_sliding_body("ball", at, MassProperties::sphere(0.3, 0.06), true);
        let wanted = at.compose(&Pose::planar([0.25, -0.5], 0.75));
        let found = keyframe(&robot, &BTreeMap::from([(body.index(), wanted)]), |_| None).expect("a keyframe");
        assert_eq!(found.joints.len(), 3);
        for (found, wanted) in found.joints.iter().zip([0.25, -0.5, 0.75]) {
            assert!((found - wanted).abs() < 1e-12, "{found} {wanted}");
        }
    }
}
