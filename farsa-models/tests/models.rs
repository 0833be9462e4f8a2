//! Models that others wrote, read by us and by MuJoCo or Pinocchio (fixtures/models.py).
//!
//! The models are not ours to keep: `./ci test` fetches them and sets `FARSA_MODELS` to their folder.
#![allow(missing_docs, clippy::unwrap_used)]

use std::path::{Path, PathBuf};

use farsa_body::Pose;
use farsa_body::kinematics::KinematicTree;
use farsa_body::robot::Robot;
use farsa_models::mjcf::{self, MjcfOptions};
use farsa_models::{Imported, Meshes, ReadOptions, Repair, self_contained, urdf};
use serde_json::Value;

/// The tolerance of a body's pose against the other program [m, and parts of the unit quaternion].
const PLACES: f64 = 1e-6;
/// The tolerance of masses, inertias and joints, relative to the largest of a kind.
const NUMBERS: f64 = 1e-6;

fn list(value: &Value) -> Vec<f64> {
    value.as_array().unwrap().iter().map(|x| x.as_f64().unwrap()).collect()
}

/// Returns the options for a model: strict, unless its masses or meshes need more.
fn options(folder: &Path, how: &str) -> ReadOptions {
    let repair = Repair { least_mass: 1e-6, least_inertia: 1e-9, balance: true };
    ReadOptions {
        packages: vec![folder.join("cmeel.prefix/share")],
        meshes: if how.contains("leave") { Meshes::Leave } else { Meshes::Fit },
        repair: if how.contains("repair") { repair } else { Repair::default() },
        // So that the bodies themselves have their masses to the last digits.
        between: 1e-9,
        ..ReadOptions::default()
    }
}

fn close(what: &str, found: &[f64], ours: &[f64], tolerance: f64, worst: &mut f64) {
    assert_eq!(found.len(), ours.len(), "{what}");
    let size = ours.iter().fold(0.0_f64, |size, x| size.max(x.abs())).max(1e-12);
    for (a, b) in found.iter().zip(ours) {
        *worst = worst.max((a - b).abs() / size);
        assert!((a - b).abs() <= tolerance * size, "{what}: theirs {found:?}, ours {ours:?}");
    }
}

/// Limits, armatures and damping, as far as the other program reports them.
fn joints(name: &str, model: &Value, robot: &Robot, worst: &mut f64) {
    let theirs = model["joints"].as_object().unwrap();
    assert_eq!(theirs.len(), robot.joints().count(), "{name}: joints");
    for (joint, numbers) in theirs {
        let id = robot.joint(joint).unwrap_or_else(|| panic!("{name}: joint {joint}"));
        let ours = &robot.segments[id.index()].joint;
        let numbers = list(numbers);
        let (rest, range) = if model["bodies"].is_object() { numbers.split_at(2) } else { numbers.split_at(0) };
        if let [armature, damping] = rest {
            let damping = if model["how"] == "springs" { ours.damping } else { *damping };
            close(&format!("{name}: {joint}"), &[*armature, damping], &[ours.armature, ours.damping], NUMBERS, worst);
        }
        if range.iter().any(|x| x.abs() < 1e9) {
            close(&format!("{name}: range of {joint}"), range, &ours.range, NUMBERS, worst);
        } else {
            assert!(ours.range.iter().all(|x| x.is_infinite()), "{name}: {joint} has no range");
        }
    }
}

/// Masses, centers and inertias, in the frames of the file's bodies.
fn masses(name: &str, model: &Value, reading: &Imported, worst: &mut f64) {
    for (body, numbers) in model["bodies"].as_object().unwrap() {
        let frame = reading.frame(body).unwrap_or_else(|| panic!("{name}: body {body}"));
        let segment = &reading.robot.segments[frame.body.unwrap().index()];
        // The frame has no turn in its segment's, only a shift.
        let back = Pose::at(frame.placement.position.map(|x| -x));
        let ours = segment.mass_properties().placed(&back);
        let numbers = list(numbers);
        close(&format!("{name}: mass of {body}"), &numbers[..1], &[ours.mass], NUMBERS, worst);
        if ours.mass > 0.0 {
            let size = 1.0_f64.max(ours.centre.iter().fold(0.0, |size, x| x.abs().max(size)));
            for k in 0..3 {
                assert!(
                    (numbers[1 + k] - ours.centre[k]).abs() <= NUMBERS * size,
                    "{name}: centre of {body}: {numbers:?} {ours:?}"
                );
            }
            close(&format!("{name}: inertia of {body}"), &numbers[4..], &ours.inertia, NUMBERS, worst);
        }
    }
}

