//! Driving, collisions and pushing of rigid robots, compared with the kinematic world.

use core::f64::consts::{FRAC_PI_2, FRAC_PI_8};

use farsa_body::ports::{
    Actuated, ActuatorId, Arrange, BodyId, Contacts, ExternalForces, Joints, Kinematics, PairId, World,
};
use farsa_body::robots::{MobileParts, MobileRobot};
use farsa_body::{Pose, Twist};
use farsa_num::sin_cos;
use farsa_physics::arena::{self, Arena, Convex, Cylinder, Wall};
use farsa_physics::rapier::{ArenaOptions, ArenaScene, ArenaWorld, Block, Chassis};

fn robots() -> [MobileRobot; 3] {
    [MobileRobot::khepera(), MobileRobot::e_puck(), MobileRobot { attachment: None, ..MobileRobot::marxbot() }]
}

fn world(scene: &ArenaScene) -> ArenaWorld {
    ArenaWorld::new(scene, &ArenaOptions::default()).unwrap()
}

/// A robot alone on the plane, at the origin.
fn plane(robot: &MobileRobot) -> Arena {
    let mut arena = Arena::new();
    arena.add_robot(robot.clone(), [0.0, 0.0], 0.0);
    arena
}

fn drive<W>(world: &mut W, parts: &MobileParts, speeds: [f32; 2], steps: usize)
where
    W: World + Actuated<Actuator = ActuatorId>,
{
    for (motor, speed) in parts.motors.into_iter().zip(speeds) {
        world.command(motor, [speed, 0.0]);
    }
    (0..steps).for_each(|_| world.step());
}

fn speed(world: &ArenaWorld, body: BodyId) -> f32 {
    let [x, y, _] = world.velocity(body).linear;
    x.hypot(y)
}

/// Returns the distance of two robots and the difference of their headings [m, rad].
fn apart(a: &Pose, b: &Pose) -> [f32; 2] {
    let [x, y] = [0, 1].map(|k| a.position[k] - b.position[k]);
    let turn = a.heading() - b.heading();
    let (sine, cosine) = sin_cos(turn);
    [x.hypot(y), farsa_num::atan2(sine, cosine).abs()]
}

/// Straight on, turning in place and along arcs for two seconds: what getting under way costs is all that differs.
#[test]
fn wheels_take_a_robot_where_the_kinematic_world_has_it() {
    for (robot, heading) in
        robots().into_iter().flat_map(|robot| [0.0, 0.3, 0.785].map(|heading| (robot.clone(), heading)))
    {
        let mut arena = plane(&robot);
        arena.robots[0].heading = heading;
        let (mut ours, mut theirs) = (arena::World::new(&arena).unwrap(), world(&ArenaScene::new(arena.clone())));
        let parts = arena.parts(0);
        let most = robot.max_wheel_speed as f32;
        let fastest = most * robot.wheel_radius as f32;
        for (name, speeds) in [
            ("straight", [most; 2]),
            ("slowly", [0.3 * most; 2]),
            ("backwards", [-0.5 * most; 2]),
            ("turn", [-0.5 * most, 0.5 * most]),
            ("arc", [0.5 * most, most]),
            ("about a wheel", [0.0, most]),
        ] {
            ours.clear();
            theirs.clear();
            drive(&mut ours, &parts, speeds, 40);
            drive(&mut theirs, &parts, speeds, 40);
            let [off, turned] = apart(&ours.pose(parts.body), &theirs.pose(parts.body));
            let pose = theirs.pose(parts.body);
            let wheels = parts.wheels.map(|wheel| theirs.speed(wheel));
            println!(
                "{} at {heading} {name}: {:.2} mm and {:.2} mrad off, {:.3} mm high, upright {:.6}, wheels {wheels:?} of {speeds:?}",
                robot.name,
                1e3 * off,
                1e3 * turned,
                1e3 * pose.position[2],
                pose.rotate([0.0, 0.0, 1.0])[2],
            );
            // Half a gravity up to speed takes v / g of the time, in which v^2 / g of the way is lost.
            let lost = fastest * fastest / 9.81;
            let hull = robot.radius as f32;
            assert!(off < 3.0 * lost + 0.02 * hull, "{} {name}: {off} m, {lost} m", robot.name);
            assert!(
                turned < (3.0 * lost + 0.02 * hull) / (0.5 * robot.track as f32),
                "{} {name}: {turned}",
                robot.name
            );
            assert!(pose.position[2].abs() < 2e-4 && pose.rotate([0.0, 0.0, 1.0])[2] > 0.9995, "{} {name}", robot.name);
            let near = |wheel: f32, command: f32| (wheel - command).abs() < 0.02 * most;
            assert!(wheels.iter().zip(speeds).all(|(wheel, command)| near(*wheel, command)), "{name}: {wheels:?}");
        }
    }
}

