//! Actuators of motors: those of the model, or new ones.

use farsa_body::actuators::{Held, Law, MusclePair, Servo, Torque, Velocity};
use farsa_body::ports::{ActuatorId, JointId};
use farsa_body::robot::Actuator;
use farsa_lab::Error;

use crate::part::PartScene;
use crate::part::scene::WITH_JOINTS;
use crate::part::wiring::{is_muscles, is_servo, is_torque, is_velocity};

impl PartScene<'_> {
    /// Lists the joints of a motor: those named, or all. Unless its law is `given`, all means those with an actuator
    /// of the kind.
    pub(crate) fn driven(
        &self,
        names: &[String],
        given: bool,
        kind: fn(&Law<f64>) -> bool,
    ) -> Result<Vec<JointId>, Error> {
        let wiring = self.0.wiring();
        self.0.fitting(names, &|joint| given || wiring.has(joint, kind))
    }

    /// Returns the actuator of the motor: the joint's own of a kind, or a new one with the given law.
    fn taken(
        &self,
        joint: JointId,
        kind: fn(&Law<f64>) -> bool,
        law: Option<(Law<f64>, &str)>,
        lacking: &str,
    ) -> Result<(ActuatorId, Law<f64>), Error> {
        let name = self.0.joint_name(joint);
        let wiring = self.0.open_wiring().ok_or_else(|| self.error(WITH_JOINTS))?;
        let mut wiring = wiring.borrow_mut();
        let actuator = if let Some((law, word)) = law {
            let called = format!("{name} {word}");
            let new = ActuatorId(wiring.actuators.len() as u16);
            let existing = wiring.find(|actuator| actuator.name == called).map(|(actuator, _)| actuator);
            if existing.is_none() {
                wiring.actuators.push(Actuator { name: called, joint, law, command_range: None });
            }
            let actuator = existing.unwrap_or(new);
            wiring.added.push((actuator, self.0.line()));
            (actuator, law)
        } else {
            let why = format!("lacks the key {lacking}: `{name}` has no such motor of its own");
            wiring.own(joint, kind).ok_or_else(|| self.error(why))?
        };
        if wiring.driven.contains(&actuator.0) {
            return Err(self.error(format!("`{name}` has a motor of this kind already")));
        }
        wiring.driven.push(actuator.0);
        Ok(actuator)
    }

    /// Returns a velocity actuator, and its command per unit of speed [N m s/rad or N s/m, or 1].
    pub(crate) fn velocity(&self, joint: JointId, [gain, limit]: [Option<f64>; 2]) -> Result<(ActuatorId, f64), Error> {
        if gain.is_none() && limit.is_some() {
            return Err(self.error("lacks the key `gain`, of the motor whose `limit` it says"));
        }
        let law = gain.map(|gain| match limit {
            Some(limit) => Law::Velocity(Velocity { gain, limit }),
            None => Law::Held(Held { stiffness: 0.0, damping: gain }),
        });
        let law = law.map(|law| (law, "velocity"));
        let (actuator, law) = self.taken(joint, is_velocity, law, "`gain`")?;
        // With a custom gain the command is the torque at rest, g v. A velocity motor takes the speed v itself.
        let gain = match law {
            Law::Held(held) => held.damping,
            _ => 1.0,
        };
        Ok((actuator, gain))
    }

    /// Returns a torque actuator, and its limit [N m or N].
    pub(crate) fn torque(&self, joint: JointId, largest: Option<f64>) -> Result<(ActuatorId, f64), Error> {
        let law = largest.filter(|_| self.0.wiring().own(joint, is_torque).is_none());
        let law = law.map(|limit| (Law::Torque(Torque { limit }), "torque"));
        let (actuator, law) = self.taken(joint, is_torque, law, "`largest`")?;
        let limit = if let Law::Torque(torque) = law { torque.limit } else { 0.0 };
        let largest = largest.unwrap_or(limit);
        if !largest.is_finite() {
            let why = format!("lacks the key `largest`: the motor of `{}` has no limit", self.0.joint_name(joint));
            return Err(self.error(why));
        }
        Ok((actuator, largest))
    }

    /// Returns a servo. Stiffness, damping and limit are those of a new one.
    pub(crate) fn servo(
        &self,
        joint: JointId,
        [stiffness, damping, limit]: [Option<f64>; 3],
    ) -> Result<ActuatorId, Error> {
        if stiffness.is_none() && (damping.is_some() || limit.is_some()) {
            return Err(self.error("lacks the key `stiffness`, of the servo whose `damping` or `limit` it says"));
        }
        let law = stiffness.map(|stiffness| {
            let (damping, limit) = (damping.unwrap_or(0.0), limit.unwrap_or(f64::INFINITY));
            (Law::Servo(Servo { stiffness, damping, limit }), "servo")
        });
        Ok(self.taken(joint, is_servo, law, "`stiffness`")?.0)
    }

    /// Returns a pair of muscles. Tension and moment arm are those of a new pair.
    pub(crate) fn muscles(&self, joint: JointId, given: [Option<f64>; 2]) -> Result<ActuatorId, Error> {
        let law = match given {
            [Some(tension), Some(moment_arm)] => {
                let range = self.0.range(joint);
                if range.iter().any(|end| !end.is_finite()) {
                    let why =
                        format!("`{}` turns on and on; muscles need a joint with a range", self.0.joint_name(joint));
                    return Err(self.error(why));
                }
                Some((Law::MusclePair(MusclePair::thesis(tension, moment_arm, range)), "muscles"))
            }
            [None, None] => None,
            _ => return Err(self.error("has one of `tension` and `moment_arm`, which go together")),
        };
        Ok(self.taken(joint, is_muscles, law, "`tension`")?.0)
    }
}
