//! Exported model files as MuJoCo and Pinocchio read them (fixtures/make.py) against our own description and kinematics.
#![allow(missing_docs, clippy::unwrap_used)]

use std::path::Path;

use farsa_body::Pose;
use farsa_body::actuators::{Held, Law, Torque};
use farsa_body::kinematics::KinematicTree;
use farsa_body::ports::BodyId;
use farsa_body::robot::{Collider, Joint, JointKind, MassProperties, Robot, Segment, Shape, Surface};
use farsa_body::robots::{ArmAndHand, Tabletop};
use farsa_models::mjcf::{self, Keyframe, MjcfOptions};
use farsa_models::urdf;
use serde_json::Value;

/// The tolerance between the readers' numbers and ours: relative to the largest of a kind, or absolute where that is
/// below 1.
const TOLERANCE: f64 = 1e-9;

fn tabletop() -> (Robot, MjcfOptions) {
    (Tabletop::default().scene(&ArmAndHand::default()).unwrap(), MjcfOptions::default())
}

fn unit(q: [f64; 4]) -> [f64; 4] {
    let n = q.iter().map(|x| x * x).sum::<f64>().sqrt();
    q.map(|x| x / n)
}

/// Builds the parts of a description that the arm and hand do not have. They are turned frames, axes of any length,
/// sliding, fixed and floating segments, full inertias, a plane, all laws, an endless joint, and a list that is not
/// depth-first.
fn zoo() -> (Robot, MjcfOptions) {
    let mut robot = Robot::new("zoo & \"co\"");
    let endless = [f64::NEG_INFINITY, f64::INFINITY];
    for i in 0..9u16 {
        let x = f64::from(i);
        let placement = Pose {
            position: [0.1 - 0.01 * x, 0.03 * x - 0.1, 0.05 + 0.01 * x],
            rotation: unit([0.2 * x - 0.7, 0.5 - 0.1 * x, 0.3, 0.9]),
        };
        let axis = [0.3 * x - 1.0, 0.7, 0.4 * x - 1.5];
        let name = format!("joint{i}");
        let (parent, joint) = match i {
            0 => (None, Joint::revolute(&name, axis, placement, [-3.0, 3.0])),
            2 | 6 => (Some(i - 1), Joint::prismatic(&name, axis, placement, [-0.3, 0.3])),
            3 => (Some(2), Joint::fixed(placement)),
            5 => (Some(1), Joint::revolute(&name, axis, placement, [-2.0, -0.5])),
            7 => (Some(3), Joint::revolute(&name, axis, placement, endless)),
            8 => (None, Joint::floating(placement)),
            _ => (Some(i - 1), Joint::revolute(&name, axis, placement, [-2.0, 2.0])),
        };
        let turned = Pose { position: [0.02, -0.01 * x, 0.03], rotation: unit([0.1 * x, 0.4, -0.3, 0.8]) };
        let body = MassProperties::cuboid(0.5 + 0.1 * x, [0.03, 0.02, 0.04]).placed(&turned);
        let joint = joint.with_armature(0.001 * x).with_damping(0.01 * x);
        let body = robot.add_segment(Segment::new(&format!("segment{i}"), parent.map(BodyId), joint, body));
        let shape = match i % 3 {
            0 => Shape::Sphere { radius: 0.01 },
            1 => Shape::Capsule { radius: 0.01, half_length: 0.02 },
            _ => Shape::Box { half: [0.01, 0.02, 0.03] },
        };
        robot.add_collider(Collider::new(&format!("shape{i}"), Some(body), shape, turned));
    }
    let plane = robot.add_collider(Collider::new("ground", None, Shape::Plane, Pose::at([0.0, 0.0, -3.0])));
    let surface = Surface { friction: 0.7, rolling_friction: 0.001, stiffness: 1e5, damping: 50.0 };
    robot.add_pair([8, plane], surface);
    robot.add_pair([7, 8], Surface { rolling_friction: 0.0, ..surface });
    robot.add_actuator("torque", robot.joint("joint0").unwrap(), Law::Torque(Torque { limit: 2.0 }));
    robot.add_actuator("held", robot.joint("joint2").unwrap(), Law::Held(Held { stiffness: 3.0, damping: 0.5 }));
    let bodies = vec![(BodyId(8), Pose::at([0.5, 0.4, 0.3]))];
    let keyframe = Keyframe { name: "away".into(), joints: vec![0.1, 0.2, 0.03, 0.4, -0.5, 0.06, 0.7], bodies };
    (robot, MjcfOptions { keyframes: vec![keyframe], time_step: 0.001, ..MjcfOptions::default() })
}

