//! The motors of the format.

use farsa_body::ChannelError;
use farsa_lab::Error;
use farsa_lab::advanced::Part;

use crate::part::{planar_motor, spatial_motor};

/// Actuators of motors.
mod actuation;
/// Attachment devices.
mod attachment;
/// Torques of joints.
mod joint_torque;
/// Speeds of joints.
mod joint_velocity;
/// LEDs.
mod leds;
/// Pairs of muscles.
mod muscles;
/// Servos.
mod servo;
/// Signals.
mod signal;
/// Speed and turn of a robot on wheels.
mod speed_and_turn;
/// Wheels.
mod wheels;

/// Lists them under their names.
pub(crate) fn motors() -> Vec<Part> {
    vec![
        planar_motor::<wheels::Wheels>("wheels"),
        planar_motor::<speed_and_turn::SpeedAndTurn>("speed-and-turn"),
        planar_motor::<leds::Leds>("leds"),
        planar_motor::<signal::Signal>("signal"),
        planar_motor::<attachment::Attachment>("attachment"),
        spatial_motor::<joint_velocity::JointVelocity>("joint-velocity"),
        spatial_motor::<joint_torque::JointTorque>("joint-torque"),
        spatial_motor::<servo::Servo>("servo"),
        spatial_motor::<muscles::Muscles>("muscles"),
    ]
}

/// Describes an error without its place.
fn wrong(error: ChannelError) -> Error {
    Error::Other(error.to_string())
}
