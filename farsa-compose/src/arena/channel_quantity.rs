//! Quantities of the channels of robots in an arena.

use farsa_body::robots::MobileRobot;
use farsa_body::sensors::infrared;

use crate::document::{InfraredModel, MotorKind, SensorKind};
use crate::parts::channel_quantity::ChannelQuantity;
use crate::parts::eye::seen;

/// Describes the quantity of a sensor channel.
pub(crate) fn sensed(kind: &SensorKind, channel: usize, robot: &MobileRobot) -> ChannelQuantity {
    const AXES: [&str; 3] = ["x", "y", "z"];
    let side = ["left", "right"][channel % 2];
    let angle = || robot.infrared.angles.get(channel).map_or(0.0, |angle| angle.to_degrees());
    match kind {
        SensorKind::Infrared { model, groups, .. } => {
            let quantity = format!("distance of what is near, {}", infrared_way(robot, *groups, channel));
            let ends = match model {
                InfraredModel::Analytic => infrared::InfraredModel::WALL_ENDS,
                InfraredModel::Rays | InfraredModel::Tables => [robot.infrared.range, 0.0],
            };
            ChannelQuantity { linear: *model == InfraredModel::Rays, ..ChannelQuantity::new(quantity, "m", ends) }
        }
        SensorKind::Light { .. } => {
            ChannelQuantity::new(format!("light, at {:.0} degrees to the left of ahead", angle()), "1", [0.0, 1.0])
        }
        SensorKind::GroundColor { middle: true, rgb: false, .. } => {
            ChannelQuantity::new("grey of the ground under the middle", "1", [0.0, 1.0])
        }
        SensorKind::GroundColor { rgb: false, .. } => {
            ChannelQuantity::new(format!("grey of the ground at place {}", channel + 1), "1", [0.0, 1.0])
        }
        SensorKind::GroundColor { .. } => {
            let color = ["red", "green", "blue"][channel % 3];
            ChannelQuantity::new(format!("{color} of the ground at place {}", channel / 3 + 1), "1", [0.0, 1.0])
        }
        SensorKind::LaserDistance { range, .. } => {
            ChannelQuantity::new(format!("distance along beam {} from the left", channel + 1), "m", [0.0, *range])
        }
        SensorKind::Camera(camera) => seen(camera, channel),
        SensorKind::WheelSpeed { signed } => {
            let largest = robot.max_wheel_speed;
            let zero = if *signed { 0.0 } else { -largest };
            ChannelQuantity::new(format!("speed of the {side} wheel"), "rad/s", [zero, largest])
        }
        SensorKind::Traction { largest } => {
            let way = ["ahead", "to the left"][channel % 2];
            ChannelQuantity::new(format!("speed at which the robot is pulled {way}"), "m/s", [0.0, *largest])
        }
        SensorKind::Signal { .. } => ChannelQuantity::new(
            format!("signal in sector {} counter-clockwise from ahead", channel + 1),
            "1",
            [0.0, 1.0],
        ),
        SensorKind::Attachment {} => ChannelQuantity::new("whether something is held", "1", [0.0, 1.0]),
        SensorKind::Touch { .. } => ChannelQuantity::new("whether something is touched", "1", [0.0, 1.0]),
        SensorKind::ContactForce { .. } => ChannelQuantity::new("force", "N", [0.0, 1.0]),
        SensorKind::TargetPosition { target, scale, .. } => {
            let end = if *scale == 0.0 { 1.0 } else { 1.0 / scale };
            ChannelQuantity::new(format!("{} of the way to {target}", AXES[channel % 3]), "m", [0.0, end])
        }
        SensorKind::BodyPose { .. } if channel < 3 => {
            ChannelQuantity::new(format!("{} of the robot", AXES[channel]), "m", [0.0, 1.0])
        }
        SensorKind::BodyPose { .. } => {
            let part = ["x", "y", "z", "w"][(channel - 3) % 4];
            ChannelQuantity::new(format!("{part} of the robot's orientation"), "1", [0.0, 1.0])
        }
        SensorKind::BodyVelocity { .. } if channel < 3 => {
            ChannelQuantity::new(format!("{} of the robot's velocity", AXES[channel]), "m/s", [0.0, 1.0])
        }
        SensorKind::BodyVelocity { .. } => {
            ChannelQuantity::new(format!("{} of the robot's angular velocity", AXES[channel % 3]), "rad/s", [0.0, 1.0])
        }
        SensorKind::Height { .. } => ChannelQuantity::new("height of the robot", "m", [0.0, 1.0]),
        SensorKind::JointPosition { joints, from, to } => {
            let ends = [from.unwrap_or(0.0), to.unwrap_or(1.0)];
            ChannelQuantity::new(format!("angle of the {}", joint(joints, channel)), "rad", ends)
        }
        SensorKind::JointSpeed { joints } => {
            ChannelQuantity::new(format!("speed of the {}", joint(joints, channel)), "rad/s", [0.0, 1.0])
        }
        // Sensors of robots with joints, and registered ones, which describe themselves.
        SensorKind::CameraImage { .. }
        | SensorKind::ColorBlobs { .. }
        | SensorKind::VisualOffset { .. }
        | SensorKind::Registered { .. } => ChannelQuantity::new("nothing", "1", [0.0, 1.0]),
        SensorKind::Energy {} => ChannelQuantity::new("energy, 0 dead", "1", [0.0, 1.0]),
        SensorKind::Carried {} => ChannelQuantity::new("whether food is carried", "1", [0.0, 1.0]),
        SensorKind::Constant { value } => ChannelQuantity::new(format!("always {value}"), "1", [0.0, 1.0]),
    }
}

