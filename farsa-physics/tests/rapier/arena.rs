//! The world of wheeled robots in rapier keeps the promises of `farsa_body::testing`. Its sensors read the values of
//! the kinematic world, and it refuses unsupported parts.

use farsa_body::motors::WheelVelocity;
use farsa_body::ports::{Actuated, Arrange, BodyId, JointId, Joints, Kinematics, Sensor, Sight, Snapshot, World as _};
use farsa_body::robots::MobileRobot;
use farsa_body::sensors::infrared::{InfraredFormula, InfraredRays};
use farsa_body::sensors::{GroundColor, LightSensors, Traction, WheelSpeed};
use farsa_body::testing::{Probe, check_arrange, check_motor, check_planar, check_rays, check_sensor, check_world};
use farsa_body::{Pose, Twist};
use farsa_physics::arena::{self, Area, Arena, ArenaError, Convex, Cylinder, Part, Wall};
use farsa_physics::rapier::{ArenaOptions, ArenaScene, ArenaWorld, Block, RapierError};

/// Three robots among obstacles of every kind, close enough to run into them.
fn arena() -> Arena {
    let mut arena = Arena::walled(0.9, 0.8);
    arena.time_step = 0.1;
    arena.add_wall(Wall::segment([0.3, 0.3], [0.5, 0.4], 0.02).with_height(0.2));
    arena.add_convex(Convex::prism(&[[0.8, 0.7], [0.9, 0.7], [0.85, 0.8]], 0.1));
    arena.add_cylinder(Cylinder { lamp: 2.0, ..Cylinder::new([0.65, 0.6], 0.05) });
    arena.add_cylinder(Cylinder::new([0.2, 0.5], 0.0125));
    arena.add_area(Area::circle([0.2, 0.2], 0.1, [1.0, 0.0, 0.0]));
    arena.add_area(Area::rectangle([0.6, 0.2], [0.2, 0.1], 0.4, [0.0, 0.0, 1.0]));
    arena.add_robot(MobileRobot::khepera(), [0.15, 0.3], 0.3);
    arena.add_robot(MobileRobot::e_puck(), [0.45, 0.6], -2.0);
    arena.add_robot(MobileRobot { attachment: None, ..MobileRobot::marxbot() }, [0.7, 0.3], 1.9);
    arena
}

fn scene() -> ArenaScene {
    let mut scene = ArenaScene::new(arena());
    scene.add_block(Block { heading: 0.4, ..Block::new([0.15, 0.12], [0.08, 0.05, 0.04], 0.1) });
    scene.add_block(Block { color: [1.0, 0.5, 0.0], ..Block::new([0.32, 0.5], [0.05, 0.05, 0.05], 0.05) });
    scene
}

fn world(scene: &ArenaScene) -> ArenaWorld {
    ArenaWorld::new(scene, &ArenaOptions::default()).unwrap()
}

fn probe(scene: &ArenaScene) -> Probe {
    let bodies: Vec<BodyId> = (0..9).map(BodyId).collect();
    let wheels = (0..3).flat_map(|robot| {
        let most = scene.arena.robots[robot].robot.max_wheel_speed as f32;
        scene.arena.parts(robot).motors.map(|motor| (motor, [[-most, 0.0], [most, 0.0]]))
    });
    Probe {
        planar: bodies.clone(),
        joints: (0..6).map(|joint| (JointId(joint), [-3.0, 3.0])).collect(),
        actuators: wheels.collect(),
        steps: 160,
        bodies,
        ..Probe::numbered(0, [[0.0; 2]; 2])
    }
}

#[test]
fn the_world_conforms() {
    let scene = scene();
    let (probe, fresh) = (probe(&scene), world(&scene));
    let make = || fresh.clone();
    assert_eq!(check_world(make, &probe), Ok(()));
    assert_eq!(check_arrange(make, &probe), Ok(()));
    let origins = [[0.3, 0.2, 0.02], [0.45, 0.45, 0.3], [-0.2, 0.4, 0.05], [0.15, 0.3, 0.05]];
    for range in [0.2, 2.0, f32::INFINITY] {
        assert_eq!(check_rays(&make(), &probe.bodies, &origins, range), Ok(()));
    }
    let places = [[0.3, 0.2], [0.45, 0.45], [-0.2, 0.4], [0.15, 0.3], [0.25, 0.52]];
    let mut moved = make();
    for _ in 0..40 {
        probe.actuators.iter().for_each(|(actuator, [_, most])| moved.command(*actuator, *most));
        moved.step();
    }
    for range in [0.2, 2.0] {
        for world in [&fresh, &moved] {
            assert_eq!(check_planar(world, &probe.bodies, &places, range), Ok(()));
        }
    }
}

