//! The world of rapier with NaN, with damaged snapshots, and under random commands.

use crate::common;
use crate::common::{Babble, POSES, SPHERES, commands, drive, scene, stream};
use farsa_body::ports::{
    Actuated, ActuatorId, Arrange, BodyId, Contacts, JointId, Joints, Kinematics, PairId, Snapshot, World as _,
};
use farsa_body::robot::{Collider, MassProperties, Robot, RobotError, Shape};
use farsa_body::robots::{ArmAndHand, Tabletop};
use farsa_body::{Pose, Twist};
use farsa_physics::articulated::ModelError;
use farsa_physics::rapier::{Options, RapierError, World};

const EPISODE_STEPS: usize = 600;

fn saved(world: &World) -> Vec<f32> {
    let mut words = vec![0.0; world.snapshot_len()];
    world.save(&mut words);
    words
}

type Damage = fn(&mut World);

#[test]
fn a_broken_world_tells_nan_and_is_cured() {
    let robot = scene();
    let fresh = World::new(&robot, &Options::default()).unwrap();
    let damages: [(&str, Damage); 5] = [
        ("a command", |w| w.command(ActuatorId(3), [f32::NAN, 0.0])),
        ("an endless command", |w| w.command(ActuatorId(9), [0.0, f32::INFINITY])),
        ("a joint", |w| w.place_joint(JointId(2), f32::NAN, 0.0)),
        ("a joint's speed", |w| w.place_joint(JointId(2), 0.0, f32::INFINITY)),
        ("the sphere", |w| {
            let pose = Pose::at([f32::NAN, 0.0, 1.0]);
            w.place_body(Tabletop::SPHERE, pose, Twist::default());
        }),
    ];
    for (name, damage) in damages {
        let mut world = fresh.clone();
        damage(&mut world);
        world.finish_placement();
        for _ in 0..3 {
            world.step();
        }
        if name == "an endless command" {
            // A servo reads the first number only.
            assert!(world.is_finite());
            continue;
        }
        assert!(!world.is_finite(), "{name}");
        let (pose, twist) = (world.pose(Tabletop::SPHERE), world.velocity(BodyId(5)));
        assert!(pose.position[0].is_nan() && pose.rotation[3].is_nan() && twist.angular[1].is_nan(), "{name}");
        assert!(world.position(JointId(0)).is_nan() && world.speed(JointId(20)).is_nan(), "{name}");
        let broken = saved(&world);
        world.clear();
        assert!(world.is_finite(), "{name}");
        assert_eq!(saved(&world), saved(&fresh), "{name}");
        world.restore(&broken);
        assert!(!world.is_finite(), "{name}: restored");
    }
}

#[test]
fn damaged_snapshots_break_the_world_and_nothing_else() {
    let robot = scene();
    let mut world = World::new(&robot, &Options::default()).unwrap();
    world.step();
    let good = saved(&world);
    assert!(good.iter().all(|x| x.is_finite() && *x >= 0.0 && *x < 16_777_216.0 && x.trunc() == *x));
    let other = World::new(&common::ghost(&robot), &Options::default()).unwrap();
    let mut small = robot.clone();
    small.actuators.clear();
    let small = World::new(&small, &Options::default()).unwrap();
    let mut damaged = good.clone();
    damaged[good.len() / 2] += 1.0;
    for bad in [&[][..], &good[..3], &good[..good.len() - 1], &damaged, &[f32::NAN; 100], &[1e30; 100], &saved(&small)]
    {
        world.restore(bad);
        assert!(!world.is_finite());
        world.step();
        world.restore(&good);
        assert!(world.is_finite() && saved(&world) == good);
    }
    // A world that differs only in its pairs has a state of the same form.
    world.restore(&saved(&other));
    world.step();
}

