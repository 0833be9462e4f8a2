//! Motors of a robot with joints.

use farsa_body::ChannelError;
use farsa_body::actuators::Law;
use farsa_body::motors::{Muscles, ServoGroup, ServoRange, TorqueMotor, VelocityMotor};
use farsa_body::ports::{Channels, JointId, Motor};
use farsa_lab::Error;

use crate::check::source::Source;
use crate::document::MotorKind;
use crate::jointed::SpatialWorld;
use crate::jointed::actuation::{self, is_muscles, is_servo, is_torque, is_velocity};
use crate::jointed::registered::{self, PartOfSpatial, RegisteredMotor};
use crate::jointed::scene::Scene;
use crate::jointed::sensing::ON_WHEELS;

/// A motor of a robot with joints.
#[derive(Clone, Debug)]
pub(crate) enum Driving {
    Velocity(Vec<VelocityMotor>),
    Torque(Vec<TorqueMotor>),
    Servos(Vec<ServoGroup<Vec<ServoRange>>>),
    Muscles(Vec<Muscles>),
    Registered(RegisteredMotor),
}

/// Calls a method of the motor of any kind.
macro_rules! motor {
    ($driving:expr, $motor:ident => $call:expr) => {
        match $driving {
            Driving::Velocity($motor) => $call,
            Driving::Torque($motor) => $call,
            Driving::Servos($motor) => $call,
            Driving::Muscles($motor) => $call,
            Driving::Registered($motor) => $call,
        }
    };
}

impl Channels for Driving {
    fn channels(&self) -> usize {
        motor!(self, motor => motor.channels())
    }

    fn reset(&mut self) {
        motor!(self, motor => motor.reset());
    }
}

impl<W: SpatialWorld> Motor<W> for Driving {
    fn drive(&mut self, y: &[f32], world: &mut W) {
        motor!(self, motor => motor.drive(y, world));
    }
}

/// Lists the joints of a motor: those named, or all. Unless the law is `given`, all means those with an actuator of
/// the kind.
pub(crate) fn joints_of(kind: &MotorKind, scene: &Scene, path: &str, source: &Source) -> Result<Vec<JointId>, Error> {
    type Is = fn(&Law<f64>) -> bool;
    let (joints, given, of_kind): (_, _, Is) = match kind {
        MotorKind::JointVelocity { joints, gain, .. } => (joints, gain.is_some(), is_velocity),
        MotorKind::JointTorque { joints, largest } => (joints, largest.is_some(), is_torque),
        MotorKind::Servo { joints, stiffness, .. } => (joints, stiffness.is_some(), is_servo),
        MotorKind::Muscles { joints, tension, .. } => (joints, tension.is_some(), is_muscles),
        _ => return Ok(Vec::new()),
    };
    scene.joints(joints, |joint| given || actuation::has(scene, joint, of_kind), path, source)
}

/// Builds the motor at a path of the document. Adds the actuators that the robot lacks.
pub(crate) fn motor(kind: &MotorKind, scene: &mut Scene, path: &str, source: &Source) -> Result<Driving, Error> {
    let wrong = |error: ChannelError| source.wrong(path, error);
    let joints = joints_of(kind, scene, path, source)?;
    Ok(match kind {
        MotorKind::JointVelocity { largest, gain, limit, .. } => {
            let build = |joint| {
                let (actuator, gain) = actuation::velocity(scene, joint, [*gain, *limit], path, source)?;
                VelocityMotor::new(actuator, *largest as f32, gain as f32).map_err(wrong)
            };
            Driving::Velocity(joints.into_iter().map(build).collect::<Result<_, _>>()?)
        }
        MotorKind::JointTorque { largest, .. } => {
            let build = |joint| {
                let (actuator, largest) = actuation::torque(scene, joint, *largest, path, source)?;
                TorqueMotor::new(actuator, largest as f32).map_err(wrong)
            };
            Driving::Torque(joints.into_iter().map(build).collect::<Result<_, _>>()?)
        }
        MotorKind::Servo { together, from, to, stiffness, damping, limit, .. } => {
            let build = |joint| {
                let [low, high] = scene.range(joint);
                let [from, to] = [from.unwrap_or(low), to.unwrap_or(high)].map(|end| end as f32);
                let servo = actuation::servo(scene, joint, [*stiffness, *damping, *limit], path, source)?;
                Ok(ServoRange { servo, from, to })
            };
            let servos = joints.into_iter().map(build).collect::<Result<Vec<_>, Error>>()?;
            let groups = if *together { vec![servos] } else { servos.into_iter().map(|servo| vec![servo]).collect() };
            Driving::Servos(groups.into_iter().map(ServoGroup::new).collect::<Result<_, _>>().map_err(wrong)?)
        }
        MotorKind::Muscles { tension, moment_arm, .. } => {
            let build =
                |joint| Ok(Muscles::new(actuation::muscles(scene, joint, [*tension, *moment_arm], path, source)?));
            Driving::Muscles(joints.into_iter().map(build).collect::<Result<_, Error>>()?)
        }
        MotorKind::Registered { kind, keys } => {
            Driving::Registered(registered::motor(kind, keys, PartOfSpatial { scene, path, source })?)
        }
        _ => return Err(source.wrong(path, ON_WHEELS)),
    })
}
