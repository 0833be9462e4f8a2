//! Sensors read the same in the arena as in the naive world of the plane, which is its second implementation.

use crate::channels::{every_motor, every_sensor};
use farsa_body::ports::{Actuated, BodyId, Sensor};
use farsa_body::robots::MobileRobot;
use farsa_body::sensors::infrared::InfraredFormula;
use farsa_body::testing::{PlaneWorld, check_motor, check_planar, check_sensor};
use farsa_num::{Domain, Stream};
use farsa_physics::arena::{Area, Arena, Cylinder, Search, Wall, World};

const SIZE: f64 = 1.2;

/// Returns the scene in both worlds, drawn at random: two robots, two cylinders, a lamp.
fn scene(robot: &MobileRobot, search: Search, seed: u64) -> (World, PlaneWorld) {
    let mut stream = Stream::new(seed, Domain::Start, 0, 0, 0);
    // Around the first robot, near enough to be felt, without overlaps.
    let widest = farsa_num::Scalar::max(robot.radius, 0.05);
    let mut place = || {
        let middle = [0.5 * SIZE; 2];
        let (apart, bearing) = (robot.radius + widest + stream.range_f64(0.001, 0.15), stream.range_f64(-3.2, 3.2));
        let (sine, cosine) = farsa_num::sin_cos(bearing);
        [middle[0] + apart * cosine, middle[1] + apart * sine]
    };
    let places = loop {
        let places: [[f64; 2]; 5] = core::array::from_fn(|i| if i == 0 { [0.5 * SIZE; 2] } else { place() });
        let apart = |[a, b]: [f64; 2], [c, d]: [f64; 2]| (a - c) * (a - c) + (b - d) * (b - d);
        let least = (robot.radius + widest) * (robot.radius + widest);
        if (0..5).all(|i| (0..i).all(|j| apart(places[i], places[j]) > least)) {
            break places;
        }
    };
    let headings = [stream.range_f64(-3.0, 3.0), stream.range_f64(-3.0, 3.0)];
    let mut arena = Arena::walled(SIZE, SIZE);
    arena.search = search;
    arena.ground = [0.0; 3];
    let mut plane = PlaneWorld::new();
    for wall in arena.walls.clone() {
        let [w, h] = wall.size.map(|x| 0.5 * x as f32);
        let [x, y] = wall.centre.map(|x| x as f32);
        let corners = [[x - w, y - h], [x + w, y - h], [x + w, y + h], [x - w, y + h]];
        // The arena's wall is one surface. Here it is the side that looks inwards.
        let inner = (0..4).map(|i| [corners[i], corners[(i + 1) % 4]]).min_by(|a, b| {
            let off = |s: &[[f32; 2]; 2]| {
                let m = [0.5 * (s[0][0] + s[1][0]) - 0.6, 0.5 * (s[0][1] + s[1][1]) - 0.6];
                m[0] * m[0] + m[1] * m[1]
            };
            off(a).total_cmp(&off(b))
        });
        plane.add_wall(inner.unwrap(), wall.color.map(|x| x as f32));
    }
    let at = |i: usize| places[i].map(|x| x as f32);
    for i in 0..2 {
        arena.add_robot(robot.clone(), places[i], headings[i]);
        plane.add_robot(robot, at(i), headings[i] as f32);
    }
    for (i, (radius, color, lamp)) in
        [(0.0125, [1.0, 0.0, 0.0], 0.0), (0.05, [0.0, 0.0, 1.0], 0.0), (0.02, [1.0; 3], 2.0)].into_iter().enumerate()
    {
        arena.add_cylinder(Cylinder { color, lamp, ..Cylinder::new(places[2 + i], radius) });
        if lamp > 0.0 {
            plane.add_lamp(at(2 + i), radius as f32, lamp as f32);
        } else {
            plane.add_disc(at(2 + i), radius as f32, color.map(|x: f64| x as f32));
        }
    }
    arena.add_area(Area::circle([0.5, 0.5], 0.3, [0.2, 0.5, 0.9]));
    plane.add_area([0.5, 0.5], 0.3, [0.2, 0.5, 0.9]);
    let mut world = World::new(&arena).unwrap();
    // LEDs and signals are shown from the next step on.
    let parts = world.parts(1);
    for (i, actuator) in parts.leds.into_iter().flatten().chain(parts.signal).enumerate() {
        world.command(actuator, [[1.0, 0.0, 0.2, 0.75][i], 0.0]);
        plane.command(actuator, [[1.0, 0.0, 0.2, 0.75][i], 0.0]);
    }
    farsa_body::ports::World::step(&mut world);
    (world, plane)
}

