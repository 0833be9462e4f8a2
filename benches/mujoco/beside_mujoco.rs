//! Our side of the comparison with MuJoCo. It records four phases, steps them, and prints times or joint angles. It
//! also plays scripts in either engine and prints the results.
//!
//! `record FOLDER`, `time|trace PHASE.txt STEPS_PER_10_MS SECONDS`, `lanes PHASE.txt STEPS_PER_10_MS SECONDS 8|16`,
//! `grasps STARTS seen|blind CM STEPS_PER_10_MS`, `rest|press STEPS_PER_10_MS`. The last three take the program
//! `step_mujoco` and a model for MuJoCo as well. The script `run` in this folder calls it.
#![allow(missing_docs)]

mod drive;
mod engine;
#[cfg(target_arch = "x86_64")]
mod in_lanes;
mod outcome;
mod phase;
mod record;

use std::fmt::Write as _;
use std::path::Path;
use std::sync::Arc;
use std::time::Instant;

use engine::{Engine, Ours, Theirs};
use farsa::body::ports::{Contacts, PairId, Snapshot, World as _};
use farsa::body::robots::{ArmAndHand, Tabletop};
use farsa::num::Scalar;
use farsa::physics::articulated::{Precision, World};
use farsa_experiments::reach_grasp_lift::{Config, Scene};
use phase::{Failure, MUSCLES, Phase, command, world};

/// The number of steps before the slip of the sphere is measured, because the phase begins without the contacts'
/// impulses.
const SETTLED: usize = 20;

/// The sphere's center in the palm's frame [m].
fn held<R: Precision>(world: &World<R>) -> [f64; 3] {
    let place = world.pose_of(ArmAndHand::PALM).cast::<f64>();
    place.transform_back(world.pose_of(Tabletop::SPHERE).cast::<f64>().position)
}

/// Measures microseconds per control step, touching pairs and points, the slip of the sphere in the hand [mm], and its
/// height [mm].
fn time<R: Precision>(scene: &Scene, phase: &Phase, substeps: u32, seconds: f64) -> Result<(), Failure> {
    let mut world = world::<R>(scene, substeps, phase.contacts)?;
    phase.place(&mut world);
    let mut start = vec![0.0; world.snapshot_len()];
    world.save(&mut start);
    let mut first = held(&world);
    let (mut points, mut pairs) = (0, 0);
    for (tick, words) in phase.commands.iter().enumerate() {
        command(&mut world, words);
        world.step();
        if tick + 1 == SETTLED {
            first = held(&world);
        }
        for pair in (0..world.pairs()).map(|pair| PairId(pair as u16)).filter(|pair| world.touches(*pair)) {
            pairs += 1;
            points += world.pair_contact(pair).points;
        }
    }
    let (last, height) = (held(&world), world.pose_of(Tabletop::SPHERE).position[2].to_f64());
    let slip: f64 = (0..3).map(|k| (last[k] - first[k]) * (last[k] - first[k])).sum();
    // Other programs interrupt: the least of a control step's repetitions is its own time.
    let mut least = vec![f64::INFINITY; phase.commands.len()];
    let begin = Instant::now();
    while begin.elapsed().as_secs_f64() < seconds {
        world.restore(&start);
        for (words, least) in phase.commands.iter().zip(&mut least) {
            let begin = Instant::now();
            command(&mut world, words);
            world.step();
            *least = least.min(begin.elapsed().as_secs_f64());
        }
    }
    let n = phase.commands.len() as f64;
    let (points, pairs) = (f64::from(points) / n, f64::from(pairs) / n);
    println!(
        "{:.4} {points:.2} {pairs:.1} {:.4} {:.3}",
        least.iter().sum::<f64>() / n * 1e6,
        Scalar::sqrt(slip) * 1e3,
        height * 1e3
    );
    Ok(())
}

fn trace<R: Precision>(scene: &Scene, phase: &Phase, substeps: u32) -> Result<(), Failure> {
    let mut world = world::<R>(scene, substeps, phase.contacts)?;
    phase.place(&mut world);
    let mut text = String::new();
    for words in &phase.commands {
        command(&mut world, words);
        world.step();
        for q in &world.positions()[..MUSCLES] {
            let _ = write!(text, "{:?} ", q.to_f64().to_degrees());
        }
        text.push('\n');
    }
    print!("{text}");
    Ok(())
}

/// A script in one engine.
fn play<E: Engine>(scene: &Arc<Scene>, engine: &mut E, script: &[&str]) -> Result<(), Failure> {
    match *script {
        ["grasps", starts, knowledge] => outcome::grasps(scene, engine, starts.parse()?, knowledge == "blind"),
        ["rest"] => outcome::rest(scene, engine),
        ["press"] => outcome::press(scene, engine),
        _ => Err("grasps STARTS seen|blind, rest or press".into()),
    }
}

/// Plays a script in our engine, or in MuJoCo where its program and model are given.
fn play_in(scene: &Arc<Scene>, script: &[&str], substeps: u32, theirs: &[&str]) -> Result<(), Failure> {
    match *theirs {
        [] => play(scene, &mut Ours::new(scene, substeps)?, script),
        [program, model] => play(scene, &mut Theirs::new(scene, substeps, program, model)?, script),
        _ => Err("a program and a model".into()),
    }
}

fn main() -> Result<(), Failure> {
    let arguments: Vec<String> = std::env::args().skip(1).collect();
    let arguments: Vec<&str> = arguments.iter().map(String::as_str).collect();
    let scene = Arc::new(Scene::new(Config::default())?);
    match arguments[..] {
        // An argument of `cargo bench`, which measures nothing here.
        [.., "--bench"] => {
            println!("benches/mujoco/run measures");
            Ok(())
        }
        ["record", folder] => record::record(&scene, Path::new(folder)),
        ["time", phase, substeps, seconds] => {
            time::<f32>(&scene, &Phase::read(Path::new(phase))?, substeps.parse()?, seconds.parse()?)
        }
        ["trace", phase, substeps] => trace::<f32>(&scene, &Phase::read(Path::new(phase))?, substeps.parse()?),
        #[cfg(target_arch = "x86_64")]
        ["lanes", phase, substeps, seconds, lanes] => {
            in_lanes::time(&scene, &Phase::read(Path::new(phase))?, substeps.parse()?, seconds.parse()?, lanes)
        }
        ["grasps", starts, knowledge, centimetres, substeps, ref theirs @ ..] => {
            let config = Config { sphere_displacement: centimetres.parse()?, ..Config::default() };
            let scene = Arc::new(Scene::new(config)?);
            play_in(&scene, &["grasps", starts, knowledge], substeps.parse()?, theirs)
        }
        [script @ ("rest" | "press"), substeps, ref theirs @ ..] => {
            play_in(&scene, &[script], substeps.parse()?, theirs)
        }
        ["trace", phase, substeps, "f64"] => trace::<f64>(&scene, &Phase::read(Path::new(phase))?, substeps.parse()?),
        _ => Err(
            "record FOLDER | time PHASE STEPS SECONDS | lanes PHASE STEPS SECONDS 8|16 | trace PHASE STEPS [f64] | \
                  grasps STARTS seen|blind CM STEPS [PROGRAM MODEL] | rest|press STEPS [PROGRAM MODEL]"
                .into(),
        ),
    }
}