/// Half a minute straight on, and turning to and fro, at any heading: nothing gathers that turns it aside or uses up its grip.
#[test]
fn a_long_way_is_straight() {
    let robot = MobileRobot::e_puck();
    let most = robot.max_wheel_speed as f32;
    let mut worst = [0.0_f32; 2];
    for heading in (0..16).map(|k| 0.1 + FRAC_PI_8 * f64::from(k)) {
        let mut arena = plane(&robot);
        arena.robots[0].heading = heading;
        let (mut ours, mut theirs) = (arena::World::new(&arena).unwrap(), world(&ArenaScene::new(arena.clone())));
        let parts = arena.parts(0);
        drive(&mut ours, &parts, [most; 2], 600);
        drive(&mut theirs, &parts, [most; 2], 600);
        let [off, turned] = apart(&ours.pose(parts.body), &theirs.pose(parts.body));
        worst = [worst[0].max(off), worst[1].max(turned)];
        theirs.clear();
        let start = theirs.pose(parts.body);
        for _ in 0..30 {
            drive(&mut theirs, &parts, [0.3 * most, -0.2 * most], 10);
            drive(&mut theirs, &parts, [-0.3 * most, 0.2 * most], 10);
        }
        let [away, astray] = apart(&start, &theirs.pose(parts.body));
        println!("{heading:.2}: {off:.5} m, {turned:.5} rad; to and fro {away:.5} m, {astray:.5} rad");
        assert!(away < 0.01 && astray < 0.06, "{heading}: {away} m, {astray} rad");
    }
    println!("in 4.3 m at most {:.4} m and {:.4} rad off", worst[0], worst[1]);
    assert!(worst[0] < 0.03 && worst[1] < 0.01, "{worst:?}");
}

/// The lag of motors is proportional to the pushed load, a hundredth of the greatest speed for the full torque, and
/// wheels do not slip. The test compares with that law at any heading.
#[test]
fn a_load_slows_as_the_motors_law_says() {
    let robot = MobileRobot::e_puck();
    let chassis = Chassis::for_robot(&robot);
    let push = 2.0 * chassis.torque / robot.wheel_radius;
    for heading in [0.0, 0.3, 0.785, 1.2_f64] {
        for mass in [0.01, 0.05, 0.1, 0.14] {
            let mut arena = plane(&robot);
            arena.robots[0].heading = heading;
            let (sine, cosine) = sin_cos(heading);
            let mut scene = ArenaScene::new(arena);
            let block = Block::new([0.11 * cosine, 0.11 * sine], [0.12, 0.12, 0.05], mass);
            scene.add_block(Block { heading, ..block });
            let (parts, cube) = (scene.arena.parts(0), scene.block(0));
            let mut world = world(&scene);
            let commanded = 0.1 / robot.wheel_radius;
            drive(&mut world, &parts, [commanded as f32; 2], 60);
            let was = world.pose(cube).position;
            drive(&mut world, &parts, [commanded as f32; 2], 40);
            let [x, y, _] = world.pose(cube).position;
            let speed = f64::from((x - was[0]).hypot(y - was[1])) / (40.0 * scene.arena.time_step);
            let lacking = 0.01 * robot.max_wheel_speed * robot.wheel_radius * 0.5 * 9.81 * mass / push;
            println!("{mass} kg at {heading}: {speed:.5} m/s, by the law {:.5}", 0.1 - lacking);
            assert!((speed - 0.1 + lacking).abs() < 3e-4, "{mass} kg at {heading}: {speed} m/s");
        }
    }
}

