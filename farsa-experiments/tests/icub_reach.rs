//! `icub-reach`: all targets can be reached, a script reaches them, and lanes change nothing.
#![allow(missing_docs, clippy::unwrap_used)]

mod common;

use std::sync::Arc;

use farsa_body::ports::{
    Actuated as _, ActuatorId, Arrange as _, Contacts as _, JointId, Joints as _, Kinematics as _, PairId, World as _,
};
use farsa_experiments::icub_reach::{
    Condition, Config, ReachEpisode, Reacher, Reaching, Scene, Script, evaluator, grid, outside,
};
use farsa_lab::{Episode as _, EpisodeId};
use farsa_num::{Domain, Stream};
use farsa_physics::articulated::{Model, World};

const CONDITIONS: [Condition; 2] = [Condition::Steady, Condition::Velocity];

fn world_of(scene: &Scene) -> World<f32> {
    World::new(Model::new(&scene.robot, &scene.options()).unwrap())
}

/// The deepest contact \[m\], 0 where nothing touches.
fn depth(world: &World<f32>) -> f32 {
    let pairs = (0..world.pairs()).map(|pair| world.pair_contact(PairId(pair as u16)));
    pairs.filter(|contact| contact.points > 0).fold(0.0, |most, contact| most.max(contact.depth))
}

/// Runs a trial. Returns the mean distance at its end \[m\] and the deepest contact in it \[m\].
fn run<C: Reacher>(episode: &mut ReachEpisode<C>, world: &mut World<f32>, id: EpisodeId) -> (f64, f32) {
    episode.start(world, id);
    let mut deepest = 0.0_f32;
    loop {
        episode.act(world);
        world.step();
        deepest = deepest.max(depth(world));
        if episode.judge(world).is_some() {
            return (episode.totals().mean(), deepest);
        }
    }
}

fn id(trial: u32) -> EpisodeId {
    EpisodeId { seed: 11, trial, ..EpisodeId::default() }
}

/// Inverse kinematics by the six joints has angles for all of the volume, and a little beyond. Held there, nothing touches.
#[test]
fn all_of_the_volume_can_be_reached() {
    let scene = Scene::new(Config::for_condition(Condition::Steady)).unwrap();
    let script = Script::new(&scene).unwrap();
    let mut world = world_of(&scene);
    let volume = scene.config.volume;
    let drawn = (0..2000).map(|trial| scene.target(id(trial)));
    let places = grid(&volume).into_iter().chain(outside(&volume).into_iter().map(|(_, place)| place)).chain(drawn);
    let names = farsa_experiments::icub_reach::CONTROLLED;
    let joints: Vec<JointId> = names.iter().map(|name| scene.robot.joint(name).unwrap()).collect();
    let actuators: Vec<ActuatorId> = names.iter().map(|name| scene.robot.actuator(name).unwrap()).collect();
    let (mut missed, mut touched) = (Vec::new(), Vec::new());
    for place in places {
        let Ok(angles) = script.angles(place) else {
            missed.push(place);
            continue;
        };
        for (i, angle) in angles.iter().enumerate() {
            let [low, high] = scene.ranges()[i];
            assert!((low..=high).contains(angle));
        }
        scene.arrange(&mut world);
        for ((joint, actuator), angle) in joints.iter().zip(&actuators).zip(angles) {
            world.place_joint(*joint, angle as f32, 0.0);
            world.command(*actuator, [angle as f32, 0.0]);
        }
        world.finish_placement();
        world.step();
        if depth(&world) > 0.0 {
            touched.push(place);
        }
    }
    assert!(
        missed.is_empty() && touched.is_empty(),
        "{} missed: {missed:.2?}\n{} touch: {touched:.2?}",
        missed.len(),
        touched.len()
    );
}

#[test]
fn a_script_reaches_the_targets_under_both_conditions() {
    for condition in CONDITIONS {
        let scene = Arc::new(Scene::new(Config::for_condition(condition)).unwrap());
        let mut world = world_of(&scene);
        let mut episode = ReachEpisode::new(Arc::clone(&scene), Script::new(&scene).unwrap());
        let (mut reached, mut farthest, mut deepest, mut sum) = (0, 0.0_f64, 0.0_f32, 0.0);
        for trial in 0..200 {
            let (distance, depth) = run(&mut episode, &mut world, id(trial));
            reached += u32::from(distance < 0.01);
            (farthest, deepest, sum) = (farthest.max(distance), deepest.max(depth), sum + distance);
            assert!((0.0..=1.0).contains(&episode.fitness()));
        }
        println!(
            "{condition:?}: {reached} of 200, mean {:.4} m, at most {farthest:.4} m, contacts of {deepest:.4} m",
            sum / 200.0
        );
        assert!(reached >= 190, "{condition:?}: {reached} of 200");
        assert!(deepest < 0.003, "{condition:?}: {deepest} m");
    }
}

