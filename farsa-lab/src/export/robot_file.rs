//! `farsa robot`: the content of a model file.

use std::fmt::Write as _;
use std::fs;
use std::path::Path;

use farsa_body::actuators::{Law, Servo};
use farsa_body::robot::JointKind;
use farsa_models::mjcf::{self, MjcfOptions};
use farsa_models::{Imported, ReadError, ReadOptions, urdf};
use serde::Serialize;

use crate::error::Error;
use crate::escaped::{OneLine, shortened};
use crate::export::files::ModelFormat;
use crate::store::bounded::read_stream_text;

/// Content of a model file.
#[derive(Serialize)]
pub(crate) struct Summary {
    robot: String,
    file: String,
    segments: usize,
    joints: Vec<JointSummary>,
    colliders: usize,
    pairs: usize,
    mass: f64,
    /// `None` if the file does not set it.
    gravity: Option<[f64; 3]>,
    contacts: bool,
    notes: Vec<String>,
}

#[derive(Serialize)]
struct JointSummary {
    name: String,
    kind: &'static str,
    segment: String,
    parent: String,
    /// `None` for a joint without limits.
    range: [Option<f64>; 2],
    armature: f64,
    damping: f64,
    mass: f64,
    actuators: Vec<String>,
}

/// Reads a model file.
///
/// # Errors
/// [`Error::Usage`] for an invalid file, with the option that could help.
pub(crate) fn read(file: &Path, options: &ReadOptions) -> Result<Imported, Error> {
    // A pipe is read with a time limit.
    let piped = fs::metadata(file).is_ok_and(|found| !found.is_file() && !found.is_dir());
    let read = if piped {
        let text = read_stream_text(file, u64::try_from(options.limits.bytes).unwrap_or(u64::MAX))?;
        Imported::from_text(&text, options)
    } else {
        Imported::from_file(file, options)
    };
    read.map_err(|error| {
        let hint = match &error {
            ReadError::Mass { .. } => "; or --least-mass, --least-inertia, --balance",
            ReadError::Mesh { .. } => "; or --without-meshes",
            ReadError::Path { why, .. } if why.contains("package") => "; or --packages, --without-meshes",
            ReadError::Path { .. } => "; or --root, --without-meshes",
            _ => "",
        };
        Error::Usage(format!("{error}{hint}"))
    })
}

/// Returns the robot as a file of this format.
///
/// # Errors
/// [`Error::Usage`] for a robot that the format cannot describe.
pub(crate) fn written(reading: &Imported, format: ModelFormat) -> Result<String, Error> {
    let text = match format {
        ModelFormat::Mjcf => {
            let usual = MjcfOptions::default();
            let gravity = reading.gravity.unwrap_or(usual.gravity);
            mjcf::write(&reading.robot, &MjcfOptions { gravity, ..usual })
        }
        ModelFormat::Urdf => urdf::write(&reading.robot),
    };
    text.map_err(|error| Error::Usage(error.to_string()))
}

impl Summary {
    /// Creates the description of the robot in a file.
    pub(crate) fn new(file: &Path, reading: &Imported) -> Self {
        let robot = &reading.robot;
        let joints = robot.joints().map(|id| {
            let segment = &robot.segments[id.index()];
            let joint = &segment.joint;
            let turns = joint.kind == JointKind::Revolute;
            let [effort, angle] = if turns { ["N m", "rad"] } else { ["N", "m"] };
            let at_most = |limit: f64| {
                if limit.is_finite() { format!("at most {limit} {effort}") } else { "without limit".into() }
            };
            let law = |law: &Law<f64>| match law {
                Law::Servo(Servo { stiffness, damping, limit }) => {
                    format!("servo {stiffness} {effort}/{angle}, {damping} {effort} s/{angle}, {}", at_most(*limit))
                }
                Law::Torque(torque) => format!("motor {}", at_most(torque.limit)),
                Law::Held(held) => format!("speed {} {effort} s/{angle}", held.damping),
                Law::Velocity(motor) => {
                    format!("speed {} {effort} s/{angle}, {}", motor.gain, at_most(motor.limit))
                }
                Law::MusclePair(_) => "muscles".into(),
            };
            let actuators = robot.actuators.iter().filter(|actuator| actuator.joint == id);
            let parent = segment.parent.map_or("the world", |parent| robot.segments[parent.index()].name.as_str());
            JointSummary {
                name: joint.name.clone(),
                kind: if turns { "turns" } else { "slides" },
                segment: segment.name.clone(),
                parent: parent.into(),
                range: joint.range.map(|end| end.is_finite().then_some(end)),
                armature: joint.armature,
                damping: joint.damping,
                mass: segment.mass,
                actuators: actuators.map(|actuator| law(&actuator.law)).collect(),
            }
        });
        Self {
            robot: robot.name.clone(),
            file: file.display().to_string(),
            segments: robot.segments.len(),
            joints: joints.collect(),
            colliders: robot.colliders.len(),
            pairs: robot.pairs.len(),
            mass: robot.segments.iter().map(|segment| segment.mass).sum(),
            gravity: reading.gravity,
            contacts: reading.contacts,
            notes: reading.warnings.iter().map(ToString::to_string).collect(),
        }
    }

