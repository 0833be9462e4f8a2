//! Commands of the arm and hand that a script makes up.

use farsa::body::ports::{Actuated, ActuatorId, BodyId, Handles, JointId, Joints};
use farsa::body::robots::ArmAndHand;
use farsa_experiments::reach_grasp_lift::{Statics, Timetable};

use crate::phase::{JOINTS, MUSCLES, WORDS};

/// Takes commands instead of a world.
pub(crate) struct Sink([[f32; 2]; JOINTS]);

impl Default for Sink {
    fn default() -> Self {
        Self([[0.0; 2]; JOINTS])
    }
}

impl Handles for Sink {
    type Body = BodyId;
    type Joint = JointId;
    type Actuator = ActuatorId;
}

impl Actuated for Sink {
    fn command(&mut self, actuator: ActuatorId, value: [f32; 2]) {
        self.0[actuator.index()] = value;
    }
}

impl Sink {
    /// The commands in a phase's order.
    pub(crate) fn words(&self) -> [f32; WORDS] {
        let mut words = [0.0; WORDS];
        for (i, command) in self.0.iter().enumerate() {
            if i < MUSCLES {
                words[2 * i..2 * i + 2].copy_from_slice(command);
            } else {
                words[MUSCLES + i] = command[0];
            }
        }
        words
    }
}

/// A point of a body \[m in its frame\] that shall press downwards, with what force \[N\].
pub(crate) struct Press {
    pub(crate) body: BodyId,
    pub(crate) point: [f64; 3],
    pub(crate) force: f64,
}

/// Commands that hold a posture \[J1..J27, rad\]: activations of the arm, gravity and what presses made up for, and the
/// hand's positions.
pub(crate) fn hold<W>(statics: &Statics, world: &W, wanted: &[f64], press: &Press) -> [f32; WORDS]
where
    W: Joints<Joint = JointId> + ?Sized,
{
    let (joints, time) = (ArmAndHand::joints(), Timetable::default());
    let q: Vec<f64> = joints.iter().map(|joint| f64::from(world.position(*joint))).collect();
    let poses = statics.tree().poses(&q);
    let pressing = statics.tree().jacobian(&poses, press.body, press.point);
    let mut torques = statics.gravity_torques(&q);
    for i in 0..MUSCLES {
        torques[i] += time.stiffness[i] * (wanted[i] - q[i]) - time.damping[i] * f64::from(world.speed(joints[i]));
        torques[i] -= pressing[i][5] * press.force;
    }
    let (activations, _) = statics.activations(&q, &torques);
    let values = activations.into_iter().flatten().chain(wanted[MUSCLES..].iter().copied());
    let mut words = [0.0; WORDS];
    for (word, value) in words.iter_mut().zip(values) {
        *word = value as f32;
    }
    words
}