/// Into a wall, a cylinder, a prism and another robot at full speed and at several angles: no deeper than half a
/// millimeter per 0.1 m/s. Head on it stops, at a slant it slides along.
#[test]
fn what_it_runs_into_stops_it() {
    for robot in robots() {
        let radius = robot.radius;
        let fastest = robot.max_wheel_speed * robot.wheel_radius;
        for slant in [0.0, 0.3, 0.8] {
            let mut arena = Arena { time_step: 0.05, ..Arena::new() };
            arena.add_robot(robot.clone(), [-radius - 0.05, 0.0], slant);
            arena.add_wall(Wall::cuboid([0.05, 0.0], [0.1, 20.0], 0.0));
            let parts = arena.parts(0);
            let mut world = world(&ArenaScene::new(arena));
            let most = robot.max_wheel_speed as f32;
            let (mut deepest, mut touched) = (0.0_f64, 0);
            for _ in 0..80 {
                drive(&mut world, &parts, [most; 2], 1);
                let pose = world.pose(parts.body);
                // The hull's middle, because a robot that pushes leans back.
                let middle = pose.transform([0.0, 0.0, 0.5 * robot.height as f32]);
                deepest = deepest.max(f64::from(middle[0]) + radius);
                touched += u32::from(world.touches(PairId(0)));
                assert!(!world.touches(PairId(0)) || world.pair_bodies(PairId(0)) == [Some(parts.body), None]);
            }
            let [u, v, _] = world.velocity(parts.body).linear;
            println!(
                "{} at {slant}: {:.3} mm deep, {touched} steps, then {u:.4} {v:.4} m/s, {:?} N",
                robot.name,
                1e3 * deepest,
                world.pair_contact(PairId(0)).force
            );
            assert!(deepest < 5e-3 * fastest, "{} at {slant}: {deepest} m deep", robot.name);
            assert!(touched > 20, "{} at {slant}: {touched}", robot.name);
            assert!(u.abs() < 5e-3, "{} at {slant}: {u} m/s", robot.name);
            assert!(slant > 0.0 || v.abs() < 5e-3, "{}: {v} m/s", robot.name);
            assert!(world.pair_contact(PairId(0)).force[0] < 0.0, "it is pushed back");
        }
        let mut arena = Arena::new();
        arena.add_robot(robot.clone(), [0.0, 0.0], 0.0);
        arena.add_robot(robot.clone(), [-0.02, 2.0 * radius + 0.02], FRAC_PI_2);
        arena.add_cylinder(Cylinder::new([radius + 0.06, 0.0], 0.02));
        arena.add_convex(Convex::prism(
            &[[-0.1, 4.0 * radius + 0.1], [0.1, 4.0 * radius + 0.1], [0.0, 5.0 * radius + 0.2]],
            0.1,
        ));
        let (one, other, cylinder) = (arena.parts(0), arena.parts(1), arena.cylinder(0));
        let mut world = world(&ArenaScene::new(arena));
        let most = robot.max_wheel_speed as f32;
        for _ in 0..60 {
            drive(&mut world, &one, [most; 2], 0);
            drive(&mut world, &other, [most; 2], 1);
        }
        assert_eq!(world.pair_bodies(PairId(0)), [Some(one.body), Some(cylinder)], "{}", robot.name);
        assert_eq!(world.pair_bodies(PairId(1)), [Some(other.body), None]);
        let gap = f64::from(world.pose(cylinder).position[0] - world.pose(one.body).position[0]) - radius - 0.02;
        let top = 4.0 * radius + 0.1 - f64::from(world.pose(other.body).position[1]) - radius;
        println!("{}: {gap} m from the cylinder, {top} m from the prism", robot.name);
        assert!(gap.abs() < 1e-3 && top.abs() < 1e-3, "{}: {gap} {top}", robot.name);
    }
}