fn fixtures() -> &'static Path {
    Path::new(concat!(env!("CARGO_MANIFEST_DIR"), "/tests/fixtures"))
}

/// The committed texts. New texts are written next to the tests' other files, for an intended change.
#[test]
fn the_texts_are_the_committed_ones() {
    let mut others = Vec::new();
    for (name, (robot, options)) in [("tabletop", tabletop()), ("zoo", zoo())] {
        for (kind, made) in [("xml", mjcf::write(&robot, &options).unwrap()), ("urdf", urdf::write(&robot).unwrap())] {
            let name = format!("{name}.{kind}");
            if std::fs::read_to_string(fixtures().join(&name)).unwrap_or_default() != made {
                let new = Path::new(env!("CARGO_TARGET_TMPDIR")).join(name);
                std::fs::write(&new, made).unwrap();
                others.push(new);
            }
        }
    }
    assert!(others.is_empty(), "these are the new ones, see tests/fixtures/README.md: {others:?}");
}

fn list(value: &Value) -> Vec<f64> {
    value.as_array().unwrap().iter().map(|x| x.as_f64().unwrap()).collect()
}

fn close(what: &str, found: &[f64], ours: &[f64], worst: &mut f64) {
    assert_eq!(found.len(), ours.len(), "{what}");
    let size = ours.iter().fold(1.0_f64, |size, x| size.max(x.abs()));
    close_to(what, found, ours, size, worst);
}

fn close_to(what: &str, found: &[f64], ours: &[f64], size: f64, worst: &mut f64) {
    for (a, b) in found.iter().zip(ours) {
        let off = (a - b).abs() / size;
        *worst = worst.max(off);
        assert!(off <= TOLERANCE, "{what}: {found:?} is not {ours:?}");
    }
}

fn agrees(name: &str, robot: &Robot) {
    let text = std::fs::read_to_string(fixtures().join("readings.json")).unwrap();
    let all: Value = serde_json::from_str(&text).unwrap();
    let readings = &all[name];
    let mut worst = 0.0;
    for reader in ["mujoco", "pinocchio"] {
        let bodies = &readings[reader];
        for segment in &robot.segments {
            let (read, joint) = (&bodies[segment.name.as_str()], &segment.joint);
            let what = format!("{reader}, {name}, {}", segment.name);
            let inertia = list(&read["inertia"]);
            close_to(&what, &list(&read["mass"]), &[segment.mass], segment.mass, &mut worst);
            close(&what, &list(&read["centre"]), &segment.centre, &mut worst);
            let size = segment.inertia.iter().fold(0.0_f64, |size, x| size.max(x.abs()));
            close_to(&what, &inertia, &segment.inertia, size, &mut worst);
            if joint.kind.is_single() {
                let length = joint.axis.iter().map(|x| x * x).sum::<f64>().sqrt();
                close(&what, &list(&read["axis"]), &joint.axis.map(|x| x / length), &mut worst);
                close(&what, &list(&read["damping"]), &[joint.damping], &mut worst);
                let bounded = joint.range[0].is_finite();
                assert_eq!(read["range"].is_array(), bounded, "{what}");
                if bounded {
                    close(&what, &list(&read["range"]), &joint.range, &mut worst);
                }
                if reader == "mujoco" {
                    close(&what, &list(&read["armature"]), &[joint.armature], &mut worst);
                }
            }
        }
    }
    let tree = KinematicTree::new(robot).unwrap();
    let postures = readings["postures"].as_array().unwrap();
    assert!(postures.len() >= 100);
    for posture in postures {
        let poses = tree.poses(&list(&posture["q"]));
        for (body, place) in posture["bodies"].as_object().unwrap() {
            let place = list(place);
            let pose = poses[robot.body(body).unwrap().index()];
            close(body, &place[..3], &pose.position, &mut worst);
            // A quaternion and its negative are one rotation.
            let same: f64 = place[3..].iter().zip(&pose.rotation).map(|(a, b)| a * b).sum();
            let rotation: Vec<f64> = place[3..].iter().map(|x| x * same.signum()).collect();
            close(body, &rotation, &pose.rotation, &mut worst);
        }
    }
    println!("{name}: {} postures, worst difference {worst:.1e}", postures.len());
}

#[test]
fn arm_hand_table_and_sphere_are_read_as_they_are() {
    agrees("tabletop", &tabletop().0);
}

#[test]
fn whatever_can_be_described_is_read_as_it_is() {
    let (robot, _) = zoo();
    assert!(robot.segments.iter().any(|segment| segment.joint.kind == JointKind::Fixed));
    agrees("zoo", &robot);
}