/// Checks that a sensor has equal readings in both worlds, within a tolerance.
fn same<S>(mut sensor: S, ours: &arena::World, theirs: &ArenaWorld, off: f32) -> Vec<f32>
where
    S: Sensor<arena::World> + Sensor<ArenaWorld>,
{
    assert_eq!(check_sensor(&mut sensor, theirs), Ok(()));
    let [mut a, mut b] = [vec![0.0; sensor.channels()], vec![0.0; sensor.channels()]];
    sensor.read(ours, &mut a);
    sensor.read(theirs, &mut b);
    assert!(a.iter().zip(&b).all(|(a, b)| (a - b).abs() <= off), "{a:?} {b:?}");
    a
}

/// Sensors and motors work in both worlds, and readings are equal before the first step.
#[test]
fn sensors_and_motors_work_as_in_the_kinematic_world() {
    let plain = ArenaScene::new(arena());
    let mut ours = arena::World::new(&plain.arena).unwrap();
    let mut theirs = world(&plain);
    let robot = &plain.arena.robots[0].robot;
    let parts = plain.arena.parts(0);
    let most = robot.max_wheel_speed as f32;
    for moved in [false, true] {
        // Where it has come to after a second differs by what it takes to get under way.
        let off = if moved { 0.1 } else { 1e-4 };
        let rays = same(InfraredRays::for_robot(robot, parts.body).unwrap(), &ours, &theirs, off);
        same(InfraredFormula::for_robot(robot, parts.body).unwrap(), &ours, &theirs, off);
        same(GroundColor::new(parts.body, vec![[0.0, 0.0], [0.03, 0.0]]).unwrap(), &ours, &theirs, 0.0);
        same(LightSensors::for_robot(robot, parts.body, 1.0).unwrap(), &ours, &theirs, off);
        same(WheelSpeed::new(parts.wheels, most).unwrap(), &ours, &theirs, off);
        same(Traction::new(parts.body, parts.wheels, 0.015, 0.1).unwrap(), &ours, &theirs, off);
        assert!(!moved || rays.iter().any(|x| *x > 0.1), "{rays:?}");
        let mut motor = WheelVelocity::new(parts.motors, most).unwrap();
        assert_eq!(check_motor(&mut motor, || theirs.clone()), Ok(()));
        for _ in 0..10 {
            parts.motors.iter().for_each(|motor| ours.command(*motor, [5.0, 0.0]));
            parts.motors.iter().for_each(|motor| theirs.command(*motor, [5.0, 0.0]));
            ours.step();
            theirs.step();
        }
    }
}

#[test]
fn leds_and_signals_are_shown() {
    let scene = scene();
    let mut world = world(&scene);
    let parts = world.parts(1);
    let leds = parts.leds.unwrap();
    world.command(leds[0], [0.75, 0.0]);
    world.command(leds[2], [7.0, 0.0]);
    world.command(parts.signal.unwrap(), [0.5, 0.0]);
    world.step();
    let mut told = None;
    world.query_near([0.45, 0.6], 0.05, &mut |near| {
        if near.body == Some(parts.body) {
            told = Some((near.color, near.signal));
        }
    });
    assert_eq!(told, Some(([0.75, 0.0, 1.0], Some(0.5))));
}

fn saved(world: &ArenaWorld) -> Vec<f32> {
    let mut words = vec![0.0; world.snapshot_len()];
    world.save(&mut words);
    words
}

type Damage = fn(&mut ArenaWorld, BodyId);

