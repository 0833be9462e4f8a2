//! Masses of meshes, and primitives around them, as in MuJoCo 4.0.0 (fixtures/meshes.py).

use std::fs;
use std::path::Path;

use farsa_body::Pose;
use farsa_body::robot::Shape;
use farsa_models::{Imported, ReadOptions};
use serde_json::Value;

use crate::{fixture, message};

fn list(value: &Value) -> Vec<f64> {
    value.as_array().unwrap().iter().map(|x| x.as_f64().unwrap()).collect()
}

/// Sizes of our shape and its center, in MuJoCo's order. Cylinders and ellipsoids have become other shapes.
fn sizes(shape: &Shape, kind: &str) -> Option<Vec<f64>> {
    match (shape, kind) {
        (Shape::Sphere { radius }, "sphere") => Some(vec![*radius]),
        (Shape::Capsule { radius, half_length }, "capsule") => Some(vec![*radius, *half_length]),
        (Shape::Box { half }, "box") => Some(half.to_vec()),
        (_, "cylinder" | "ellipsoid" | "mesh") => None,
        other => panic!("{other:?}"),
    }
}

#[test]
fn masses_and_primitives_of_meshes_are_those_of_mujoco() {
    let all: Value = serde_json::from_str(&fixture("meshes.json")).unwrap();
    let folder = Path::new(env!("CARGO_TARGET_TMPDIR")).join("meshes");
    fs::create_dir_all(&folder).unwrap();
    let (mut hulls, mut primitives) = (0, 0);
    for (name, case) in all.as_object().unwrap() {
        for (file, text) in case["files"].as_object().unwrap() {
            fs::write(folder.join(file), text.as_str().unwrap()).unwrap();
        }
        let text = case["text"].as_str().unwrap();
        let read = Imported::from_text(text, &ReadOptions { root: Some(folder.clone()), ..ReadOptions::default() });
        if text.contains("inertia=\"convex\"") || !text.contains("file=") {
            hulls += 1;
            if cfg!(not(feature = "parry")) {
                assert!(read.unwrap_err().to_string().contains("the feature `parry`"), "{name}");
                continue;
            }
        }
        let robot = read.unwrap_or_else(|error| panic!("{name}: {error}")).robot;
        let ours = robot.segments[0].mass_properties();
        let ours: Vec<f64> = [ours.mass].into_iter().chain(ours.centre).chain(ours.inertia).collect();
        let theirs = list(&case["body"]);
        let size = theirs[4] + theirs[5] + theirs[6];
        for (k, (a, b)) in ours.iter().zip(&theirs).enumerate() {
            // MuJoCo finds the axes of an inertia to 1e-12 at density 1.
            let tolerance = [1e-9 * theirs[0], 1e-9, 1e-8 * size][k.min(1) + usize::from(k > 3)];
            assert!((a - b).abs() < tolerance, "{name}: {ours:?}, MuJoCo's {theirs:?}");
        }
        let kind = name.split(' ').next().unwrap().split('.').next().unwrap();
        let geom = list(&case["geom"]);
        if let Some(sizes) = (!geom.is_empty()).then(|| sizes(&robot.colliders[0].shape, kind)).flatten() {
            primitives += 1;
            assert!(sizes.iter().zip(&geom).all(|(a, b)| (a - b).abs() < 1e-9), "{name}: {sizes:?} {geom:?}");
            let at = robot.colliders[0].placement.position;
            assert!((0..3).all(|k| (at[k] - geom[3 + k]).abs() < 1e-9), "{name}: {at:?} {geom:?}");
        }
    }
    assert_eq!((hulls, primitives), (18, 18));
}

#[test]
fn meshes_without_the_mass_that_they_need_are_refused() {
    let text = |mesh: &str| {
        let geom = "<worldbody><body><joint/><geom type='mesh' mesh='m'/></body></worldbody>";
        format!("<mujoco><asset><mesh name='m' {mesh}/></asset>\n{geom}</mujoco>")
    };
    let points = "vertex='0 0 0 1 0 0 0 1 0 0 0 1'";
    let outwards = "face='0 2 1 0 1 3 0 3 2 1 2 3'";
    for (mesh, why) in [
        (
            format!("{points} face='0 1 2 0 3 1 0 2 3 1 3 2' inertia='exact'"),
            "its volume is negative, so its triangles face inwards",
        ),
        (
            format!("{points} face='0 1 2 0 1 3 0 3 2 1 2 3' inertia='exact'"),
            "its triangles do not all face outwards, so that it has no exact mass",
        ),
        (
            "vertex='0 0 0 1 0 0 0 1 0 1 1 0' face='0 1 2 1 3 2'".into(),
            "its volume is too small for a mass; inertia=\"shell\" gives it that of its surface",
        ),
    ] {
        assert_eq!(message(&text(&mesh)), format!("text line 2: \"m\": {why}"));
    }
    #[cfg(feature = "parry")]
    assert!(
        message(&text("vertex='0 0 0 1 0 0 0 1 0 1 1 0'"))
            .ends_with("its points are in a plane, which has no convex hull")
    );
    let solid =
        Imported::from_text(&text(&format!("{points} {outwards} inertia='exact'")), &ReadOptions::default()).unwrap();
    assert!((solid.robot.segments[0].mass - 1000.0 / 6.0).abs() < 1e-12);
    let shell = "vertex='0 0 0 1 0 0 0 1 0 1 1 0' face='0 1 2 1 3 2' inertia='shell'";
    let shell = Imported::from_text(&text(shell), &ReadOptions::default()).unwrap().robot;
    // A square plate of 1000 kg: m a^2 / 12 about its edges' directions, twice that about z.
    let plate = shell.segments[0].mass_properties();
    assert!((plate.mass - 1000.0).abs() < 1e-9 && (plate.inertia[2] - 1000.0 / 6.0).abs() < 1e-9, "{plate:?}");
    assert_eq!(Pose::at(plate.centre), Pose::at([0.5, 0.5, 0.0]));
}
