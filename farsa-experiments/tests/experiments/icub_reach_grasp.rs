//! `icub-reach-grasp`: a script grasps the ball wherever it lies, the head follows it, and lanes change nothing.

use std::sync::Arc;

use farsa_body::Pose;
use farsa_body::motors::{HeadTracking, ServoRange};
use farsa_body::ports::{Contacts as _, JointId, Joints as _, PairId, World as _};
use farsa_body::robots::Icub;
use farsa_experiments::icub_reach_grasp::{
    Area, CELLS, Config, GraspEpisode, Grasper, Lifting, MOTORS, SENSORS, Scene, Script, Senses, evaluator,
};
use farsa_lab::exports::{Exports as _, SensorReading};
use farsa_lab::{Episode as _, EpisodeId, Task as _};
use farsa_num::{Domain, Stream};
use farsa_physics::articulated::{Model, World};

fn world_of(scene: &Scene) -> World<f32> {
    World::new(Model::new(&scene.robot, &scene.options()).unwrap())
}

fn scene() -> Arc<Scene> {
    Arc::new(Scene::new(Config::default()).unwrap())
}

/// The deepest contact \[m\], 0 where nothing touches.
fn depth(world: &World<f32>) -> f32 {
    let pairs = (0..world.pairs()).map(|pair| world.pair_contact(PairId(pair as u16)));
    pairs.filter(|contact| contact.points > 0).fold(0.0, |most, contact| most.max(contact.depth))
}

fn id(trial: u32) -> EpisodeId {
    EpisodeId { seed: 11, trial, ..EpisodeId::default() }
}

/// Runs a trial, and the deepest contact in it \[m\].
fn run<C: Grasper>(episode: &mut GraspEpisode<C>, world: &mut World<f32>, id: EpisodeId) -> f32 {
    episode.start(world, id);
    let mut deepest = 0.0_f32;
    loop {
        episode.act(world);
        world.step();
        deepest = deepest.max(depth(world));
        if episode.judge(world).is_some() {
            return deepest;
        }
    }
}

/// The numbers of trials and of successes of a script, with `trials` in each cell of the area.
fn grasped(config: &Config, cells: [u32; 2], trials: u32) -> (u32, u32) {
    let scene = Arc::new(Scene::new(*config).unwrap());
    let mut world = world_of(&scene);
    let mut episode = GraspEpisode::new(Arc::clone(&scene), Script::new(&scene).unwrap()).unwrap();
    let mut succeeded = 0;
    for cell in (0..cells[0]).flat_map(|x| (0..cells[1]).map(move |y| [x, y])) {
        episode.ask(Lifting { cell: Some([cell, cells]), ..Lifting::default() });
        for trial in 0..trials {
            run(&mut episode, &mut world, id(trial));
            succeeded += u32::from(episode.succeeds());
        }
    }
    (succeeded, cells[0] * cells[1] * trials)
}

/// The figures of docs/decisions/20-icub.md.
#[test]
fn a_lower_table_and_short_steps_are_needed() {
    let with = |substeps: u32, table_top: f64| grasped(&Config { substeps, table_top, ..Config::default() }, CELLS, 2);
    let all = [with(5, -0.08), with(10, -0.08), with(40, -0.08), with(10, 0.075)];
    println!("10 ms, 5 ms, 1.25 ms, and a table 10 cm below the shoulder: {all:?}");
    let [long, own, short, high] = all.map(|(succeeded, all)| f64::from(succeeded) / f64::from(all));
    assert!(own >= 0.95 && short >= 0.95 && long < own, "{all:?}");
    assert!(high < 0.5, "{all:?}");
}