/// After a jump the script reaches the second target. The distance of that target counts.
#[test]
fn a_script_follows_a_target_that_jumps() {
    for condition in CONDITIONS {
        let scene = Arc::new(Scene::new(Config::for_condition(condition)).unwrap());
        let mut world = world_of(&scene);
        let mut episode = ReachEpisode::new(Arc::clone(&scene), Script::new(&scene).unwrap());
        episode.ask(Reaching { jump: Some(100), ..Reaching::default() });
        for trial in 0..20 {
            let (distance, _) = run(&mut episode, &mut world, id(trial));
            assert_eq!(episode.target(), scene.two_targets(id(trial))[1]);
            assert!(distance < 0.02, "{condition:?}: {distance} m");
        }
    }
}

/// With a locked trunk its joints stay where they are.
#[test]
fn a_locked_torso_stays() {
    for condition in CONDITIONS {
        let scene = Arc::new(Scene::new(Config::for_condition(condition)).unwrap());
        let mut world = world_of(&scene);
        let mut episode = ReachEpisode::new(Arc::clone(&scene), Script::new(&scene).unwrap());
        let [pitch, yaw] = ["torso_pitch", "torso_yaw"].map(|name| scene.robot.joint(name).unwrap());
        let mut turned = [false, true].map(|locked_torso| {
            episode.ask(Reaching { locked_torso, ..Reaching::default() });
            (0..20).fold(0.0_f32, |most, trial| {
                run(&mut episode, &mut world, id(trial));
                most.max(world.position(pitch).abs()).max(world.position(yaw).abs())
            })
        });
        turned[1] *= 2.0;
        assert!(turned[0] > turned[1] && turned[1] < 0.1, "{condition:?}: {turned:?} rad");
    }
}

/// Fitness is 1 less the mean distance over the last 2 s in parts of that at the start, or when the target jumped.
#[test]
fn fitness_is_what_the_last_two_seconds_say() {
    for (condition, jump) in CONDITIONS.into_iter().flat_map(|condition| [(condition, None), (condition, Some(180))]) {
        let scene = Arc::new(Scene::new(Config::for_condition(condition)).unwrap());
        let mut world = world_of(&scene);
        let babble = Babble(Stream::new(5, Domain::Motor, 0, 0, 0), 0);
        let mut episode = ReachEpisode::new(Arc::clone(&scene), babble);
        episode.ask(Reaching { jump, ..Reaching::default() });
        for trial in 0..10 {
            let targets = scene.two_targets(id(trial));
            episode.start(&mut world, id(trial));
            let mut distances = Vec::new();
            let fitness = loop {
                let after = distances.len() as u32;
                let target = targets[usize::from(jump.is_some_and(|jump| after >= jump))];
                let palm = world.pose(Scene::PALM).cast::<f64>().transform(scene.palm_centre);
                distances.push((0..3).map(|k| (palm[k] - target[k]) * (palm[k] - target[k])).sum::<f64>().sqrt());
                episode.act(&mut world);
                world.step();
                if let Some(fitness) = episode.judge(&mut world) {
                    break fitness;
                }
            };
            // The distance after the last step. The others are of the previous step.
            distances.push(episode.totals().last());
            assert_eq!(distances.len(), 201);
            let begin = jump.unwrap_or(0) as usize;
            let window = &distances[161.max(begin + 1)..];
            let mean = window.iter().sum::<f64>() / window.len() as f64;
            let expected = 1.0 - (mean / distances[begin].max(0.3)).min(1.0);
            assert!((fitness - expected).abs() < 1e-9, "{condition:?}, {jump:?}: {fitness}, not {expected}");
        }
    }
}

