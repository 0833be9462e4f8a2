//! Actuators of motors: those of the model, or new ones.

use farsa_body::actuators::{Held, Law, MusclePair, Servo, Torque, Velocity};
use farsa_body::ports::{ActuatorId, JointId};
use farsa_lab::Error;

use crate::check::source::Source;
use crate::jointed::scene::Scene;

/// Returns the first actuator of a joint with a law of this kind.
fn own(scene: &Scene, joint: JointId, kind: fn(&Law<f64>) -> bool) -> Option<(ActuatorId, Law<f64>)> {
    let actuators = scene.robot.actuators.iter().enumerate();
    let mut found = actuators.filter(|(_, actuator)| actuator.joint == joint && kind(&actuator.law));
    found.next().map(|(number, actuator)| (ActuatorId(number as u16), actuator.law))
}

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

/// Returns true for a joint with an actuator of this kind.
pub(crate) fn has(scene: &Scene, joint: JointId, kind: fn(&Law<f64>) -> bool) -> bool {
    own(scene, joint, kind).is_some()
}

/// Finds the torque limit of a joint's own motor, if any [N m or N].
pub(crate) fn limit(scene: &Scene, joint: JointId) -> Option<f64> {
    match own(scene, joint, is_torque)?.1 {
        Law::Torque(torque) => Some(torque.limit).filter(|limit| limit.is_finite()),
        _ => None,
    }
}

/// Lists motors that added an actuator to a joint on which another one acts without a command.
pub(crate) fn warnings(scene: &Scene) -> Vec<String> {
    let mut warnings = Vec::new();
    for (added, place) in &scene.added {
        let actuators = &scene.robot.actuators;
        let new = &actuators[added.index()];
        let others = actuators.iter().enumerate().filter(|(number, other)| {
            let driven = scene.driven.iter().any(|id| id.index() == *number);
            other.joint == new.joint && !driven && !is_torque(&other.law)
        });
        warnings.extend(others.map(|(_, other)| {
            let joint = scene.joint_name(new.joint);
            let model = &other.name;
            format!("{place}: `{joint}` has two actuators, the new one and the model's `{model}` with the command 0")
        }));
    }
    warnings
}

/// Returns the actuator of the motor at a path: the joint's own of a kind, or a new one with the given law.
fn taken(
    scene: &mut Scene,
    joint: JointId,
    kind: fn(&Law<f64>) -> bool,
    law: Option<(Law<f64>, &str)>,
    (lacking, path, source): (&str, &str, &Source),
) -> Result<(ActuatorId, Law<f64>), Error> {
    let name = scene.joint_name(joint).to_owned();
    let actuator = if let Some((law, word)) = law {
        let called = format!("{name} {word}");
        let existing = scene.robot.actuator(&called);
        let actuator = existing.unwrap_or_else(|| scene.robot.add_actuator(&called, joint, law));
        scene.added.push((actuator, source.of(path)));
        (actuator, law)
    } else {
        let why = format!("lacks the key {lacking}: `{name}` has no such motor of its own");
        own(scene, joint, kind).ok_or_else(|| source.wrong(path, why))?
    };
    if scene.driven.contains(&actuator.0) {
        return Err(source.wrong(path, format!("`{name}` has a motor of this kind already")));
    }
    scene.driven.push(actuator.0);
    Ok(actuator)
}

/// Returns a velocity actuator, and its command per unit of speed [N m s/rad or N s/m, or 1].
pub(crate) fn velocity(
    scene: &mut Scene,
    joint: JointId,
    [gain, limit]: [Option<f64>; 2],
    path: &str,
    source: &Source,
) -> Result<(ActuatorId, f64), Error> {
    if gain.is_none() && limit.is_some() {
        return Err(source.wrong(path, "lacks the key `gain`, of the motor whose `limit` it says"));
    }
    let law = gain.map(|gain| match limit {
        Some(limit) => Law::Velocity(Velocity { gain, limit }),
        None => Law::Held(Held { stiffness: 0.0, damping: gain }),
    });
    let law = law.map(|law| (law, "velocity"));
    let (actuator, law) = taken(scene, joint, is_velocity, law, ("`gain`", path, source))?;
    // With a custom gain the command is the torque at rest, g v. A velocity motor takes the speed v itself.
    let gain = match law {
        Law::Held(held) => held.damping,
        _ => 1.0,
    };
    Ok((actuator, gain))
}

/// Returns a torque actuator, and its limit [N m or N].
pub(crate) fn torque(
    scene: &mut Scene,
    joint: JointId,
    largest: Option<f64>,
    path: &str,
    source: &Source,
) -> Result<(ActuatorId, f64), Error> {
    let law = largest.filter(|_| own(scene, joint, is_torque).is_none());
    let law = law.map(|limit| (Law::Torque(Torque { limit }), "torque"));
    let (actuator, law) = taken(scene, joint, is_torque, law, ("`largest`", path, source))?;
    let limit = if let Law::Torque(torque) = law { torque.limit } else { 0.0 };
    let largest = largest.unwrap_or(limit);
    if !largest.is_finite() {
        let why = format!("lacks the key `largest`: the motor of `{}` has no limit", scene.joint_name(joint));
        return Err(source.wrong(path, why));
    }
    Ok((actuator, largest))
}

/// Returns a servo. Stiffness, damping and limit are those of a new one.
pub(crate) fn servo(
    scene: &mut Scene,
    joint: JointId,
    [stiffness, damping, limit]: [Option<f64>; 3],
    path: &str,
    source: &Source,
) -> Result<ActuatorId, Error> {
    if stiffness.is_none() && (damping.is_some() || limit.is_some()) {
        return Err(source.wrong(path, "lacks the key `stiffness`, of the servo whose `damping` or `limit` it says"));
    }
    let law = stiffness.map(|stiffness| {
        let (damping, limit) = (damping.unwrap_or(0.0), limit.unwrap_or(f64::INFINITY));
        (Law::Servo(Servo { stiffness, damping, limit }), "servo")
    });
    Ok(taken(scene, joint, is_servo, law, ("`stiffness`", path, source))?.0)
}

/// Returns a pair of muscles. Tension and moment arm are those of a new pair.
pub(crate) fn muscles(
    scene: &mut Scene,
    joint: JointId,
    given: [Option<f64>; 2],
    path: &str,
    source: &Source,
) -> Result<ActuatorId, Error> {
    let law = match given {
        [Some(tension), Some(moment_arm)] => {
            let range = scene.range(joint);
            if range.iter().any(|end| !end.is_finite()) {
                let why = format!("`{}` turns on and on; muscles need a joint with a range", scene.joint_name(joint));
                return Err(source.wrong(path, why));
            }
            Some((Law::MusclePair(MusclePair::thesis(tension, moment_arm, range)), "muscles"))
        }
        [None, None] => None,
        _ => return Err(source.wrong(path, "has one of `tension` and `moment_arm`, which go together")),
    };
    Ok(taken(scene, joint, is_muscles, law, ("`tension`", path, source))?.0)
}