#[test]
fn a_script_grasps_the_ball_nearly_everywhere() {
    let scene = scene();
    let mut world = world_of(&scene);
    let mut episode = GraspEpisode::new(Arc::clone(&scene), Script::new(&scene).unwrap()).unwrap();
    let (mut succeeded, mut deepest, mut all) = (0, 0.0_f32, 0);
    let mut terms = [0.0; 3];
    for x in 0..CELLS[0] {
        let mut line = String::new();
        for y in 0..CELLS[1] {
            episode.ask(Lifting { cell: Some([[x, y], CELLS]), ..Lifting::default() });
            for trial in 0..8 {
                deepest = deepest.max(run(&mut episode, &mut world, id(trial)));
                let up = episode.succeeds();
                all += 1;
                succeeded += u32::from(up);
                line.push(match (up, episode.grasper().has_found()) {
                    (true, _) => 'o',
                    (false, true) => 'x',
                    (false, false) => '-',
                });
                if up {
                    let own = episode.terms();
                    assert!(own.iter().all(|term| (0.0..=1.0).contains(term)));
                    terms = [0, 1, 2].map(|k| terms[k] + own[k]);
                    // A lifted ball was neither thrown nor pressed through.
                    assert!(episode.seen().height < 0.25, "{:?}", episode.seen());
                    assert!(episode.seen().opposition > 0.5, "{:?}", episode.seen());
                }
            }
            line.push(' ');
        }
        println!("{line}");
    }
    let mean = terms.map(|sum| sum / f64::from(succeeded));
    println!("{succeeded} of {all}, terms {mean:.3?}, contacts of {deepest:.4} m");
    assert!(100 * succeeded >= 95 * all, "{succeeded} of {all}");
    assert!(mean[0] > 0.6 && mean[1] > 0.8 && mean[2] > 0.9, "{mean:?}");
    assert!(deepest < 0.005, "{deepest} m");
}

/// Does nothing, with the trunk turned about its vertical.
struct Turned(f32);

impl Grasper for Turned {
    fn start(&mut self, _: [f64; 3]) {}
    fn step(&mut self, _: &[f32; SENSORS], y: &mut [f32; MOTORS]) {
        *y = [0.5; MOTORS];
        y[1] = self.0;
    }
}

/// The head keeps the ball within two degrees of the middle of the left eye's image, for all places of the ball and turns of the
/// trunk, as far as the neck bends. Without the reflex it does not.
#[test]
fn the_head_follows_the_ball() {
    for tracking in [true, false] {
        let scene = Arc::new(Scene::new(Config { tracking, ..Config::default() }).unwrap());
        let mut world = world_of(&scene);
        let eye = (Icub::HEAD, Pose::at(Icub::EYES[0].map(|x| x as f32)));
        let any = ServoRange { servo: scene.actuator("neck_yaw").unwrap(), from: -1.0, to: 1.0 };
        let gaze = HeadTracking::new(eye, (Scene::BALL, [0.0; 3]), [any; 2], [0.0; 2], 1.0, 1.0).unwrap();
        let mut farthest = 0.0_f32;
        for (trial, turn) in [(0, 0.5), (3, 0.6), (8, 0.4), (11, 0.5)] {
            let mut episode = GraspEpisode::new(Arc::clone(&scene), Turned(turn)).unwrap();
            episode.start(&mut world, id(trial));
            for _ in 0..60 {
                episode.act(&mut world);
                world.step();
                let _ = episode.judge(&mut world);
            }
            let angles = gaze.angles(&world).unwrap();
            println!("tracking {tracking}, trial {trial}: {angles:?} rad");
            // At its limit the head cannot look farther down.
            let [lowest, _] = scene.range("neck_pitch").unwrap();
            let pitch = f64::from(world.position(scene.joint("neck_pitch").unwrap()));
            let bent = tracking && pitch < lowest + 0.02 && angles[1] < 0.0;
            farthest = farthest.max(angles[0].abs()).max(if bent { 0.0 } else { angles[1].abs() });
        }
        assert!(if tracking { farthest < 0.035 } else { farthest > 0.1 }, "{tracking}: {farthest} rad");
    }
}

