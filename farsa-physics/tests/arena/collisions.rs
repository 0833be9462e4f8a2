//! Robots that run into things and into each other, and hold each other.

use farsa_body::ports::{Actuated, BodyId, Contacts, Kinematics, PairId, Planar, Rays, Sight, Snapshot, World as _};
use farsa_body::robots::MobileRobot;
use farsa_num::{Domain, Stream};
use farsa_physics::arena::{Arena, CollisionRule, Cylinder, Search, Wall, World};

/// Robots on a lattice in a walled square with a skew wall in every fourth gap and pillars.
fn crowd(robots: usize, search: Search, collisions: CollisionRule) -> Arena {
    let side = (robots as f64).sqrt().ceil() as usize;
    let pitch = 0.12;
    let mut arena = Arena { search, collisions, ..Arena::walled(pitch * side as f64, pitch * side as f64) };
    let mut stream = Stream::new(7, Domain::Start, 0, 0, 0);
    for i in 0..side * side {
        let at = [pitch * (0.5 + (i % side) as f64), pitch * (0.5 + (i / side) as f64)];
        match i % 9 {
            3 => {
                let heading = stream.range_f64(-3.0, 3.0);
                arena.add_wall(Wall::cuboid(at, [0.06, 0.01], heading));
            }
            5 => {
                arena.add_cylinder(Cylinder::new(at, 0.0125));
            }
            _ => {
                let kind = if i % 2 == 0 { MobileRobot::khepera() } else { MobileRobot::e_puck() };
                arena.add_robot(kind, at, stream.range_f64(-3.0, 3.0));
            }
        }
    }
    arena
}

fn babble(world: &mut World, stream: &mut Stream) {
    for robot in 0..world.robots() {
        for motor in world.parts(robot).motors {
            // Mostly forward, so that the robots collide.
            world.command(motor, [stream.range(-3.0, 7.0), 0.0]);
        }
    }
}

/// The deepest overlap of a robot with anything, in double precision [m], and whose it is.
fn deepest(arena: &Arena, world: &World) -> (f64, String) {
    let at = |body: BodyId| [0, 1].map(|k| f64::from(world.pose(body).position[k]));
    let mut worst = (f64::NEG_INFINITY, String::new());
    let mut note = |depth: f64, who: String| {
        if depth > worst.0 {
            worst = (depth, who);
        }
    };
    for (i, a) in arena.robots.iter().enumerate() {
        let p = at(BodyId(i as u16));
        for (j, b) in arena.robots.iter().enumerate().skip(i + 1) {
            let q = at(BodyId(j as u16));
            note(a.robot.radius + b.robot.radius - (p[0] - q[0]).hypot(p[1] - q[1]), format!("robots {i} and {j}"));
        }
        for (j, b) in arena.cylinders.iter().enumerate() {
            let q = at(arena.cylinder(j));
            note(a.robot.radius + b.radius - (p[0] - q[0]).hypot(p[1] - q[1]), format!("robot {i} and cylinder {j}"));
        }
        for (j, wall) in arena.walls.iter().enumerate() {
            let (sine, cosine) = farsa_num::sin_cos(wall.heading);
            let [x, y] = [p[0] - wall.centre[0], p[1] - wall.centre[1]];
            let [u, v] = [(x * cosine + y * sine).abs(), (y * cosine - x * sine).abs()];
            let [u, v] = [(u - 0.5 * wall.size[0]).max(0.0), (v - 0.5 * wall.size[1]).max(0.0)];
            note(a.robot.radius - u.hypot(v), format!("robot {i} and wall {j}"));
        }
    }
    worst
}

fn words(world: &impl Snapshot) -> Vec<u32> {
    let mut words = vec![0.0; world.snapshot_len()];
    world.save(&mut words);
    words.into_iter().map(f32::to_bits).collect()
}

#[test]
fn nobody_is_ever_left_inside_anything() {
    for collisions in [CollisionRule::Revert, CollisionRule::Circles] {
        for robots in [1, 4, 20, 90] {
            let arena = crowd(robots, Search::Auto, collisions);
            let mut world = World::new(&arena).unwrap();
            let mut stream = Stream::new(1, Domain::Motor, 0, 0, 0);
            let (mut touched, mut moved) = (0, 0);
            for step in 0..800 {
                if step % 10 == 0 {
                    babble(&mut world, &mut stream);
                }
                world.step();
                let touches = |robot: usize| world.touches(PairId(robot as u16));
                touched += (0..world.robots()).filter(|robot| touches(*robot)).count();
                moved += (0..world.robots()).filter(|robot| !touches(*robot)).count();
                let (depth, who) = deepest(&arena, &world);
                assert!(depth < 1e-6, "{collisions:?}, {robots}, step {step}: {who} overlap by {depth}");
            }
            println!("{collisions:?}: {} robots, {touched} touches in 800 steps, {moved} free", world.robots());
            assert!((touched > 100 || robots < 4) && moved > 100, "{robots}: {touched} {moved}");
        }
    }
}