#[test]
fn sensors_read_the_same_in_both_worlds() {
    for robot in [MobileRobot::khepera(), MobileRobot::e_puck(), MobileRobot::marxbot()] {
        for search in [Search::All, Search::Grid] {
            let (mut channels, mut grazed) = (0, 0);
            let mut awake = [0.0_f32; 16];
            for seed in 0..100 {
                let (arena, plane) = scene(&robot, search, seed);
                let parts = arena.parts(0);
                let pairs =
                    every_sensor::<World>(&robot, &parts).into_iter().zip(every_sensor::<PlaneWorld>(&robot, &parts));
                for (index, ((name, close, mut here), (_, _, mut there))) in pairs.enumerate() {
                    assert_eq!(check_sensor(here.as_mut(), &arena), Ok(()), "{name}");
                    let (mut a, mut b) = (vec![0.0; here.channels()], vec![0.0; there.channels()]);
                    here.read(&arena, &mut a);
                    there.read(&plane, &mut b);
                    awake[index] += a.iter().sum::<f32>();
                    channels += a.len();
                    // A ray that grazes an edge may miss it in one of them, a table's row may be the next one.
                    let other = a.iter().zip(&b).filter(|(x, y)| (**x - **y).abs() > close).count();
                    grazed += other;
                    assert!(other <= 8, "{} {name}, seed {seed}: {a:?} {b:?}", robot.name);
                }
                let mut ring = vec![0.0; robot.infrared.angles.len()];
                arena.infrared(0, &mut ring);
                let mut sensor = InfraredFormula::for_robot(&robot, parts.body).unwrap();
                let mut read = ring.clone();
                sensor.read(&arena, &mut read);
                for (x, y) in ring.iter().zip(&read) {
                    assert!((x - y).abs() < 1e-5, "{} seed {seed}: {ring:?} {read:?}", robot.name);
                }
            }
            println!("{} {search:?}: {grazed} of {channels} channels differ; awake {awake:?}", robot.name);
            assert!(grazed * 1000 < channels, "{} {search:?}: {grazed} of {channels}", robot.name);
        }
    }
}

#[test]
fn the_arena_shows_what_every_plane_shows() {
    for search in [Search::All, Search::Grid] {
        for seed in 0..20 {
            let (arena, _) = scene(&MobileRobot::marxbot(), search, seed);
            let bodies: Vec<BodyId> = (0..6).map(BodyId).collect();
            let places = [[0.1, 0.1], [0.6, 0.6], [0.3, 0.9], [1.0, 0.5]];
            for range in [0.3, 2.0] {
                assert_eq!(check_planar(&arena, &bodies, &places, range), Ok(()), "{search:?} {seed} {range}");
            }
        }
    }
}

#[test]
fn motors_keep_their_promises() {
    let robot = MobileRobot::marxbot();
    let make = || {
        let mut arena = Arena::walled(SIZE, SIZE);
        arena.add_wall(Wall::segment([0.1, 0.1], [0.3, 0.1], 0.02));
        arena.add_robot(robot.clone(), [0.6, 0.6], 0.3);
        World::new(&arena).unwrap()
    };
    let parts = make().parts(0);
    for (i, motor) in every_motor::<World>(&robot, &parts).iter_mut().enumerate() {
        assert_eq!(check_motor(motor.as_mut(), make), Ok(()), "motor {i}");
    }
}