/// A block is pushed no faster than the robot drives, whatever it weighs and wherever it is met, friction stops it.
#[test]
fn a_block_is_pushed_and_never_launched() {
    let robot = MobileRobot::e_puck();
    let fastest = (robot.max_wheel_speed * robot.wheel_radius) as f32;
    let mut worst = 0.0_f32;
    for mass in [0.01, 0.05, 0.15] {
        for aside in [0.0, 0.03, 0.06, 0.085] {
            for heading in [0.0, 0.4, 0.785] {
                let mut scene = ArenaScene::new(plane(&robot));
                let block = Block::new([0.16, aside], [0.12, 0.12, 0.05], mass);
                scene.add_block(Block { heading, friction: 0.4, ..block });
                let (parts, cube, pair) = (scene.arena.parts(0), scene.block(0), scene.block_pair(0));
                let mut world = world(&scene);
                let mut touched = false;
                let at = world.pose(cube).position;
                for _ in 0..60 {
                    drive(&mut world, &parts, [robot.max_wheel_speed as f32; 2], 1);
                    worst = worst.max(speed(&world, cube));
                    touched |= world.touches(pair) && world.pair_bodies(pair) == [Some(cube), Some(parts.body)];
                    let pose = world.pose(cube);
                    assert!(pose.position[2].abs() < 2e-3 && pose.rotate([0.0, 0.0, 1.0])[2] > 0.99, "{mass} {aside}");
                }
                let way = world.pose(cube).position[0] - at[0];
                assert!(touched || aside > 0.08, "{mass} kg, {aside} m");
                assert!(aside > 0.0 || way > 0.1, "{mass} kg straight on: {way} m");
                drive(&mut world, &parts, [-robot.max_wheel_speed as f32; 2], 20);
                assert!(speed(&world, cube) < 1e-3, "{mass} kg, {aside} m: {} m/s", speed(&world, cube));
            }
        }
    }
    println!("a block's greatest speed is {worst} m/s, the robot's {fastest} m/s");
    // The block's middle may be faster than where it is pushed, as it turns.
    assert!(worst < 1.15 * fastest, "{worst} m/s");
}

/// A load beyond its motors stops it: wheels of a strong motor spin, those of a weak one do not reach their speed.
#[test]
fn a_heavy_block_stays_where_it_is() {
    let robot = MobileRobot::e_puck();
    let chassis = Chassis::for_robot(&robot);
    for (strong, torque) in [(false, chassis.torque), (true, 4.0 * chassis.torque)] {
        let mut scene = ArenaScene::new(plane(&robot));
        scene.chassis[0].torque = torque;
        scene.add_block(Block::new([0.12, 0.0], [0.12, 0.12, 0.05], 2.0));
        let (parts, cube) = (scene.arena.parts(0), scene.block(0));
        let mut world = world(&scene);
        let most = robot.max_wheel_speed as f32;
        drive(&mut world, &parts, [most; 2], 60);
        let wheels = parts.wheels.map(|wheel| world.speed(wheel));
        println!("torque {torque}: wheels {wheels:?}, block at {:?}", world.pose(cube).position);
        assert!((world.pose(cube).position[0] - 0.12).abs() < 1e-4 && speed(&world, parts.body) < 1e-3);
        assert!(wheels.iter().all(|wheel| (*wheel > 0.9 * most) == strong), "{wheels:?}");
        // It pushes with what its motors give, or its wheels' grip.
        let force = -world.pair_contact(PairId(0)).force[0];
        let weight = (chassis.mass * 9.81) as f32;
        println!("pushes with {force} N of a weight of {weight} N");
        // Slipping wheels push with their grip, 0.8 of the load on them. The load may be less than the weight, because
        // a push at the height h puts h / (0.7 radius) of itself onto the rear skid without grip. It may be more,
        // because the block's friction, 0.3 of the push, keeps the hull from rising.
        let low = 0.8 / (1.0 + 0.8 * 0.05 / (0.7 * robot.radius as f32));
        let range = if strong { [low, 0.8 / (1.0 - 0.8 * 0.3)] } else { [0.495, 0.505] };
        assert!((range[0]..range[1]).contains(&(force / weight)), "{force} N of {weight} N: not in {range:?}");
    }
}