/// A load on the hand is like a heavier palm once the robot is at rest. Under `velocity` the script brings it to the target.
#[test]
fn a_load_weighs_what_a_heavier_palm_does() {
    const LOAD: f64 = 0.5;
    for condition in CONDITIONS {
        let scene = Scene::new(Config::for_condition(condition)).unwrap();
        let mut heavier = scene.clone();
        let palm = &mut heavier.robot.segments[Scene::PALM.index()];
        let whole = palm.mass + LOAD;
        palm.centre = [0, 1, 2].map(|k| (palm.mass * palm.centre[k] + LOAD * scene.palm_centre[k]) / whole);
        palm.mass = whole;
        let ends = [(scene.clone(), 0.0), (scene, LOAD), (heavier, 0.0)].map(|(scene, load)| {
            // The script has no information on the load in any of the three.
            let script = Script::new(&Scene::new(scene.config).unwrap()).unwrap();
            let scene = Arc::new(scene);
            let mut world = world_of(&scene);
            let mut episode = ReachEpisode::new(scene, script);
            episode.ask(Reaching { load, ..Reaching::default() });
            let trial = |trial| (run(&mut episode, &mut world, id(trial)).0, episode.hand());
            (0..50).map(trial).collect::<Vec<(f64, [f64; 3])>>()
        });
        let mean = ends.each_ref().map(|ends| ends.iter().map(|end| end.0).sum::<f64>() / 50.0);
        let most = ends.each_ref().map(|ends| ends.iter().map(|end| end.0).fold(0.0, f64::max));
        println!("{condition:?}: {mean:.4?} m, at most {most:.4?} m");
        for ((_, free), ((_, loaded), (_, heavier))) in ends[0].iter().zip(ends[1].iter().zip(&ends[2])) {
            let apart = |a: &[f64; 3], b: &[f64; 3]| (0..3).map(|k| (a[k] - b[k]).abs()).fold(0.0, f64::max);
            assert!(apart(loaded, heavier) < 0.001, "{condition:?}: {loaded:?}, {heavier:?}");
            assert!(condition == Condition::Velocity || apart(loaded, free) > 0.001, "{loaded:?}, {free:?}");
        }
        assert!(condition == Condition::Steady || most[1] < 0.01, "{most:?} m");
    }
}

/// The default's dynamics steps are short enough: with steps of 1 ms a script ends where it does.
#[test]
fn shorter_steps_come_to_the_same() {
    for condition in CONDITIONS {
        let default = Config::for_condition(condition);
        let ends = [default.substeps, 50].map(|substeps| {
            let config = Config { substeps, ..default };
            let scene = Arc::new(Scene::new(config).unwrap());
            let mut world = world_of(&scene);
            let mut episode = ReachEpisode::new(Arc::clone(&scene), Script::new(&scene).unwrap());
            (0..10)
                .map(|trial| {
                    run(&mut episode, &mut world, id(trial));
                    episode.hand()
                })
                .collect::<Vec<_>>()
        });
        for (one, other) in ends[0].iter().zip(&ends[1]) {
            let apart = (0..3).map(|k| (one[k] - other[k]).abs()).fold(0.0, f64::max);
            assert!(apart < 0.001, "{condition:?}: {apart} m");
        }
    }
}

/// Does at random what can be done.
struct Babble(Stream, u32);

impl Reacher for Babble {
    fn reset(&mut self) {
        self.1 = 0;
    }
    fn step(&mut self, _: &[f32; 3], _: &[f32; 6], y: &mut [f32; 6]) {
        if self.1.is_multiple_of(10) {
            *y = core::array::from_fn(|_| self.0.uniform());
        }
        self.1 += 1;
    }
}

#[test]
fn random_commands_stay_within_bounds() {
    for condition in CONDITIONS {
        let scene = Arc::new(Scene::new(Config::for_condition(condition)).unwrap());
        let mut world = world_of(&scene);
        let babble = Babble(Stream::new(3, Domain::Motor, 0, 0, 0), 0);
        let mut episode = ReachEpisode::new(Arc::clone(&scene), babble);
        let (mut fastest, mut deepest) = (0.0_f32, 0.0_f32);
        for trial in 0..10 {
            episode.start(&mut world, id(trial));
            let mut ended = None;
            while ended.is_none() {
                episode.act(&mut world);
                world.step();
                fastest = scene.robot.joints().fold(fastest, |most, joint| most.max(world.speed(joint).abs()));
                deepest = deepest.max(depth(&world));
                ended = episode.judge(&mut world);
            }
            assert!((0.0..=1.0).contains(&ended.unwrap()));
        }
        println!("{condition:?}: {fastest} rad/s, {deepest} m");
        assert!(fastest < 20.0 && deepest < 0.005, "{condition:?}: {fastest} rad/s, {deepest} m");
    }
}

#[test]
fn trials_and_cases_in_lanes_are_those_alone() {
    for condition in CONDITIONS {
        let mut evaluator = evaluator(Config { steps: 60, ..Config::for_condition(condition) }).unwrap();
        common::assert_lanes_are_alone(&mut evaluator, 45, 20);
    }
}

/// Targets are those of all individuals, and new ones in each generation unless the settings keep them.
#[test]
fn targets_are_drawn_for_a_generation() {
    let config = Config::for_condition(Condition::Steady);
    let target = |same_targets: bool, generation: u32, individual: u32| {
        let scene = Scene::new(Config { same_targets, ..config }).unwrap();
        scene.target(EpisodeId { generation, individual, ..id(3) })
    };
    assert_eq!(target(false, 1, 0), target(false, 1, 5));
    assert_ne!(target(false, 1, 0), target(false, 2, 0));
    assert_eq!(target(true, 1, 0), target(true, 2, 0));
}