#[test]
fn a_broken_world_tells_nan_and_is_cured() {
    let scene = scene();
    let fresh = world(&scene);
    let block = scene.block(0);
    let damages: [(&str, Damage); 4] = [
        ("a wheel", |w, _| w.place_joint(JointId(3), f32::NAN, 0.0)),
        ("a wheel's speed", |w, _| w.place_joint(JointId(2), 0.0, f32::INFINITY)),
        ("a robot", |w, _| w.place_body(BodyId(1), Pose::at([f32::NAN, 0.0, 0.0]), Twist::default())),
        ("a block", |w, block| w.place_body(block, Pose::at([0.1, f32::NAN, 0.0]), Twist::default())),
    ];
    for (name, damage) in damages {
        let mut world = fresh.clone();
        damage(&mut world, block);
        world.finish_placement();
        (0..3).for_each(|_| world.step());
        assert!(!world.is_finite(), "{name}");
        let (pose, twist) = (world.pose(BodyId(0)), world.velocity(block));
        assert!(pose.position[0].is_nan() && pose.rotation[3].is_nan() && twist.angular[1].is_nan(), "{name}");
        assert!(world.position(JointId(0)).is_nan() && world.speed(JointId(5)).is_nan(), "{name}");
        let broken = saved(&world);
        world.clear();
        assert!(world.is_finite(), "{name}");
        assert_eq!(saved(&world), saved(&fresh), "{name}");
        world.restore(&broken);
        assert!(!world.is_finite(), "{name}: restored");
    }
    // An invalid command stops a wheel.
    let mut world = fresh.clone();
    for motor in world.parts(0).motors {
        world.command(motor, [f32::NAN, 0.0]);
    }
    (0..20).for_each(|_| world.step());
    assert!(world.is_finite() && world.speed(JointId(0)).abs() < 1e-3);
    for bad in [&[][..], &saved(&fresh)[..40], &[f32::NAN; 4000]] {
        let mut world = fresh.clone();
        world.restore(bad);
        assert!(!world.is_finite());
    }
}

#[test]
fn what_it_has_not_is_refused_by_name() {
    let refused = |scene: &ArenaScene| ArenaWorld::new(scene, &ArenaOptions::default()).unwrap_err();
    let mut holding = scene();
    holding.arena.robots[2].robot.attachment = Some(0.02);
    assert_eq!(
        refused(&holding),
        RapierError::Unsupported {
            why: "robot 2 has an attachment device, which holds nothing in rapier: take it off (`None`)".into()
        }
    );
    let mut short = scene();
    short.chassis.pop();
    assert_eq!(refused(&short).to_string(), "2 chassis for 3 robots: one for each");
    let mut light = scene();
    light.chassis[1].mass = 0.0;
    assert!(refused(&light).to_string().starts_with("mass of robot 1 is 0"), "{}", refused(&light));
    let mut rough = scene();
    rough.blocks[0].friction = f64::NAN;
    assert!(matches!(refused(&rough), RapierError::Part { part: "block", number: 0, field: "friction", .. }));
    let mut within = scene();
    within.blocks[1].centre = [0.02, 0.4];
    let depth = |error: &RapierError| if let RapierError::BlockOverlap { depth, .. } = error { *depth } else { 0.0 };
    assert!((depth(&refused(&within)) - 0.005).abs() < 1e-5, "{}", refused(&within));
    within.blocks[1].centre = [0.15, 0.3];
    assert!(depth(&refused(&within)) > 0.01, "in a robot: {}", refused(&within));
    let mut none = scene();
    (none.arena.robots, none.chassis) = (Vec::new(), Vec::new());
    assert_eq!(refused(&none), RapierError::Arena(ArenaError::Count { what: "robots", count: 0, range: [1, 32_768] }));
    let mut overlapping = scene();
    overlapping.arena.robots[0].at = [0.2, 0.5];
    let error = refused(&overlapping);
    assert!(matches!(&error, RapierError::Arena(ArenaError::Overlap { parts, .. }) if parts.contains(&Part::Robot(0))));
    let options = ArenaOptions { longest_step: 0.0, ..ArenaOptions::default() };
    let error = ArenaWorld::new(&scene(), &options).unwrap_err();
    assert!(matches!(error, RapierError::Option { name: "longest_step", .. }), "{error}");
}