#[test]
fn the_grid_changes_no_bit() {
    for collisions in [CollisionRule::Revert, CollisionRule::Circles] {
        for robots in [2, 30, 200] {
            let [mut all, mut grid] =
                [Search::All, Search::Grid].map(|search| World::new(&crowd(robots, search, collisions)).unwrap());
            let mut streams = [Stream::new(2, Domain::Motor, 0, 0, 0); 2];
            for step in 0..400 {
                if step % 8 == 0 {
                    babble(&mut all, &mut streams[0]);
                    babble(&mut grid, &mut streams[1]);
                }
                all.step();
                grid.step();
                assert!(words(&all) == words(&grid), "{collisions:?}, {robots}, step {step}");
            }
            let mut stream = Stream::new(3, Domain::Sensor, 0, 0, 0);
            for robot in 0..all.robots() {
                let mut rings = [[0.0_f32; 8]; 2];
                all.infrared(robot, &mut rings[0]);
                grid.infrared(robot, &mut rings[1]);
                assert_eq!(rings[0].map(f32::to_bits), rings[1].map(f32::to_bits));
            }
            for _ in 0..2000 {
                let mut draw = || stream.range(-0.2, 2.0);
                let (from, z) = ([draw(), draw()], stream.range(0.0, 0.1));
                let range = stream.range(0.0, 1.5);
                let mut near = [Vec::new(), Vec::new()];
                all.query_near(from, range, &mut |n| near[0].push(n));
                grid.query_near(from, range, &mut |n| near[1].push(n));
                assert_eq!(near[0], near[1]);
                let (sine, cosine) = farsa_num::sin_cos(stream.range(-3.0, 3.0));
                let look = |world: &World| world.cast_planar(from, [cosine, sine], range, Some(BodyId(1)));
                assert_eq!(look(&all), look(&grid));
                let cast = |world: &World| world.cast([from[0], from[1], z], [0.8 * cosine, 0.8 * sine, 0.6], range);
                assert_eq!(cast(&all), cast(&grid));
            }
        }
    }
}

#[test]
fn robots_read_in_threads_read_the_same() {
    let arena = crowd(60, Search::Auto, CollisionRule::Revert);
    let mut world = World::new(&arena).unwrap();
    let mut stream = Stream::new(6, Domain::Motor, 0, 0, 0);
    for _ in 0..20 {
        babble(&mut world, &mut stream);
        world.step();
    }
    let read = |robots: std::ops::Range<usize>| {
        let ring = |robot| {
            let mut ring = [0.0; 8];
            world.infrared(robot, &mut ring);
            ring
        };
        robots.map(ring).collect::<Vec<_>>()
    };
    let robots = world.robots();
    let [first, second] = std::thread::scope(|scope| {
        let halves = [0..robots / 2, robots / 2..robots];
        halves.map(|half| scope.spawn(|| read(half))).map(|thread| thread.join().unwrap())
    });
    assert_eq!([first, second].concat(), read(0..robots));
    assert!(read(0..robots).concat().iter().filter(|x| **x > 0.0).count() > 50);
}

#[test]
fn a_blocked_robot_stays_where_it_was_and_tells_what_it_met() {
    let mut arena = Arena::walled(0.4, 0.4);
    arena.add_robot(MobileRobot::khepera(), [0.3625, 0.2], 0.0);
    let mut world = World::new(&arena).unwrap();
    let parts = world.parts(0);
    for motor in parts.motors {
        world.command(motor, [6.0, 0.0]);
    }
    let before = world.pose(parts.body);
    world.step();
    assert_eq!(world.pose(parts.body), before);
    assert_eq!(world.velocity(parts.body).linear, [0.0; 3]);
    let contact = world.pair_contact(PairId(0));
    assert_eq!((contact.points, contact.force, contact.normal_force), (1, [-1.0, 0.0, 0.0], 1.0));
    assert!((contact.depth - 0.002).abs() < 1e-6 && (contact.point[0] - 0.4).abs() < 1e-6, "{contact:?}");
    assert_eq!(world.pair_bodies(PairId(0)), [Some(parts.body), None]);
    // The robot returns, and the contact ends.
    for motor in parts.motors {
        world.command(motor, [-6.0, 0.0]);
    }
    world.step();
    assert!(!world.touches(PairId(0)) && world.pose(parts.body).position[0] < 0.36);
}

#[test]
fn a_row_that_is_stopped_in_front_is_stopped_behind() {
    // Each but the first moves into where the one before it would have been had it not been set back.
    let mut arena = Arena::walled(1.0, 0.4);
    for i in 0..5 {
        arena.add_robot(MobileRobot::khepera(), [0.9645 - 0.0705 * f64::from(i), 0.2], 0.0);
    }
    for search in [Search::All, Search::Grid] {
        let mut world = World::new(&Arena { search, ..arena.clone() }).unwrap();
        for robot in 0..5 {
            for motor in world.parts(robot).motors {
                world.command(motor, [6.0, 0.0]);
            }
        }
        let before: Vec<_> = (0..5).map(|i| world.pose(BodyId(i))).collect();
        world.step();
        for i in 0..5 {
            assert_eq!(world.pose(BodyId(i)), before[usize::from(i)]);
            let met = if i == 0 { None } else { Some(BodyId(i - 1)) };
            assert_eq!(world.pair_bodies(PairId(i)), [Some(BodyId(i)), met]);
        }
    }
}

