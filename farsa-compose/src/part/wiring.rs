//! Actuators of motors: those of the model, or new ones.

use farsa_body::actuators::Law;
use farsa_body::ports::{ActuatorId, JointId};
use farsa_body::robot::{Actuator, Robot};

pub(crate) fn is_velocity(law: &Law<f64>) -> bool {
    // A spring without stiffness is a damper, d (v - w), and so a motor of velocity without a limit.
    matches!(law, Law::Velocity(_)) || matches!(law, Law::Held(held) if held.stiffness == 0.0)
}

pub(crate) fn is_torque(law: &Law<f64>) -> bool {
    matches!(law, Law::Torque(_))
}

pub(crate) fn is_servo(law: &Law<f64>) -> bool {
    matches!(law, Law::Servo(_))
}

pub(crate) fn is_muscles(law: &Law<f64>) -> bool {
    matches!(law, Law::MusclePair(_))
}

/// Actuators of a robot, to which motors add those that they lack.
#[derive(Clone, Debug, Default)]
pub(crate) struct Wiring {
    pub(crate) actuators: Vec<Actuator>,
    /// Actuators with a motor.
    pub(crate) driven: Vec<ActuatorId>,
    /// Actuators that motors added, with the place of the motor in the file.
    pub(crate) added: Vec<(ActuatorId, String)>,
}

impl Wiring {
    /// Begins with the actuators of the robot.
    pub(crate) fn new(robot: &Robot) -> Self {
        Self { actuators: robot.actuators.clone(), driven: Vec::new(), added: Vec::new() }
    }

    pub(crate) fn find(&self, fits: impl Fn(&Actuator) -> bool) -> Option<(ActuatorId, Law<f64>)> {
        let mut found = self.actuators.iter().enumerate().filter(|(_, actuator)| fits(actuator));
        found.next().map(|(number, actuator)| (ActuatorId(number as u16), actuator.law))
    }

    /// Returns the first actuator of a joint.
    pub(crate) fn first(&self, joint: JointId) -> Option<ActuatorId> {
        self.find(|actuator| actuator.joint == joint).map(|(actuator, _)| actuator)
    }

    /// Returns the first actuator of a joint with a law of this kind.
    pub(crate) fn own(&self, joint: JointId, kind: fn(&Law<f64>) -> bool) -> Option<(ActuatorId, Law<f64>)> {
        self.find(|actuator| actuator.joint == joint && kind(&actuator.law))
    }

    /// Returns true for a joint with an actuator of this kind.
    pub(crate) fn has(&self, joint: JointId, kind: fn(&Law<f64>) -> bool) -> bool {
        self.own(joint, kind).is_some()
    }

    /// Finds the torque limit of a joint's own motor, if any [N m or N].
    pub(crate) fn limit(&self, joint: JointId) -> Option<f64> {
        match self.own(joint, is_torque)?.1 {
            Law::Torque(torque) => Some(torque.limit).filter(|limit| limit.is_finite()),
            _ => None,
        }
    }

    /// Lists motors that added an actuator to a joint on which another one acts without a command.
    pub(crate) fn warnings(&self, robot: &Robot) -> Vec<String> {
        let mut warnings = Vec::new();
        for (added, place) in &self.added {
            let new = &self.actuators[added.index()];
            let others = self.actuators.iter().enumerate().filter(|(number, other)| {
                let driven = self.driven.iter().any(|id| id.index() == *number);
                other.joint == new.joint && !driven && !is_torque(&other.law)
            });
            warnings.extend(others.map(|(_, other)| {
                let segment = robot.segments.get(new.joint.index());
                let joint = segment.map_or("", |segment| &segment.joint.name);
                let model = &other.name;
                format!(
                    "{place}: `{joint}` has two actuators, the new one and the model's `{model}` with the command 0"
                )
            }));
        }
        warnings
    }
}
