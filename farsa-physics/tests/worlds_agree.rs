//! One suite of scenes in all worlds that answer the ports, beside MuJoCo (fixtures/worlds); docs/agreement.md has the table
//! that `cargo test -p farsa-physics --features rapier --test worlds_agree -- --nocapture` prints, and the reason for each gap.
#![allow(missing_docs, clippy::unwrap_used)]

mod common;
mod scenes;

use std::collections::BTreeMap;
use std::fs;
use std::path::Path;

use farsa_physics::articulated::{Model, Options, Precision, World};
use scenes::{Scene, TIME_STEP, scenes};
use serde::Deserialize;

/// What MuJoCo made of a scene: rows at its model's step and at a 25th of it.
#[derive(Deserialize)]
struct Reading {
    own: Vec<Vec<f64>>,
    fine: Vec<Vec<f64>>,
}

#[derive(Deserialize)]
struct Readings {
    /// Control steps between two rows.
    every: usize,
    scenes: BTreeMap<String, Reading>,
}

/// How far a world is from another: at most over the way, and at the end.
#[derive(Clone, Copy, PartialEq, Debug)]
struct Gap([f64; 2]);

impl Gap {
    fn between(rows: &[Vec<f64>], others: &[Vec<f64>]) -> Self {
        assert_eq!(rows.len(), others.len());
        let off = |(row, other): (&Vec<f64>, &Vec<f64>)| {
            assert_eq!(row.len(), other.len());
            // NaN must not be taken for agreement.
            row.iter().zip(other).map(|(a, b)| (a - b).abs()).fold(0.0, |most: f64, x| if x <= most { most } else { x })
        };
        let off: Vec<f64> = rows.iter().zip(others).map(off).collect();
        let most = off.iter().fold(0.0, |most: f64, x| if *x <= most { most } else { *x });
        Self([most, *off.last().unwrap()])
    }

    fn text(self) -> String {
        format!("{}, {}", short(self.0[0]), short(self.0[1]))
    }
}

/// Two digits.
fn short(x: f64) -> String {
    if x == 0.0 { "0".into() } else { format!("{x:.1e}") }
}

fn fixtures() -> &'static Path {
    Path::new(concat!(env!("CARGO_MANIFEST_DIR"), "/tests/fixtures/worlds"))
}

fn readings() -> Readings {
    serde_json::from_str(&fs::read_to_string(fixtures().join("readings.json")).unwrap()).unwrap()
}

/// Our world, with so many dynamics steps per control step.
fn ours<R: Precision>(scene: &Scene, substeps: u32) -> World<R> {
    World::new(Model::new(&scene.robot, &Options { time_step: TIME_STEP, substeps, ..Options::default() }).unwrap())
}

/// The rows that are kept of those of all control steps.
fn kept(rows: &[Vec<f64>], every: usize) -> Vec<Vec<f64>> {
    rows.iter().skip(every - 1).step_by(every).cloned().collect()
}

/// The worlds of the table, in its order; the others' tolerances follow from these.
const WORLDS: [&str; 6] = ["f64", "f32 beside f64", "f64, 0.1 ms", "rapier", "rapier, 0.1 ms", "MuJoCo, 2.5 ms"];

/// A scene, and how far each world may be from MuJoCo's limit (f32: from f64): over the way, at the end.
struct Allowed {
    scene: &'static str,
    gaps: [[f64; 2]; 6],
}

const ALLOWED: [Allowed; 0] = [];

/// All gaps of a scene; rapier's are missing without the feature.
fn gaps(scene: &Scene, reading: &Reading, every: usize) -> [Option<Gap>; 6] {
    let rows = |rows: Vec<Vec<f64>>| kept(&rows, every);
    let own = rows(scene.play(&mut ours::<f64>(scene, 4)));
    let single = rows(scene.play(&mut ours::<f32>(scene, 4)));
    let fine = rows(scene.play(&mut ours::<f64>(scene, 100)));
    let [rapier, finer] = rapier(scene).map(|found| found.map(|found| Gap::between(&rows(found), &reading.fine)));
    [
        Some(Gap::between(&own, &reading.fine)),
        Some(Gap::between(&single, &own)),
        Some(Gap::between(&fine, &reading.fine)),
        rapier,
        finer,
        Some(Gap::between(&reading.own, &reading.fine)),
    ]
}

#[cfg(feature = "rapier")]
fn rapier(scene: &Scene) -> [Option<Vec<Vec<f64>>>; 2] {
    use farsa_physics::rapier;
    [4, 100].map(|substeps| {
        let options = rapier::Options { time_step: TIME_STEP, substeps, ..rapier::Options::default() };
        Some(scene.play(&mut rapier::World::new(&scene.robot, &options).unwrap()))
    })
}

#[cfg(not(feature = "rapier"))]
fn rapier(_: &Scene) -> [Option<Vec<Vec<f64>>>; 2] {
    [None, None]
}

#[test]
fn the_worlds_agree() {
    let readings = readings();
    println!("| scene | {} |\n|{}", WORLDS.join(" | "), "---|".repeat(WORLDS.len() + 1));
    let mut beyond = Vec::new();
    for scene in scenes() {
        let found = gaps(&scene, &readings.scenes[scene.name], readings.every);
        let cells = found.map(|gap| gap.map_or_else(|| "not built".into(), Gap::text));
        println!("| {} [{}] | {} |", scene.name, scene.unit, cells.join(" | "));
        let Some(allowed) = ALLOWED.iter().find(|allowed| allowed.scene == scene.name) else {
            beyond.push(format!("{}: no tolerance", scene.name));
            continue;
        };
        for ((world, gap), allowed) in WORLDS.into_iter().zip(found).zip(allowed.gaps) {
            if let Some(Gap([way, end])) = gap
                && !(way <= allowed[0] && end <= allowed[1])
            {
                beyond.push(format!("{}, {world}: {way:e}, {end:e} where {allowed:?} is allowed", scene.name));
            }
        }
    }
    assert!(beyond.is_empty(), "{beyond:#?}");
}

/// The committed models and timetables; new ones are put beside the tests' other files for whoever meant the change.
#[test]
fn the_scenes_are_the_committed_ones() {
    let scenes = scenes();
    let tables: Vec<String> = scenes.iter().map(|scene| serde_json::to_string(&scene.timetable()).unwrap()).collect();
    let mut files = BTreeMap::from([("scenes.json".to_owned(), format!("[\n{}\n]\n", tables.join(",\n")))]);
    files.extend(scenes.iter().map(|scene| (format!("{}.xml", scene.model), scene.mjcf())));
    let mut others = Vec::new();
    for (name, made) in files {
        if fs::read_to_string(fixtures().join(&name)).unwrap_or_default() != made {
            let new = Path::new(env!("CARGO_TARGET_TMPDIR")).join(name);
            fs::write(&new, made).unwrap();
            others.push(new);
        }
    }
    assert!(others.is_empty(), "these are the new ones, see tests/fixtures/worlds/README.md: {others:?}");
}
