//! One suite of scenes in all worlds with the ports, compared with MuJoCo (fixtures/worlds). The table in
//! docs/agreement.md is printed by `cargo test -p farsa-physics --features rapier --test worlds_agree -- --nocapture`.
#![allow(missing_docs, clippy::unwrap_used)]

mod common;
mod scenes;

use std::collections::BTreeMap;
use std::fs;
use std::path::Path;

use farsa_physics::articulated::{Model, Options, Precision, World};
use scenes::{Scene, TIME_STEP, scenes};
use serde::Deserialize;

/// MuJoCo's results of a scene: rows at its model's step and at a 25th of it.
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

/// The difference of two worlds: the largest over the way, and the final one.
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

/// Plays a scene in our world, with `substeps` dynamics steps per control step.
fn ours<R: Precision>(scene: &Scene, substeps: u32) -> World<R> {
    World::new(Model::new(&scene.robot, &Options { time_step: TIME_STEP, substeps, ..Options::default() }).unwrap())
}

/// The rows that are kept of those of all control steps.
fn kept(rows: &[Vec<f64>], every: usize) -> Vec<Vec<f64>> {
    rows.iter().skip(every - 1).step_by(every).cloned().collect()
}

/// The worlds of the table, in its order. The others' tolerances follow from these.
const WORLDS: [&str; 7] =
    ["f64", "f32 beside f64", "f64, 0.1 ms", "rapier", "rapier, 0.1 ms", "MuJoCo", "MuJoCo, 0.1 ms"];

/// A scene, and how far each world may be from the formula or else MuJoCo's limit (f32: from f64): over the way, at the end.
struct Allowed {
    scene: &'static str,
    gaps: [[f64; 2]; 7],
}

/// Half as much again as was measured, and at least 1e-7.
const ALLOWED: [Allowed; 12] = [
    Allowed {
        scene: "pendulum",
        gaps: [
            [1.5e-2, 7.4e-3],
            [1.2e-6, 1.2e-6],
            [1e-7, 1e-7],
            [1.5e-2, 7.4e-3],
            [3.3e-6, 3.2e-6],
            [1.5e-2, 7.4e-3],
            [1e-7, 1e-7],
        ],
    },
    Allowed {
        scene: "double pendulum",
        gaps: [
            [1.8e-2, 1.8e-2],
            [2.6e-6, 4.8e-7],
            [1e-7, 1e-7],
            [5.3e-2, 1.7e-2],
            [2.3e-3, 9.6e-4],
            [1.8e-2, 1.8e-2],
            [1e-7, 1e-7],
        ],
    },
    Allowed {
        scene: "arm swing",
        gaps: [
            [2.1e-3, 1.8e-3],
            [6.3e-7, 4.5e-7],
            [4.5e-7, 1e-7],
            [2.3e-3, 2.3e-3],
            [3.9e-5, 3.3e-5],
            [2.1e-3, 1.8e-3],
            [1e-7, 1e-7],
        ],
    },
    Allowed {
        scene: "servo step",
        gaps: [
            [1.7e-2, 9.3e-6],
            [6.3e-7, 3.6e-7],
            [1.7e-3, 2.9e-7],
            [1.7e-2, 1.4e-5],
            [1.5e-3, 3.5e-5],
            [2.9e-2, 1.4e-6],
            [1e-7, 1e-7],
        ],
    },
    Allowed {
        scene: "unequal activations",
        gaps: [
            [2.1e-3, 6.6e-4],
            [1.1e-6, 1.1e-6],
            [4.4e-7, 1.4e-7],
            [2e-3, 6.2e-4],
            [5.6e-5, 5.1e-6],
            [2.1e-3, 6.6e-4],
            [1e-7, 1e-7],
        ],
    },
    Allowed {
        scene: "drop",
        gaps: [
            [3.5e-3, 1e-7],
            [1e-7, 1e-7],
            [3.6e-3, 1e-7],
            [2.1e-3, 1.8e-5],
            [3.5e-3, 1.8e-5],
            [2.7e-3, 1e-7],
            [1e-7, 1e-7],
        ],
    },
    Allowed {
        scene: "roll",
        gaps: [
            [5.9e-4, 5.9e-4],
            [2.7e-6, 2.7e-6],
            [7.2e-5, 7.2e-5],
            [6e-4, 6e-4],
            [2.7e-4, 2.7e-4],
            [2.4e-3, 2.4e-3],
            [3.9e-5, 3.9e-5],
        ],
    },
    Allowed {
        scene: "slide",
        gaps: [
            [1.3e-3, 1.3e-3],
            [2.7e-5, 2.7e-5],
            [3e-5, 3e-5],
            [5e-3, 5e-3],
            [5.7e-5, 5.7e-5],
            [2.7e-3, 2.7e-3],
            [2.3e-2, 2.3e-2],
        ],
    },
    Allowed {
        scene: "push",
        gaps: [
            [3.9e-4, 1.3e-4],
            [2e-6, 2e-6],
            [3.9e-4, 1.1e-4],
            [3.9e-4, 9.8e-5],
            [3.9e-4, 1.2e-4],
            [3.9e-4, 1.1e-4],
            [1e-7, 1e-7],
        ],
    },
    Allowed {
        scene: "pinch",
        gaps: [
            [9.6e-5, 9.6e-5],
            [1.8e-6, 1.8e-6],
            [9.8e-5, 9.8e-5],
            [1.2e-4, 2.9e-5],
            [9.8e-5, 9.8e-5],
            [8.7e-5, 8.7e-5],
            [1e-7, 1e-7],
        ],
    },
    Allowed {
        scene: "power grasp",
        gaps: [
            [8.4e-3, 8.4e-3],
            [1.4e-4, 5.9e-5],
            [6.8e-3, 6.8e-3],
            [9.6e-3, 9.6e-3],
            [4.5e-3, 4.1e-3],
            [8.9e-4, 8.9e-4],
            [1e-7, 1e-7],
        ],
    },
    Allowed {
        scene: "lift",
        gaps: [
            [9.6e-3, 8.7e-3],
            [3e-5, 2e-5],
            [8.6e-3, 8.6e-3],
            [5.1e-3, 3.8e-3],
            [4.2e-3, 4.2e-3],
            [1.3e-3, 1.1e-3],
            [1e-7, 1e-7],
        ],
    },
];

/// All gaps of a scene. Rapier's are missing without the feature.
fn gaps(scene: &Scene, reading: &Reading, every: usize) -> [Option<Gap>; 7] {
    let rows = |rows: Vec<Vec<f64>>| kept(&rows, every);
    let own = rows(scene.play(&mut ours::<f64>(scene, 4)));
    let single = rows(scene.play(&mut ours::<f32>(scene, 4)));
    let fine = rows(scene.play(&mut ours::<f64>(scene, 100)));
    let truth = match scene.formula {
        Some(formula) => (1..=own.len()).map(|row| formula((row * every) as f64 * TIME_STEP)).collect(),
        None => reading.fine.clone(),
    };
    let off = |found: &[Vec<f64>]| Some(Gap::between(found, &truth));
    let [rapier, finer] = rapier(scene).map(|found| found.and_then(|found| off(&rows(found))));
    let [theirs, limit] = [off(&reading.own), off(&reading.fine)];
    [off(&own), Some(Gap::between(&single, &own)), off(&fine), rapier, finer, theirs, limit]
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

/// The committed models and timetables. New ones are written next to the tests' other files, for an intended change.
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
