//! Which dynamics step is small enough for `reach-grasp-lift`: errors against 0.1 ms in double precision.
//!
//! Prints the table in docs/results/reach-grasp-lift.md and fails if the default step does not hold the bounds. These are 1 degree
//! RMS in every arm joint over 1 s of smooth muscle commands, the resting sphere within 0.1 mm, the scripted grasp from all four
//! starts, and an order of at least 0.9.

use std::process::ExitCode;
use std::sync::Arc;

use farsa_body::ports::{Actuated, ActuatorId, Arrange, World as _};
use farsa_body::robot::Robot;
use farsa_body::robots::Tabletop;
use farsa_body::{Pose, Twist};
use farsa_experiments::reach_grasp_lift::{Config, Scene, ScriptEpisode, TRIALS, Timetable};
use farsa_lab::EpisodeId;
use farsa_lab::advanced::run_episode;
use farsa_num::{Domain, Stream, sin_cos};
use farsa_physics::articulated::{Model, Options, Precision, World};

/// Different smooth commands that are tried.
const MOTIONS: u32 = 12;

fn options(config: &Config, substeps: u32) -> Options {
    Options { substeps, ..config.options() }
}

/// J1..J7 [deg] after each control step of 1 s of sinusoidal activations between 0.5 and 2 Hz, without contacts.
fn motion<R: Precision>(robot: &Robot, config: &Config, substeps: u32, seed: u32) -> Vec<[f64; 7]> {
    let mut world = World::new(Model::<R>::new(robot, &options(config, substeps)).expect("a model"));
    let mut stream = Stream::new(1, Domain::Motor, 0, 0, seed);
    let waves: Vec<[f64; 2]> = (0..14).map(|_| [0.5 + 1.5 * stream.uniform_f64(), stream.uniform_f64()]).collect();
    let mut path = Vec::new();
    for step in 0..100 {
        let activation = |wave: [f64; 2]| {
            let turns = wave[0] * 0.01 * f64::from(step) + wave[1];
            (0.5 + 0.4 * sin_cos(core::f64::consts::TAU * turns).0) as f32
        };
        for joint in 0..7_u16 {
            let at = 2 * usize::from(joint);
            world.command(ActuatorId(joint), [activation(waves[at]), activation(waves[at + 1])]);
        }
        world.step();
        path.push(core::array::from_fn(|j| world.positions()[j].to_f64().to_degrees()));
    }
    path
}

fn rms(a: &[[f64; 7]], b: &[[f64; 7]]) -> f64 {
    (0..7)
        .map(|j| {
            let sum: f64 = a.iter().zip(b).map(|(x, y)| (x[j] - y[j]) * (x[j] - y[j])).sum();
            farsa_num::Scalar::sqrt(sum / a.len() as f64)
        })
        .fold(0.0, f64::max)
}

/// The sphere's center after 5 s at rest [m].
fn rest<R: Precision>(scene: &Scene, substeps: u32) -> [f64; 3] {
    let model = Model::<R>::new(&scene.robot, &options(&scene.config, substeps)).expect("a model");
    let mut world = World::new(model);
    let at = [0.25, 0.1, scene.config.sphere_radius as f32];
    world.place_body(Tabletop::SPHERE, Pose::at(at), Twist::default());
    world.place_joint(farsa_body::ports::JointId(1), 1.0, 0.0);
    world.finish_placement();
    for joint in 0..7_u16 {
        world.command(ActuatorId(joint), [0.0, 0.6]);
    }
    for _ in 0..500 {
        world.step();
    }
    world.pose_of(Tabletop::SPHERE).position.map(farsa_num::Real::to_f64)
}

fn grasps(config: &Config, substeps: u32) -> usize {
    let config = Config { substeps, ..config.clone() };
    let scene = Arc::new(Scene::new(config).expect("a scene"));
    let model = Model::<f32>::new(&scene.robot, &scene.config.options()).expect("a model");
    let mut world = World::new(model);
    let mut episode = ScriptEpisode::new(Arc::clone(&scene), Timetable::default()).expect("a script");
    (0..TRIALS)
        .filter(|trial| {
            let id = EpisodeId { seed: 2010, generation: 0, individual: 0, trial: *trial as u32 };
            run_episode(&mut episode, &mut world, id, None);
            episode.judge().succeeds()
        })
        .count()
}

fn main() -> ExitCode {
    let config = Config::default();
    let scene = Scene::new(config.clone()).expect("a scene");
    let mut free = scene.robot.clone();
    free.pairs.clear();
    let truth: Vec<_> = (0..MOTIONS).map(|seed| motion::<f64>(&free, &config, 100, seed)).collect();
    let still = rest::<f64>(&scene, 100);
    println!(
        "| step [ms] | largest RMS error of an arm joint [deg] | order | resting sphere off by [mm] | scripted grasps |"
    );
    println!("|---|---|---|---|---|");
    let mut fails = false;
    for substeps in [2_u32, 4, 5, 10] {
        let error = |substeps| {
            (0..MOTIONS)
                .map(|seed| rms(&motion::<f32>(&free, &config, substeps, seed), &truth[seed as usize]))
                .fold(0.0, f64::max)
        };
        // The truth's own error, a tenth of a millisecond's, shows in the order of the smallest steps.
        let (here, half) = (error(substeps), error(2 * substeps));
        let order = farsa_num::ln(here / half) / farsa_num::ln(2.0);
        let at = rest::<f32>(&scene, substeps);
        let off = (0..3).map(|k| (at[k] - still[k]).abs()).fold(0.0, f64::max) * 1e3;
        let held = grasps(&config, substeps);
        println!("| {} | {here:.3} | {order:.2} | {off:.5} | {held} of {TRIALS} |", 10.0 / f64::from(substeps));
        if substeps == config.options().substeps {
            fails = here > 1.0 || off > 0.1 || held < TRIALS || order < 0.9;
        }
    }
    println!("default: {} ms", 10.0 / f64::from(config.options().substeps));
    if fails { ExitCode::FAILURE } else { ExitCode::SUCCESS }
}
