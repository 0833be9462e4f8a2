//! The parts of a world used by the checks.

use alloc::vec::Vec;

use crate::actuators::law::Law;
use crate::ports::{ActuatorId, BodyId, JointId};
use crate::robot::description::{Actuator, Robot};
use crate::robot::joint::JointKind;

/// The parts of a world that the checks read and move, and the extent of the checks.
#[derive(Clone, Debug, PartialEq)]
pub struct Probe<B = BodyId, J = JointId, A = ActuatorId> {
    /// All bodies of the world.
    pub bodies: Vec<B>,
    /// Bodies that can move freely.
    pub floating: Vec<B>,
    /// Bodies that can be placed anywhere on a plane. They keep their position and heading as long as they are not
    /// moved.
    pub planar: Vec<B>,
    /// Joints that can be placed, with the two ends of their ranges (in radians or meters).
    pub joints: Vec<(J, [f32; 2])>,
    /// Actuators with the lower and upper limits of both values of their commands.
    pub actuators: Vec<(A, [[f32; 2]; 2])>,
    /// Number of steps in a run. At least 16 are required.
    pub steps: usize,
    /// The tolerance for the difference between the mean speed of a step and the speeds at its ends (in m/s or rad/s).
    pub slack: f32,
}

impl Probe {
    /// The steps of a run where none are asked for.
    const STEPS: usize = 200;
    /// The slack where none is asked for.
    const SLACK: f32 = 0.1;

    /// Creates a probe for a world that was built from the given robot.
    pub fn for_robot(robot: &Robot) -> Self {
        let finite = |range: [f64; 2]| {
            let [low, high] = range.map(|x| x as f32);
            [if low.is_finite() { low } else { -1.0 }, if high.is_finite() { high } else { 1.0 }]
        };
        let range = |joint: JointId| finite(robot.segments.get(joint.index()).map_or([0.0; 2], |s| s.joint.range));
        let command = |actuator: &Actuator| match actuator.law {
            Law::MusclePair(_) => [[0.0; 2], [1.0; 2]],
            Law::Servo(_) => range(actuator.joint).map(|x| [x, 0.0]),
            Law::Torque(torque) => finite([-torque.limit, torque.limit]).map(|x| [x, 0.0]),
            Law::Held(_) | Law::Velocity(_) => [[-1.0, 0.0], [1.0, 0.0]],
        };
        let kinds = || robot.segments.iter().map(|s| s.joint.kind).enumerate();
        Self {
            bodies: kinds().map(|(i, _)| BodyId(i as u16)).collect(),
            floating: kinds().filter(|(_, k)| *k == JointKind::Floating).map(|(i, _)| BodyId(i as u16)).collect(),
            planar: Vec::new(),
            joints: robot.joints().map(|joint| (joint, range(joint))).collect(),
            actuators: (0u16..).map(ActuatorId).zip(robot.actuators.iter().map(command)).collect(),
            steps: Self::STEPS,
            slack: Self::SLACK,
        }
    }

    /// Creates a probe for a world with `count` bodies, joints and actuators that have the same numbers. The joints are
    /// placed between 0 and 1.
    pub fn numbered(count: u16, commands: [[f32; 2]; 2]) -> Self {
        Self {
            bodies: (0..count).map(BodyId).collect(),
            floating: Vec::new(),
            planar: Vec::new(),
            joints: (0..count).map(|i| (JointId(i), [0.0, 1.0])).collect(),
            actuators: (0..count).map(|i| (ActuatorId(i), commands)).collect(),
            steps: Self::STEPS,
            slack: Self::SLACK,
        }
    }
}