/// Gets the wheel of a channel, from those named or from both.
fn joint(joints: &[String], channel: usize) -> String {
    joints.get(channel).cloned().unwrap_or_else(|| ["left-wheel", "right-wheel"][channel % 2].into()).replace('-', " ")
}

/// Describes the directions of the infrared sensors of a channel.
fn infrared_way(robot: &MobileRobot, groups: u32, channel: usize) -> String {
    let angles = &robot.infrared.angles;
    let size = if groups == 0 { 1 } else { (angles.len() / groups as usize).max(1) };
    let angle = angles.get(channel * size).map_or(0.0, |angle| angle.to_degrees());
    let prefix = if size > 1 { format!("the nearest of {size} sensors around ") } else { "at ".into() };
    format!("{prefix}{angle:.0} degrees to the left of ahead")
}

/// Describes the quantity of a motor channel.
pub(crate) fn driven(kind: &MotorKind, channel: usize, robot: &MobileRobot) -> ChannelQuantity {
    let largest = robot.max_wheel_speed;
    match kind {
        MotorKind::Wheels {} => ChannelQuantity::new(
            format!("speed of the {} wheel", ["left", "right"][channel % 2]),
            "rad/s",
            [-largest, largest],
        ),
        MotorKind::SpeedAndTurn { forwards } if channel == 0 => {
            let zero = if *forwards { 0.0 } else { -largest };
            ChannelQuantity::new("s, the mean of the wheels' speeds", "rad/s", [zero, largest])
        }
        MotorKind::SpeedAndTurn { .. } => ChannelQuantity::new(
            "t: the left wheel turns at s - t, the right one at s + t",
            "rad/s",
            [-largest, largest],
        ),
        MotorKind::Leds { colors, .. } => {
            let color = colors.get(channel).map_or_else(String::new, |color| format!("{color:?}").to_lowercase());
            ChannelQuantity::new(format!("brightness of the {color} LED"), "1", [0.0, 1.0])
        }
        MotorKind::Signal {} => ChannelQuantity::new("what is signalled", "1", [0.0, 1.0]),
        MotorKind::Attachment {} => ChannelQuantity::new("the attachment device: more than 1/2 holds", "1", [0.0, 1.0]),
        // Motors of robots with joints.
        _ => ChannelQuantity::new("nothing", "1", [0.0, 1.0]),
    }
}