/// A block that a hand pushes stays below Coulomb's limit, and gains (F / m - mu g) t above it.
#[test]
fn a_hand_pushes_a_block_against_friction() {
    let mut scene = ArenaScene::new(plane(&MobileRobot::khepera()));
    let [mass, friction] = [0.1, 0.4];
    scene.add_block(Block { friction, ..Block::new([0.3, 0.0], [0.1, 0.1, 0.02], mass) });
    let cube = scene.block(0);
    let mut world = world(&scene);
    for _ in 0..5 {
        world.step();
    }
    let before = world.pose(cube).position;
    let pushed = |world: &mut ArenaWorld, force: f32| {
        let [x, y, z] = world.pose(cube).position;
        world.apply_force(cube, [x, y, z + 0.002], [force, 0.0, 0.0]);
        world.step();
        world.velocity(cube).linear[0]
    };
    let limit = (friction * mass * 9.81) as f32;
    let still = pushed(&mut world, 0.9 * limit);
    assert!(still.abs() < 1e-3 && (world.pose(cube).position[0] - before[0]).abs() < 1e-4, "{still} m/s");
    let speed = pushed(&mut world, 2.0 * limit);
    let expected = limit / mass as f32 * world.time_step();
    assert!((speed - expected).abs() < 0.03 * expected, "{speed} m/s, {expected} by Coulomb's law");
    // Let go, it slides on and stops.
    for _ in 0..10 {
        world.step();
    }
    let way = world.pose(cube).position[0] - before[0];
    assert!(world.velocity(cube).linear[0].abs() < 1e-3 && way > 0.5 * expected * world.time_step(), "{way} m");
}

/// A block that lies on another side is seen as it lies.
#[test]
fn blocks_are_put_down_upright_and_at_rest() {
    let mut scene = ArenaScene::new(plane(&MobileRobot::khepera()));
    scene.add_block(Block::new([0.3, 0.0], [0.1, 0.06, 0.04], 0.1));
    let cube = scene.block(0);
    let mut world = world(&scene);
    let tilted = Pose { position: [0.2, 0.1, 0.7], rotation: [0.0, 0.6, 0.0, 0.8] };
    world.place_body(cube, tilted, Twist { linear: [1.0; 3], angular: [1.0; 3] });
    world.finish_placement();
    let (pose, twist) = (world.pose(cube), world.velocity(cube));
    assert_eq!(pose.position[..2], [0.2, 0.1]);
    assert!(pose.position[2].abs() < 1e-6 && pose.rotate([0.0, 0.0, 1.0])[2] > 0.9999, "{pose:?}");
    assert_eq!(twist, Twist::default());
    (0..40).for_each(|_| world.step());
    assert!(apart(&pose, &world.pose(cube))[0] < 1e-4 && world.pose(cube).position[2].abs() < 1e-4);
}

/// Returns the commands, the same bits, also from a snapshot in another world. The control step may be divided
/// otherwise.
#[test]
fn finer_steps_come_to_the_same() {
    let robot = MobileRobot::khepera();
    let parts = plane(&robot).parts(0);
    let end = |longest_step: f64| {
        let options = ArenaOptions { longest_step, ..ArenaOptions::default() };
        let mut world = ArenaWorld::new(&ArenaScene::new(plane(&robot)), &options).unwrap();
        for (speeds, steps) in [([5.0, 6.0], 40), ([6.0, -1.0], 10), ([2.0, 4.0], 40)] {
            drive(&mut world, &parts, speeds, steps);
        }
        world.pose(parts.body)
    };
    let [usual, finer, fine] = [0.01, 0.0025, 0.0005].map(end);
    let [off, turned] = apart(&usual, &fine);
    println!("10 ms {off} m, {turned} rad from 0.5 ms, 2.5 ms {:?}", apart(&finer, &fine));
    assert!(off < 3e-3 && turned < 0.03, "{off} m, {turned} rad");
}