/// Does at random what can be done.
struct Babble(Stream, u32);

impl Grasper for Babble {
    fn start(&mut self, _: [f64; 3]) {
        self.1 = 0;
    }
    fn step(&mut self, _: &[f32; SENSORS], y: &mut [f32; MOTORS]) {
        if self.1.is_multiple_of(10) {
            *y = core::array::from_fn(|_| self.0.uniform());
        }
        self.1 += 1;
    }
}

#[test]
fn random_commands_stay_within_bounds() {
    let scene = scene();
    let mut world = world_of(&scene);
    let babble = Babble(Stream::new(3, Domain::Motor, 0, 0, 0), 0);
    let mut episode = GraspEpisode::new(Arc::clone(&scene), babble).unwrap();
    let table = scene.config.tabletop();
    let (mut fastest, mut deepest, mut ball) = (0.0_f32, 0.0_f32, 0.0_f64);
    for trial in 0..24 {
        episode.start(&mut world, id(trial));
        let mut ended = None;
        while ended.is_none() {
            episode.act(&mut world);
            let before = episode.seen().ball;
            world.step();
            fastest = scene.robot.joints().fold(fastest, |most, joint: JointId| most.max(world.speed(joint).abs()));
            deepest = deepest.max(depth(&world));
            ended = episode.judge(&mut world);
            let now = episode.seen().ball;
            let above =
                |[x, y, _]: [f64; 3]| (x > table.table_x[0] && x < table.table_x[1]) && y.abs() < table.table_y[1];
            assert!(!above(now) || now[2] > table.table_top, "through the table: {now:?}");
            let way = (0..3).map(|k| (now[k] - before[k]) * (now[k] - before[k])).sum::<f64>().sqrt();
            ball = ball.max(way / scene.config.time_step);
        }
        assert!((0.0..=3.0).contains(&ended.unwrap()));
    }
    println!("joints {fastest} rad/s, contacts {deepest} m, ball {ball} m/s");
    // The deepest are of a ball that the arm presses on the table with more than 500 N.
    assert!(fastest < 70.0 && deepest < 0.02 && ball < 10.0, "{fastest} rad/s, {deepest} m, {ball} m/s");
}

/// The inputs can be computed by hand: offsets in the image, joints between limits, touch.
#[test]
fn senses_are_those_by_hand() {
    let scene = scene();
    let mut world = world_of(&scene);
    let mut episode = GraspEpisode::new(Arc::clone(&scene), Script::new(&scene).unwrap()).unwrap();
    episode.start(&mut world, id(2));
    let mut senses = Senses::new(&scene).unwrap();
    let mut touched = [false; SENSORS];
    for step in 0..250 {
        episode.act(&mut world);
        world.step();
        let _ = episode.judge(&mut world);
        let mut x = [f32::NAN; SENSORS];
        senses.start(id(0), 0.0);
        senses.read(&world, &mut x);
        for (i, name) in ["neck_pitch", "neck_yaw", "torso_pitch", "torso_yaw"].into_iter().enumerate() {
            let [low, high] = scene.range(name).unwrap();
            let q = f64::from(world.position(scene.joint(name).unwrap()));
            assert!((f64::from(x[2 + i]) - (q - low) / (high - low)).abs() < 1e-5);
        }
        for (was, x) in touched[6..].iter_mut().zip(&x[6..]) {
            assert!(*x == 0.0 || *x == 1.0);
            *was |= *x == 1.0;
        }
        assert!(x[11..].iter().sum::<f32>() <= 1.0, "{step}: {x:?}");
        if step == 40 {
            // The hand is near the ball but above it and to the right.
            assert!(x[1] < 0.0 && x[0].abs() < 1.0 && x[1] > -1.0, "{x:?}");
        }
        // Noise changes the offsets alone.
        let mut noisy = [f32::NAN; SENSORS];
        senses.start(id(0), 0.05);
        senses.read(&world, &mut noisy);
        assert_eq!(noisy[2..], x[2..]);
        assert!((0..2).all(|i| noisy[i] != x[i] && (noisy[i] - x[i]).abs() <= 0.05));
    }
    assert!(episode.succeeds());
    // Thumb, one of the other fingertips and the palm feel a ball that is grasped.
    println!("{touched:?}");
    assert!(touched[6] && touched[7..11].iter().any(|x| *x) && touched[11..].iter().any(|x| *x), "{touched:?}");
}