#[test]
fn circles_slide_along_a_wall() {
    let mut arena = Arena { collisions: CollisionRule::Circles, ..Arena::walled(1.0, 0.4) };
    arena.add_robot(MobileRobot::khepera(), [0.2, 0.04], -0.5);
    let mut world = World::new(&arena).unwrap();
    for motor in world.parts(0).motors {
        world.command(motor, [4.0, 0.0]);
    }
    for _ in 0..100 {
        world.step();
    }
    let at = world.pose(BodyId(0)).position;
    assert!(at[0] > 0.35 && (at[1] - 0.035).abs() < 1e-4, "{at:?}");
    assert!(world.touches(PairId(0)) && world.pair_contact(PairId(0)).force[1] > 0.99);
    let speed = world.velocity(BodyId(0)).linear;
    assert!((speed[0] - 4.0 * 0.015 * 0.8776).abs() < 1e-3 && speed[1].abs() < 1e-3, "{speed:?}");
}

/// Two marXbots in a row, the one behind with its device on.
fn pair_in_a_row(search: Search) -> (Arena, World) {
    let mut arena = Arena { search, ..Arena::walled(2.0, 1.0) };
    arena.add_robot(MobileRobot::marxbot(), [0.5, 0.5], 0.0);
    arena.add_robot(MobileRobot::marxbot(), [0.68, 0.5], 1.0);
    arena.add_robot(MobileRobot::marxbot(), [1.2, 0.8], 1.0);
    let mut world = World::new(&arena).unwrap();
    world.command(world.parts(0).attachment.unwrap(), [1.0, 0.0]);
    (arena, world)
}

#[test]
fn those_that_hold_together_move_as_one() {
    for search in [Search::All, Search::Grid] {
        let (_, mut world) = pair_in_a_row(search);
        assert_eq!(world.attached(BodyId(0)), None);
        let at = |world: &World, body: u16| world.pose(BodyId(body)).position;
        // One robot pushes with 0.27 m/s, the other rests: both move at half of that.
        for motor in world.parts(0).motors {
            world.command(motor, [10.0, 0.0]);
        }
        let before = [at(&world, 0), at(&world, 1)];
        world.step();
        assert_eq!([0, 1, 2].map(|i| world.attached(BodyId(i))), [Some(BodyId(1)), None, None]);
        for i in 0..2 {
            let way = at(&world, i)[0] - before[usize::from(i)][0];
            assert!((way - 0.5 * 0.27 * 0.05).abs() < 1e-6, "{way}");
            assert!((world.velocity(BodyId(i)).linear[0] - 0.135).abs() < 1e-6);
        }
        // Whatever the wheels do, the distance stays. Each chassis turns by its own.
        let mut stream = Stream::new(4, Domain::Motor, 0, 0, 0);
        let mut turn = 0.0;
        for _ in 0..100 {
            let heading = world.pose(BodyId(1)).heading();
            let [left, right] = [stream.range(-4.0, 4.0), stream.range(-4.0, 4.0)];
            for (motor, speed) in world.parts(1).motors.into_iter().zip([left, right]) {
                world.command(motor, [speed, 0.0]);
            }
            world.step();
            let [a, b] = [at(&world, 0), at(&world, 1)];
            let distance = (a[0] - b[0]).hypot(a[1] - b[1]);
            assert!((distance - 0.18).abs() < 1e-5, "{distance}");
            let told = world.pose(BodyId(1)).heading() - heading;
            let wanted = if world.touches(PairId(0)) || world.touches(PairId(1)) {
                told
            } else {
                (right - left) * 0.027 / 0.1265 * 0.05
            };
            let off = told - wanted;
            assert!(off.abs() < 1e-5 || (off.abs() - std::f32::consts::TAU).abs() < 1e-5, "{told} {wanted}");
            turn += told.abs();
        }
        assert!(turn > 0.5);
        world.command(world.parts(0).attachment.unwrap(), [0.0, 0.0]);
        world.step();
        assert_eq!(world.attached(BodyId(0)), None);
    }
}

#[test]
fn a_wall_stops_all_that_hold_together() {
    for search in [Search::All, Search::Grid] {
        let (arena, mut world) = pair_in_a_row(search);
        for motor in world.parts(0).motors {
            world.command(motor, [10.0, 0.0]);
        }
        for _ in 0..400 {
            world.step();
        }
        let x = [0, 1].map(|i| world.pose(BodyId(i)).position[0]);
        assert!(x[1] > 1.9 && world.touches(PairId(1)) && (x[1] - x[0] - 0.18).abs() < 1e-4, "{x:?}");
        let before = words(&world);
        world.step();
        let poses = 5 * (arena.robots.len());
        assert_eq!(words(&world)[..poses], before[..poses], "both stand");
    }
}