#[test]
fn what_cannot_be_built_is_refused() {
    let robot = scene();
    let refused = |robot: &farsa_body::robot::Robot, options: Options| World::new(robot, &options).err().unwrap();
    for (name, options) in [
        ("time_step", Options { time_step: 0.0, ..Options::default() }),
        ("time_step", Options { time_step: f64::NAN, ..Options::default() }),
        ("substeps", Options { substeps: 0, ..Options::default() }),
        ("iterations", Options { iterations: 0, ..Options::default() }),
        ("sweeps", Options { sweeps: 0, ..Options::default() }),
        ("speed_sweeps", Options { speed_sweeps: 0, ..Options::default() }),
        ("gravity y", Options { gravity: [0.0, f64::INFINITY, 0.0], ..Options::default() }),
        ("length_unit", Options { length_unit: -1.0, ..Options::default() }),
        ("contact_frequency", Options { contact_frequency: 0.0, ..Options::default() }),
        ("contact_damping", Options { contact_damping: 1e9, ..Options::default() }),
    ] {
        let error = refused(&robot, options);
        assert!(matches!(error, RapierError::Option { name: n, .. } if n == name), "{error}");
        assert!(error.to_string().contains(name));
    }
    let mut plane = robot.clone();
    plane.add_collider(Collider::new("flat", Some(Tabletop::SPHERE), Shape::Plane, Pose::identity()));
    assert_eq!(
        refused(&plane, Options::default()),
        RapierError::Unsupported { why: "collider flat: a plane does not move".into() }
    );
    let mut sliding = Robot::new("sliding");
    let body = sliding.add_sliding_body("puck", Pose::identity(), MassProperties::sphere(1.0, 0.1), false);
    sliding.add_ground(farsa_body::robot::Ground { body, friction: 0.5, load: 1.0, radius: 0.0 });
    assert_eq!(
        refused(&sliding, Options::default()),
        RapierError::Unsupported { why: "body puck: nothing rubs on the ground that it slides on here".into() }
    );
    let mut heavy = robot;
    heavy.segments[0].mass = -1.0;
    let error = refused(&heavy, Options::default());
    assert!(matches!(error, RapierError::Model(ModelError::Robot(RobotError::Value { .. }))), "{error}");
}

/// Six thousand control steps. A hundred thousand where the environment has `FARSA_LONG`.
#[test]
fn random_commands_break_nothing() {
    let steps = if std::env::var_os("FARSA_LONG").is_some() { 100_000 } else { 6_000 };
    let robot = scene();
    let groups = ArmAndHand::default().servo_groups();
    let mut world = World::new(&robot, &Options::default()).unwrap();
    let (mut episode, mut done, mut falls, mut touching) = (0_u32, 0, 0, 0);
    let (mut fastest, mut over, mut deepest, mut sunk) = (0.0_f32, 0.0_f32, 0.0_f32, f32::NEG_INFINITY);
    while done < steps {
        let mut draw = stream(7, episode);
        let k = episode as usize % 4;
        world.clear();
        for (j, degrees) in POSES[k].into_iter().enumerate() {
            let degrees = degrees as f32 + draw.range(-1.0, 1.0);
            world.place_joint(JointId(j as u16), degrees.to_radians(), 0.0);
        }
        let at = SPHERES[k].map(|x| x as f32 + 0.015 * draw.range(-1.0, 1.0));
        world.place_body(Tabletop::SPHERE, Pose::at([at[0], at[1], 0.025]), Twist::default());
        world.finish_placement();
        let mut babble = Babble::new(1, episode);
        for _ in 0..EPISODE_STEPS {
            drive(&mut world, &commands(&groups, babble.next()));
            world.step();
            done += 1;
            assert!(world.is_finite(), "episode {episode}");
            for j in (0..27).map(JointId) {
                let [low, high] = robot.segments[j.index()].joint.range.map(|x| x as f32);
                fastest = fastest.max(world.speed(j).abs());
                over = over.max((low - world.position(j)).max(world.position(j) - high));
            }
            let hand = (0..world.pairs() as u16 - 18).map(PairId);
            touching += usize::from(hand.clone().any(|pair| world.touches(pair)));
            for pair in hand.filter(|pair| world.touches(*pair)) {
                deepest = deepest.max(world.pair_contact(pair).depth);
            }
            let [x, y, z] = world.pose(Tabletop::SPHERE).position;
            assert!(x.is_finite() && y.is_finite() && z.is_finite());
            if x > 0.03 && x < 0.5 && y > -0.55 && y < 0.25 {
                sunk = sunk.max(-z);
            }
            if z < 0.0 {
                falls += 1;
                break;
            }
        }
        episode += 1;
    }
    println!("{done} steps, {episode} episodes, {falls} falls, {touching} with contact of the hand");
    println!(
        "fastest joint {fastest} rad/s, {over} rad over a limit, {deepest} m deep, centre {sunk} m below the table"
    );
    assert!(touching > steps / 20);
    assert!(fastest < 150.0 && over < 0.3 && deepest < 0.02 && sunk < 0.0);
}
