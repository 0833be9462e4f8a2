//! Descriptions of inputs and outputs for comments.

use crate::escaped::{acts, shortened};
use crate::experiment::controller_export::{MotorDrive, MotorExport, SensorExport, SensorReading, ServoExport};

/// Returns the lines that describe the inputs.
pub(super) fn inputs_text(sensors: &[SensorExport]) -> String {
    lines(sensors.iter().map(|sensor| (sensor.name.as_str(), reading(&sensor.reads))))
}

/// Returns the lines that describe the outputs.
pub(super) fn outputs_text(motors: &[MotorExport]) -> String {
    lines(motors.iter().map(|motor| (motor.name.as_str(), drive(&motor.drives))))
}

fn lines<'a>(channels: impl Iterator<Item = (&'a str, String)>) -> String {
    let line = |(index, (name, meaning)): (usize, (&str, String))| {
        let name = shortened(name);
        let text = if meaning.is_empty() { name.into() } else { format!("{name}: {meaning}") };
        format!(" *   {index} {}\n", comment(&text))
    };
    channels.enumerate().map(line).collect()
}

/// Returns a text on one line that cannot end a comment.
pub(super) fn comment(text: &str) -> String {
    let plain = |letter| if acts(letter) || matches!(letter, '\n' | '\t' | '\\') { ' ' } else { letter };
    let text: String = text.chars().map(plain).collect();
    text.replace("*/", "* /").replace("/*", "/ *")
}

fn reading(reading: &SensorReading) -> String {
    match reading {
        SensorReading::JointPosition { joint, from, to } => {
            format!("position of joint {} [rad], 0 at {from}, 1 at {to}", shortened(joint))
        }
        SensorReading::Touch { pairs, saturation } => {
            let pairs: Vec<String> =
                pairs.iter().map(|[a, b]| format!("{} and {}", shortened(a), shortened(b))).collect();
            format!("number of touching pairs / {saturation}, at most 1: {}", pairs.join(", "))
        }
        SensorReading::Way { target, from, axes, component, scale } => {
            let axis = ["x", "y", "z"].get(*component).unwrap_or(&"?");
            let axes = format!("{axes:?}").to_lowercase();
            let (to, start) = (shortened(&target.body), shortened(&from.body));
            format!(
                "{axis} of the way from {start} {:?} to {to} {:?} [m] in axes of the {axes}, times {scale}",
                from.at, target.at
            )
        }
        SensorReading::Quantity { quantity, unit, zero, one, linear } => {
            let between = if *linear { "" } else { ", a curve between" };
            format!("{} [{}], 0 at {zero}, 1 at {one}{between}", shortened(quantity), shortened(unit))
        }
        SensorReading::Label { phase, amplitude } => format!("{amplitude} in the phase {}, else 0", shortened(phase)),
        SensorReading::PreviousOutput { channel, scale } => {
            format!("output {channel} of the previous step, times {scale}, 0 in the first step")
        }
        SensorReading::Channel { .. } => String::new(),
    }
}

fn drive(drive: &MotorDrive) -> String {
    match drive {
        MotorDrive::Muscle { actuator, muscle } => {
            let muscle = if *muscle == 0 { "towards the lower limit" } else { "towards the upper limit" };
            format!("muscle of {} that pulls {muscle}", shortened(actuator))
        }
        MotorDrive::Quantity { quantity, unit, zero, one } => {
            format!("{} [{}], {zero} at 0, {one} at 1", shortened(quantity), shortened(unit))
        }
        MotorDrive::Servos { servos } => {
            let servo =
                |servo: &ServoExport| format!("{} {} at 0, {} at 1", shortened(&servo.actuator), servo.from, servo.to);
            format!("position of servos [rad]: {}", servos.iter().map(servo).collect::<Vec<_>>().join("; "))
        }
        MotorDrive::NextInput { channel } => format!("input {channel} of the next step"),
        MotorDrive::Channel { .. } => String::new(),
    }
}