    pub(crate) fn text(&self) -> String {
        let Self { robot, file, segments, joints, colliders, pairs, mass, gravity, contacts, notes } = self;
        // A long name would widen every line.
        let line = |text: &str| OneLine(shortened(text)).to_string();
        let mut text = format!(
            "{}: {}\n{segments} segments of {mass:.4} kg, {} joints, {colliders} colliders, {pairs} pairs\n",
            OneLine(file),
            line(robot),
            joints.len()
        );
        // Writing to a string cannot fail.
        if let Some([x, y, z]) = gravity {
            let _ = writeln!(text, "gravity {x} {y} {z} m/s2");
        }
        if !contacts {
            text.push_str("all contacts are disabled\n");
        }
        let width =
            |of: fn(&JointSummary) -> &str| joints.iter().map(|j| line(of(j)).chars().count()).max().unwrap_or(0);
        let (names, carried) = (width(|joint| &joint.name), width(|joint| &joint.segment));
        for joint in joints {
            let range = match joint.range {
                [None, None] => "without end".into(),
                [low, high] => {
                    let end = |end: Option<f64>| end.map_or("...".into(), |end| format!("{end:.4}"));
                    format!("{} to {}", end(low), end(high))
                }
            };
            let actuators = joint.actuators.join("; ");
            let _ = writeln!(
                text,
                "  {:names$}  {:6} {:carried$} on {}: {range}{}{}",
                line(&joint.name),
                joint.kind,
                line(&joint.segment),
                line(&joint.parent),
                if actuators.is_empty() { "" } else { ", " },
                actuators
            );
        }
        if !notes.is_empty() {
            text.push_str("left out or replaced:\n");
        }
        for note in notes {
            let _ = writeln!(text, "  {}", OneLine(note));
        }
        text
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn names_stay_in_their_lines() {
        let names = ["\u{1b}[2J\u{9b}", "a\nerror: b", &"n".repeat(1 << 20)].map(str::to_owned);
        let joint = |name: &String| JointSummary {
            name: name.clone(),
            kind: "turns",
            segment: name.clone(),
            parent: name.clone(),
            range: [Some(-1.0), None],
            armature: 0.0,
            damping: 0.0,
            mass: 1.0,
            actuators: Vec::new(),
        };
        let [robot, file, _] = names.clone();
        let joints = names.iter().map(joint).collect();
        let summary = Summary {
            robot,
            file,
            segments: 4,
            joints,
            colliders: 0,
            pairs: 0,
            mass: 1.0,
            gravity: None,
            contacts: true,
            notes: names[..2].into(),
        };
        let text = summary.text();
        assert_eq!(text.lines().count(), 2 + 3 + 1 + 2, "{text}");
        assert!(text.starts_with("a\\nerror: b: \\u{1b}[2J\\u{9b}\n4 segments"), "{text}");
        assert!(!text.contains(['\u{1b}', '\u{9b}']) && text.lines().all(|line| line.len() < 700), "{text}");
    }
}
