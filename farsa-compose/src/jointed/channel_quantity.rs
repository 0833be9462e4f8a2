//! Quantities of the channels of a robot with joints.

use farsa_body::actuators::Law;
use farsa_body::ports::JointId;
use farsa_body::robot::JointKind;

use crate::document::{MotorKind, SensorKind};
use crate::jointed::actuation;
use crate::jointed::eyes::{of_blobs, of_image, of_offset};
use crate::jointed::scene::Scene;
use crate::parts::channel_quantity::ChannelQuantity;
use crate::parts::eye::seen;

const AXES: [&str; 3] = ["x", "y", "z"];

/// Returns the joint of a channel, from those named or from all of the kind.
fn joint(names: &[String], channel: usize, scene: &Scene, fits: impl Fn(JointId) -> bool) -> Option<JointId> {
    let mut joints_of_robot = scene.robot.joints().filter(|joint| joint.index() < scene.own_bodies());
    match names.get(channel) {
        Some(name) => joints_of_robot.find(|joint| scene.joint_name(*joint) == name),
        None => joints_of_robot.filter(|joint| fits(*joint)).nth(channel),
    }
}

/// Returns the name of a joint, its range, and the units of its position, speed and effort.
fn about(joint: Option<JointId>, scene: &Scene) -> (String, [f64; 2], [&'static str; 3]) {
    let name = joint.map_or_else(String::new, |joint| scene.joint_name(joint).to_owned());
    let segment = joint.and_then(|joint| scene.robot.segments.get(joint.index()));
    let slides = segment.is_some_and(|segment| segment.joint.kind == JointKind::Prismatic);
    let units = if slides { ["m", "m/s", "N"] } else { ["rad", "rad/s", "N m"] };
    (name, joint.map_or([0.0, 1.0], |joint| scene.range(joint)), units)
}

/// Describes the quantity of a sensor channel.
pub(crate) fn sensed(kind: &SensorKind, channel: usize, scene: &Scene) -> ChannelQuantity {
    let first = || scene.robot.segments.first().map_or("", |segment| segment.name.as_str()).to_owned();
    let body = |name: &Option<String>| name.clone().unwrap_or_else(first);
    match kind {
        SensorKind::JointPosition { joints, from, to } => {
            let (name, [low, high], [unit, ..]) = about(joint(joints, channel, scene, |_| true), scene);
            ChannelQuantity::new(format!("position of {name}"), unit, [from.unwrap_or(low), to.unwrap_or(high)])
        }
        SensorKind::JointSpeed { joints } => {
            let (name, _, [_, unit, _]) = about(joint(joints, channel, scene, |_| true), scene);
            ChannelQuantity::new(format!("speed of {name}"), unit, [0.0, 1.0])
        }
        SensorKind::Touch { .. } => ChannelQuantity::new("whether something is touched", "1", [0.0, 1.0]),
        SensorKind::ContactForce { .. } => ChannelQuantity::new("force", "N", [0.0, 1.0]),
        SensorKind::TargetPosition { target, scale, body: own, .. } => {
            // A channel is scale times the distance, so it is 1 at 1 / scale meters.
            let end = if *scale == 0.0 { 1.0 } else { 1.0 / scale };
            let way = format!("{} of the way from {} to {target}", AXES[channel % 3], body(own));
            ChannelQuantity::new(way, "m", [0.0, end])
        }
        SensorKind::BodyPose { body: name } if channel < 3 => {
            ChannelQuantity::new(format!("{} of {}", AXES[channel], body(name)), "m", [0.0, 1.0])
        }
        SensorKind::BodyPose { body: name } => {
            let part = ["x", "y", "z", "w"][(channel - 3) % 4];
            ChannelQuantity::new(format!("{part} of the orientation of {}", body(name)), "1", [0.0, 1.0])
        }
        SensorKind::BodyVelocity { body: name, .. } if channel < 3 => {
            ChannelQuantity::new(format!("{} of the velocity of {}", AXES[channel], body(name)), "m/s", [0.0, 1.0])
        }
        SensorKind::BodyVelocity { body: name, .. } => {
            let what = format!("{} of the angular velocity of {}", AXES[channel % 3], body(name));
            ChannelQuantity::new(what, "rad/s", [0.0, 1.0])
        }
        SensorKind::Height { body: name, .. } => {
            ChannelQuantity::new(format!("height of {}", body(name)), "m", [0.0, 1.0])
        }
        SensorKind::Camera(camera) => seen(camera, channel),
        SensorKind::CameraImage { eye } => of_image(eye, channel),
        SensorKind::ColorBlobs { colors, .. } => of_blobs(colors, channel),
        SensorKind::VisualOffset { of, from, .. } => of_offset([of, from], channel),
        SensorKind::Constant { value } => ChannelQuantity::new(format!("always {value}"), "1", [0.0, 1.0]),
        // Sensors of robots on wheels.
        _ => ChannelQuantity::new("nothing", "1", [0.0, 1.0]),
    }
}

/// Describes the quantity of a motor channel.
pub(crate) fn driven(kind: &MotorKind, channel: usize, scene: &Scene) -> ChannelQuantity {
    let joint = |names: &[String], channel, given: bool, is: fn(&Law<f64>) -> bool| {
        let joint = joint(names, channel, scene, |joint| given || actuation::has(scene, joint, is));
        (joint, about(joint, scene))
    };
    match kind {
        MotorKind::JointVelocity { joints, largest, gain, .. } => {
            let (_, (name, _, [_, unit, _])) = joint(joints, channel, gain.is_some(), actuation::is_velocity);
            ChannelQuantity::new(format!("speed of {name}"), unit, [-largest, *largest])
        }
        MotorKind::JointTorque { joints, largest } => {
            let (found, (name, _, [.., unit])) = joint(joints, channel, largest.is_some(), actuation::is_torque);
            let own = found.and_then(|joint| actuation::limit(scene, joint));
            let largest = largest.or(own).unwrap_or(1.0);
            ChannelQuantity::new(format!("torque of {name}"), unit, [-largest, largest])
        }
        MotorKind::Servo { joints, together, from, to, stiffness, .. } => {
            let (_, (name, [low, high], [unit, ..])) = joint(joints, channel, stiffness.is_some(), actuation::is_servo);
            let name = if *together { format!("{name} and all with it") } else { name };
            ChannelQuantity::new(format!("position of {name}"), unit, [from.unwrap_or(low), to.unwrap_or(high)])
        }
        MotorKind::Muscles { joints, tension, .. } => {
            // A pair of muscles has two channels.
            let (_, (name, ..)) = joint(joints, channel / 2, tension.is_some(), actuation::is_muscles);
            let which = ["agonist", "antagonist"][channel % 2];
            ChannelQuantity::new(format!("activation of the {which} of {name}"), "1", [0.0, 1.0])
        }
        // Motors of robots on wheels.
        _ => ChannelQuantity::new("nothing", "1", [0.0, 1.0]),
    }
}
