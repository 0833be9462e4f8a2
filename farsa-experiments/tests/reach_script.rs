//! The task can be done: a script that uses only the experiment's 23 outputs grasps and lifts from each of the four starts.
#![allow(missing_docs, clippy::unwrap_used)]

use std::sync::Arc;

use farsa_body::ports::{Kinematics, World as _};
use farsa_body::robots::ArmAndHand;
use farsa_experiments::reach_grasp_lift::{Config, Phase, Rewards, Scene, ScriptEpisode, TRIALS, Timetable, Trial};
use farsa_lab::{Episode, EpisodeId};
use farsa_physics::articulated::{Model, Precision, World};

struct Grasp {
    trial: Trial,
    success: bool,
    /// The sphere's center in the palm's frame after each step [m].
    relative: Vec<[f64; 3]>,
    /// The largest activation of a muscle.
    activation: f32,
}

fn grasp<R: Precision>(config: Config, timetable: Timetable, id: EpisodeId) -> Grasp {
    let scene = Arc::new(Scene::new(config).expect("a scene"));
    let mut world = World::new(Model::<R>::new(&scene.robot, &scene.config.options()).expect("a model"));
    let mut episode = ScriptEpisode::new(Arc::clone(&scene), timetable).expect("a script");
    episode.start(&mut world, id);
    assert!(episode.plan().is_some(), "the sphere is out of reach");
    let (mut relative, mut activation) = (Vec::new(), 0.0_f32);
    let mut end = None;
    while end.is_none() {
        episode.act(&mut world);
        world.step();
        end = Episode::judge(&mut episode, &mut world);
        let palm = world.pose(ArmAndHand::PALM).cast::<f64>();
        relative.push(palm.transform_back(scene.sphere_centre(&world)));
        activation = episode.done()[..14].iter().fold(activation, |most, a| most.max(*a));
    }
    Grasp { trial: *episode.judge().trial(), success: episode.judge().succeeds(), relative, activation }
}

/// Speed of the sphere in the palm over the last steps: from end to end, and the root mean square of the steps [mm/s].
fn slip(relative: &[[f64; 3]], steps: usize) -> [f64; 2] {
    let last = &relative[relative.len() - steps - 1..];
    let way = |a: &[f64; 3], b: &[f64; 3]| 1000.0 * (0..3).map(|k| (a[k] - b[k]) * (a[k] - b[k])).sum::<f64>().sqrt();
    let squares: f64 = last.windows(2).map(|w| way(&w[0], &w[1]) * way(&w[0], &w[1])).sum();
    [way(&last[0], &last[steps]) / (0.01 * steps as f64), (squares / steps as f64).sqrt() / 0.01]
}

fn id(trial: usize, generation: u32) -> EpisodeId {
    EpisodeId { seed: 2010, generation, individual: 0, trial: trial as u32 }
}

/// Six seconds of the script, then more to hold: slips less than 1 mm/s over the last 3 s, in both precisions.
fn holds<R: Precision>() {
    for trial in 0..TRIALS {
        let config = Config { steps: 800, ..Config::default() };
        let grasp = grasp::<R>(config, Timetable::default(), id(trial, 0));
        let [mean, rms] = slip(&grasp.relative, 300);
        let Trial { phase, held, highest, .. } = grasp.trial;
        println!(
            "start {}: {phase:?}, held {held} steps, {highest:.2} cm, slip {mean:.3} rms {rms:.3} mm/s",
            trial + 1
        );
        assert!(grasp.success && phase == Phase::Lift, "{:?}", grasp.trial);
        assert!(mean < 1.0 && rms < 1.0, "slips {mean} mm/s, rms {rms} mm/s");
    }
}

#[test]
fn holds_for_three_seconds_from_every_start() {
    holds::<f32>();
}

#[test]
fn holds_for_three_seconds_in_double_precision() {
    holds::<f64>();
}

#[test]
fn scores_3000_over_the_four_trials() {
    let mut sum = Rewards::default();
    for trial in 0..TRIALS {
        let grasp = grasp::<f32>(Config::default(), Timetable::default(), id(trial, 0));
        assert_eq!(grasp.trial.steps, 600);
        assert!(grasp.success, "start {}: {:?}", trial + 1, grasp.trial);
        sum.add(&grasp.trial.rewards);
    }
    println!("{sum:?} F = {:.1}", sum.total());
    assert!(sum.total() >= 3000.0, "F = {}", sum.total());
}

#[test]
fn succeeds_from_displaced_starts() {
    let (mut slips, mut activation) = (0.0_f64, 0.0_f32);
    for generation in 1..=10 {
        for trial in 0..TRIALS {
            let grasp = grasp::<f32>(Config::default(), Timetable::default(), id(trial, generation));
            assert!(grasp.success, "start {}, generation {generation}: {:?}", trial + 1, grasp.trial);
            slips = slips.max(slip(&grasp.relative, 100)[0]);
            activation = activation.max(grasp.activation);
        }
    }
    println!("40 displaced starts: largest slip {slips:.3} mm/s, largest activation {activation:.2}");
    assert!(slips < 1.0);
}

/// The script survives what should not matter much: other spheres, weaker or stronger fingers, less and more friction.
#[test]
fn does_not_depend_on_one_set_of_values() {
    let default = Config::default();
    let variants = [
        ("20 g", Config { sphere_mass: 0.020, ..default.clone() }),
        ("100 g", Config { sphere_mass: 0.100, ..default.clone() }),
        ("300 g", Config { sphere_mass: 0.300, ..default.clone() }),
        ("friction 0.4", Config { friction: 0.4, ..default.clone() }),
        ("friction 1.5", Config { friction: 1.5, ..default.clone() }),
        ("cap 0.1 N m", Config { servo_force: 100.0, ..default.clone() }),
        ("cap 1 N m", Config { servo_force: 1000.0, ..default.clone() }),
        ("4 substeps", Config { substeps: 4, ..default.clone() }),
        ("10 substeps", Config { substeps: 10, ..default.clone() }),
    ];
    let mut failed = Vec::new();
    for (name, config) in variants {
        for trial in 0..TRIALS {
            let grasp = grasp::<f32>(config.clone(), Timetable::default(), id(trial, 0));
            let [mean, rms] = slip(&grasp.relative, 100);
            println!("{name}, start {}: {:?} slip {mean:.3} rms {rms:.3} mm/s", trial + 1, grasp.success);
            if !grasp.success {
                failed.push((name, trial, grasp.trial));
            }
        }
    }
    assert!(failed.is_empty(), "{failed:#?}");
}

/// Without friction nothing holds: it is the fingers that lift, not the solver.
#[test]
fn nothing_holds_without_friction() {
    let config = Config { friction: 0.0, ..Config::default() };
    for trial in 0..TRIALS {
        let grasp = grasp::<f32>(config.clone(), Timetable::default(), id(trial, 0));
        println!("start {} without friction: {:?}", trial + 1, grasp.trial);
        assert!(!grasp.success, "start {}: {:?}", trial + 1, grasp.trial);
    }
}