fn places(name: &str, model: &Value, reading: &Imported, worst: &mut f64) -> usize {
    let tree = KinematicTree::new(&reading.robot).unwrap();
    let mut compared = 0;
    for posture in model["postures"].as_array().unwrap() {
        let theirs = &posture["q"];
        let q: Vec<f64> = tree
            .joints()
            .iter()
            .map(|joint| theirs[reading.robot.segments[joint.index()].joint.name.as_str()].as_f64().unwrap())
            .collect();
        let poses = tree.poses(&q);
        for (body, place) in posture["bodies"].as_object().unwrap() {
            let frame = reading.frame(body).unwrap_or_else(|| panic!("{name}: body {body}"));
            let pose = frame.body.map_or(Pose::identity(), |body| poses[body.index()]).compose(&frame.placement);
            let place = list(place);
            // A quaternion and its negative are one rotation.
            let same: f64 = place[3..].iter().zip(&pose.rotation).map(|(a, b)| a * b).sum();
            let ours = pose.position.into_iter().chain(pose.rotation.map(|x| x * same.signum()));
            for (a, b) in place.iter().zip(ours) {
                *worst = worst.max((a - b).abs());
                assert!((a - b).abs() <= PLACES, "{name}: {body} is at {place:?}, ours at {pose:?}");
            }
            compared += 1;
        }
    }
    compared
}

/// The text without files has the same robot, to rounding.
fn without_files(path: &Path, options: &ReadOptions, robot: &Robot) {
    let name = path.display();
    let text = self_contained(path, options).unwrap_or_else(|error| panic!("{name}: {error}")).text;
    let alone = ReadOptions { packages: Vec::new(), meshes: Meshes::Leave, ..options.clone() };
    let again = Imported::from_text(&text, &alone).unwrap_or_else(|error| panic!("{name}: {error}")).robot;
    assert_eq!(again.colliders.len(), robot.colliders.len(), "{name}");
    for (a, b) in again.colliders.iter().zip(&robot.colliders) {
        assert_eq!((&a.name, a.body), (&b.name, b.body), "{name}");
        let far = (0..3).map(|k| (a.placement.position[k] - b.placement.position[k]).abs()).fold(0.0, f64::max);
        assert!(far < 1e-9, "{name}: {a:?} {b:?}");
    }
    assert_eq!(again.segments.len(), robot.segments.len(), "{name}");
    for (a, b) in again.segments.iter().zip(&robot.segments) {
        let difference = (a.mass - b.mass).abs() + (0..6).map(|k| (a.inertia[k] - b.inertia[k]).abs()).sum::<f64>();
        assert!(difference <= 1e-12 * b.mass.max(1.0) && a.joint == b.joint, "{name}: {a:?} {b:?}");
    }
}

#[test]
#[ignore = "reads models that are fetched: ./ci test"]
fn models_of_others_are_what_other_programs_read_in_them() {
    let Some(folder) = std::env::var_os("FARSA_MODELS").map(PathBuf::from) else {
        let in_ci = std::env::var_os("CI").is_some_and(|value| value == "true");
        assert!(!in_ci, "FARSA_MODELS is not set; `./ci test` fetches the models and sets it");
        eprintln!("skipped: models_of_others_are_what_other_programs_read_in_them (set FARSA_MODELS)");
        return;
    };
    let fixture = Path::new(concat!(env!("CARGO_MANIFEST_DIR"), "/tests/fixtures/models.json"));
    let all: Value = serde_json::from_str(&std::fs::read_to_string(fixture).unwrap()).unwrap();
    let models = all["models"].as_object().unwrap();
    assert!(models.len() >= 10);
    let (mut worst_place, mut worst_number, mut compared) = (0.0_f64, 0.0_f64, 0);
    for (name, model) in models {
        let options = options(&folder, model["how"].as_str().unwrap());
        let reading = Imported::from_file(folder.join(name), &options).unwrap_or_else(|error| panic!("{error}"));
        compared += places(name, model, &reading, &mut worst_place);
        joints(name, model, &reading.robot, &mut worst_number);
        if model["bodies"].is_object() {
            masses(name, model, &reading, &mut worst_number);
        }
        if options.meshes == Meshes::Fit {
            without_files(&folder.join(name), &options, &reading.robot);
        }
        // The result can be written, and read again.
        for text in
            [mjcf::write(&reading.robot, &MjcfOptions::default()).unwrap(), urdf::write(&reading.robot).unwrap()]
        {
            let again =
                Imported::from_text(&text, &ReadOptions::default()).unwrap_or_else(|error| panic!("{name}: {error}"));
            assert_eq!(again.robot.joints().count(), reading.robot.joints().count(), "{name}");
        }
    }
    println!("{} models, {compared} places, worst {worst_place:.1e}; worst number {worst_number:.1e}", models.len());
}