#[test]
fn trials_and_cases_in_lanes_are_those_alone() {
    let mut evaluator = evaluator(Config { steps: 60, ..Config::default() }).unwrap();
    crate::common::assert_lanes_are_alone(&mut evaluator, 30, 12);
}

/// Exported descriptions of the sensors have the agent's values: offsets and touches as they are, angles by their limits.
#[test]
fn exported_sensors_mean_what_is_sensed() {
    let mut evaluator = evaluator(Config::default()).unwrap();
    let (task, _) = evaluator.parts_mut();
    let parameters = vec![0.0; task.info().parameters.len()];
    let export = task.controller(&parameters).unwrap();
    let ends: Vec<[f64; 2]> = export
        .sensors
        .iter()
        .map(|sensor| match &sensor.reads {
            SensorReading::Quantity { zero, one, .. } => [*zero, *one],
            other => panic!("{other:?}"),
        })
        .collect();
    let names = ["neck_pitch", "neck_yaw", "torso_pitch", "torso_yaw"];
    let limits = names.map(|name| task.episode().scene().range(name).unwrap());
    assert_eq!((ends.len(), &ends[..2], &ends[2..6]), (SENSORS, &[[0.0, 1.0]; 2][..], &limits[..]));
    assert!(ends[6..].iter().all(|ends| *ends == [0.0, 1.0]));
    assert!(task.controller(&parameters[1..]).is_none());
}

/// Twelve trials have a part of the area each, shared by all individuals, others in each generation.
#[test]
fn places_are_drawn_for_a_generation() {
    let scene = scene();
    let Config { area_centre, area_size, .. } = scene.config;
    let mut parts = Vec::new();
    for trial in 0..12 {
        let place = scene.place(id(trial));
        assert_eq!(place, scene.place(EpisodeId { individual: 5, ..id(trial) }));
        assert_ne!(place, scene.place(EpisodeId { generation: 2, ..id(trial) }));
        let share = [0, 1].map(|k| (place[k] - area_centre[k]) / area_size[k] + 0.5);
        assert!(share.iter().all(|x| (0.0..=1.0).contains(x)));
        parts.push([(3.0 * share[0]) as u32, (4.0 * share[1]) as u32]);
    }
    let expected: Vec<[u32; 2]> = (0..12).map(|trial| [trial / 4, trial % 4]).collect();
    assert_eq!(parts, expected);
}

#[test]
fn conditions_differ_in_the_area_of_training_and_not_in_what_is_tested() {
    let scenes = Area::NAMES.map(|name| Scene::new(Config::for_area(Area::from_name(name))).unwrap());
    for (scene, size) in scenes.iter().zip([0.4, 0.2, 0.1]) {
        let places: Vec<[f64; 2]> =
            (0..120).map(|trial| scene.place(EpisodeId { generation: trial, ..id(trial) })).collect();
        for axis in 0..2 {
            let most =
                places.iter().map(|place| (place[axis] - scene.config.area_centre[axis]).abs()).fold(0.0, f64::max);
            assert!(most < 0.5 * size && most > 0.4 * size, "{most} of {size}");
        }
        for cell in [[0, 0], [1, 2], [3, 3]] {
            assert_eq!(scene.place_in(id(5), cell, CELLS), scenes[0].place_in(id(5), cell, CELLS));
        }
    }
}
