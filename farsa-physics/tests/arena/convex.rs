//! Convex obstacles of the planar world against oracles that look at every side in double precision.

use farsa_body::ports::{
    Actuated, Arrange, BodyId, Contacts, Hit, JointId, Kinematics, NearbySurface, PairId, PlanarHit, Rays, Sight,
    World as _,
};
use farsa_body::robots::MobileRobot;
use farsa_body::testing::{Probe, check_arrange, check_planar, check_rays, check_world};
use farsa_body::{Pose, Twist};
use farsa_num::{Domain, Stream};
use farsa_physics::arena::{Arena, CollisionRule, Convex, Cylinder, FreePlace, Search, Wall, World};
use proptest::prelude::*;

type Point2 = [f64; 2];

/// Convex polygons: corners of an ellipse at increasing angles, anywhere.
fn polygon(far: f64) -> impl Strategy<Value = Vec<Point2>> {
    let angles = prop::collection::vec(0.1..1.0_f64, 3..24);
    (angles, prop::array::uniform2(0.03..0.5_f64), prop::array::uniform2(-far..far), -3.2..3.2_f64).prop_map(
        |(parts, half, centre, heading)| {
            let whole: f64 = parts.iter().sum();
            let (s, c) = farsa_num::sin_cos(heading);
            let mut angle = 0.0;
            let corner = |part: f64| {
                angle += part / whole * std::f64::consts::TAU;
                let (y, x) = farsa_num::sin_cos(angle);
                let [x, y] = [half[0] * x, half[1] * y];
                [centre[0] + x * c - y * s, centre[1] + x * s + y * c]
            };
            parts.iter().copied().map(corner).collect()
        },
    )
}

fn sides(corners: &[Point2]) -> impl Iterator<Item = [Point2; 2]> + '_ {
    (0..corners.len()).map(|i| [corners[i], corners[(i + 1) % corners.len()]])
}

/// Signed distance to a counter-clockwise polygon: the nearest of many points would do, but slowly.
fn signed(corners: &[Point2], p: Point2) -> f64 {
    let mut nearest = f64::INFINITY;
    let mut within = true;
    for [a, b] in sides(corners) {
        let [e, q] = [[b[0] - a[0], b[1] - a[1]], [p[0] - a[0], p[1] - a[1]]];
        let along = ((q[0] * e[0] + q[1] * e[1]) / (e[0] * e[0] + e[1] * e[1])).clamp(0.0, 1.0);
        nearest = nearest.min((q[0] - along * e[0]).hypot(q[1] - along * e[1]));
        within &= e[0] * q[1] - e[1] * q[0] >= 0.0;
    }
    if within { -nearest } else { nearest }
}

/// Where a ray crosses a side first, side by side. `None` from within.
fn crossed(corners: &[Point2], p: Point2, way: Point2) -> Option<f64> {
    if signed(corners, p) < 0.0 {
        return None;
    }
    let cross = |a: Point2, b: Point2| a[0] * b[1] - a[1] * b[0];
    let hits = sides(corners).filter_map(|[a, b]| {
        let [e, q] = [[b[0] - a[0], b[1] - a[1]], [a[0] - p[0], a[1] - p[1]]];
        let bottom = cross(way, e);
        let (t, u) = (cross(q, e) / bottom, cross(q, way) / bottom);
        (bottom != 0.0 && t >= 0.0 && (0.0..=1.0).contains(&u)).then_some(t)
    });
    hits.min_by(f64::total_cmp)
}

/// Builds a world with a Khepera that starts without a contact.
fn with_robot(mut arena: Arena) -> World {
    arena.add_robot(MobileRobot::khepera(), [900.0, 900.0], 0.0);
    World::new(&arena).unwrap()
}

fn among(polygons: &[Vec<Point2>]) -> World {
    let mut arena = Arena::new();
    for corners in polygons {
        arena.add_convex(Convex::prism(corners, 0.2));
    }
    with_robot(arena)
}

fn narrow<const N: usize>(x: [f64; N]) -> [f32; N] {
    x.map(|x| x as f32)
}

fn put(world: &mut World, at: Point2) {
    world.place_body(BodyId(0), Pose::planar(narrow(at), 0.3), Twist::default());
    world.finish_placement();
}

/// Returns the rounding at such a distance [m].
fn close(corners: &[Point2]) -> f64 {
    1e-6 + 3e-7 * corners.iter().flatten().fold(0.0_f64, |most, x| most.max(x.abs()))
}

proptest! {
    #[test]
    fn near_tells_the_nearest_point(
        corners in polygon(20.0), off in prop::array::uniform2(-1.0..1.0_f64), range in 0.0..1.0_f64,
    ) {
        let world = among(std::slice::from_ref(&corners));
        let from = [corners[0][0] + off[0], corners[0][1] + off[1]];
        let slack = close(&corners);
        let gap = signed(&corners, from.map(|x| f64::from(x as f32)));
        let mut told: Vec<NearbySurface<BodyId>> = Vec::new();
        world.query_near(narrow(from), range as f32, &mut |near| told.push(near));
        prop_assume!((gap - range).abs() > slack);
        prop_assert_eq!(told.len(), usize::from(gap < range));
        if let [near] = told[..] {
            // No inside, as with walls.
            prop_assert!((f64::from(near.distance) - gap.max(0.0)).abs() < slack, "{near:?}: {gap}");
            let point = near.point.map(f64::from);
            prop_assert!(signed(&corners, point).abs() < slack || gap < 0.0);
            let away = (point[0] - from[0]).hypot(point[1] - from[1]);
            prop_assert!((away - gap.max(0.0)).abs() < slack);
            prop_assert!(near.body.is_none() && near.radius == 0.0 && near.color == [0.5; 3] && near.signal.is_none());
        }
    }

    #[test]
    fn rays_meet_the_first_side_that_they_cross(
        corners in polygon(5.0), off in prop::array::uniform2(-1.0..1.0_f64), heading in -3.2..3.2_f64,
        aimed in any::<bool>(),
    ) {
        let world = among(std::slice::from_ref(&corners));
        let from = [corners[0][0] + off[0], corners[0][1] + off[1]].map(|x| f64::from(x as f32));
        // Half of the rays go to a place within, so that many hit.
        let middle = [0, 1].map(|k| corners.iter().map(|c| c[k]).sum::<f64>() / corners.len() as f64 - from[k]);
        let heading = if aimed { farsa_num::atan2(middle[1], middle[0]) } else { heading };
        let (s, c) = farsa_num::sin_cos(heading);
        let way = [c, s].map(|x| f64::from(x as f32));
        let slack = close(&corners);
        prop_assume!(signed(&corners, from).abs() > slack);
        // A ray a little to either side of one that grazes a corner hits something else.
        let beside = [-1.0, 1.0].map(|k| [from[0] - k * 3.0 * slack * s, from[1] + k * 3.0 * slack * c]);
        let truths = [crossed(&corners, from, way), crossed(&corners, beside[0], way), crossed(&corners, beside[1], way)];
        let sight = world.cast_planar(narrow(from), narrow(way), 3.0, None);
        let level = world.cast([from[0] as f32, from[1] as f32, 0.1], [way[0] as f32, way[1] as f32, 0.0], 3.0);
        prop_assert_eq!(sight.is_some(), level.is_some());
        if truths.iter().all(Option::is_none) {
            prop_assert!(sight.is_none(), "{sight:?}");
        } else if truths.iter().all(Option::is_some) {
            let [low, high] = [f64::min, f64::max].map(|pick| truths.iter().flatten().copied().reduce(pick).unwrap());
            let (sight, level) = (sight.unwrap(), level.unwrap());
            let within = |x: f32| f64::from(x) > low - 10.0 * slack && f64::from(x) < high + 10.0 * slack;
            prop_assert!(within(sight.distance) && within(level.distance), "{sight:?} {level:?}: {truths:?}");
            prop_assert!(sight.body.is_none() && level.body.is_none() && level.normal[2] == 0.0);
            let inwards = level.normal[0] * way[0] as f32 + level.normal[1] * way[1] as f32;
            prop_assert!(inwards < 0.0 && (level.normal[0].hypot(level.normal[1]) - 1.0).abs() < 1e-6);
        }
        // Over it, under range, and down onto it.
        let shot = |z: f32, down: f32| world.cast([from[0] as f32, from[1] as f32, z], [0.0, 0.0, down], 3.0);
        prop_assert!(world.cast([from[0] as f32, from[1] as f32, 0.21], [way[0] as f32, way[1] as f32, 0.0], 3.0).is_none());
        let floor = if signed(&corners, from) < 0.0 { 0.2 } else { 0.0 };
        prop_assert!((shot(1.0, -1.0).unwrap().distance - (1.0 - floor)).abs() < 1e-6);
    }

    #[test]
    fn a_robot_touches_what_its_disc_overlaps(corners in polygon(20.0), off in prop::array::uniform2(-0.6..0.6_f64)) {
        let mut world = among(std::slice::from_ref(&corners));
        let at = [corners[0][0] + off[0], corners[0][1] + off[1]].map(|x| f64::from(x as f32));
        let gap = signed(&corners, at);
        let slack = close(&corners);
        prop_assume!((gap - 0.035).abs() > slack);
        put(&mut world, at);
        world.step();
        prop_assert_eq!(world.touches(PairId(0)), gap < 0.035, "{}", gap);
        let contact = world.pair_contact(PairId(0));
        if gap < 0.035 && gap.abs() > 10.0 * slack {
            prop_assert!((f64::from(contact.depth) - (0.035 - gap)).abs() < slack, "{contact:?} {gap}");
            let out = [0, 1].map(|k| f64::from(contact.force[k]));
            // Following the way out, it is free.
            let freed = [0, 1].map(|k| at[k] + out[k] * (0.035 - gap));
            prop_assert!((signed(&corners, freed) - 0.035).abs() < 3.0 * slack, "{contact:?} {gap}");
            prop_assert_eq!(world.pair_bodies(PairId(0)), [Some(BodyId(0)), None]);
        }
    }

    #[test]
    fn a_box_is_the_wall(
        centre in prop::array::uniform2(-2.0..2.0_f64), size in prop::array::uniform2(0.02..0.6_f64),
        heading in -3.2..3.2_f64, off in prop::array::uniform2(-0.7..0.7_f64), look in -3.2..3.2_f64, slope in -1.5..1.5_f64,
        z in 0.001..0.3_f64,
    ) {
        let [a, b] = size.map(|x| 0.5 * x);
        let corners = [[-a, -b], [-a, b], [a, b], [a, -b]];
        let mut walls = Arena::new();
        walls.add_wall(Wall::cuboid(centre, size, heading).with_height(0.2));
        let mut boxes = Arena::new();
        boxes.add_convex(Convex::prism(&corners, 0.2).placed(centre, heading));
        let mut worlds = [walls, boxes].map(with_robot);
        let from = [centre[0] + off[0], centre[1] + off[1]];
        let ((s, c), (up, level)) = (farsa_num::sin_cos(look), farsa_num::sin_cos(slope));
        // Nothing that is decided by rounding.
        let edges: Vec<Point2> = corners.iter().rev().copied().collect();
        let (hs, hc) = farsa_num::sin_cos(heading);
        let own = |p: Point2| [p[0] * hc + p[1] * hs, p[1] * hc - p[0] * hs];
        let gap = signed(&edges, own(off));
        let corner = corners.map(|q| {
            let p = own(off);
            let way = own([c, s]);
            ((q[0] - p[0]) * way[1] - (q[1] - p[1]) * way[0]).abs()
        });
        prop_assume!(corner.iter().all(|x| *x > 1e-5) && gap.abs() > 1e-5 && (gap - 0.035).abs() > 1e-5);
        let sights: [Option<PlanarHit<BodyId>>; 2] =
            [0, 1].map(|i| worlds[i].cast_planar(narrow(from), [c as f32, s as f32], 3.0, None));
        prop_assert_eq!(sights[0].is_some(), sights[1].is_some());
        if let [Some(wall), Some(convex)] = sights {
            prop_assert!((wall.distance - convex.distance).abs() < 1e-4 && wall.color == convex.color);
        }
        let origin = [from[0] as f32, from[1] as f32, z as f32];
        let hits: [Option<Hit<BodyId>>; 2] =
            [0, 1].map(|i| worlds[i].cast(origin, narrow([c * level, s * level, up]), 3.0));
        match hits {
            // A ray may hit the ground or an edge instead of a neighboring face, within rounding.
            [Some(wall), Some(convex)] => prop_assert!((wall.distance - convex.distance).abs() < 1e-3, "{hits:?}"),
            [a, b] => prop_assert!(a.is_none() && b.is_none(), "{hits:?}"),
        }
        let mut near = [None; 2];
        for (world, near) in worlds.iter().zip(&mut near) {
            world.query_near(narrow(from), 0.5, &mut |told| *near = Some((told.distance, told.point)));
        }
        if let [Some(wall), Some(convex)] = near {
            prop_assert!((wall.0 - convex.0).abs() < 2e-6);
            // Next to a corner two points are equally near to rounding. With relative error e, they are sqrt(2 e) of
            // the distance apart.
            let slack = 2e-6 + 7e-4 * wall.0;
            prop_assert!((0..2).all(|k| (wall.1[k] - convex.1[k]).abs() < slack), "{near:?}");
        }
        let rings = [0, 1].map(|i| {
            put(&mut worlds[i], from);
            let mut ring = [0.0; 8];
            worlds[i].infrared(0, &mut ring);
            ring
        });
        prop_assert!(rings[0].iter().zip(rings[1]).all(|(a, b)| (a - b).abs() < 1e-3), "{rings:?}");
        worlds.iter_mut().for_each(farsa_body::ports::World::step);
        let contacts = [0, 1].map(|i| worlds[i].pair_contact(PairId(0)));
        prop_assert!((contacts[0].depth - contacts[1].depth).abs() < 2e-6, "{contacts:?}");
    }
}

/// Obstacles of three to ten corners among robots on a lattice.
fn crowd(robots: usize, search: Search, collisions: CollisionRule) -> Arena {
    let side = (robots as f64).sqrt().ceil() as usize + 1;
    let pitch = 0.13;
    let mut arena = Arena { search, collisions, ..Arena::walled(pitch * side as f64, pitch * side as f64) };
    let mut stream = Stream::new(8, Domain::Start, 0, 0, 0);
    let mut free = robots;
    for i in 0..side * side {
        let at = [pitch * (0.5 + (i % side) as f64), pitch * (0.5 + (i / side) as f64)];
        if i % 3 == 1 {
            let count = 3 + i % 8;
            let corner = |k: usize| {
                let (y, x) = farsa_num::sin_cos(std::f64::consts::TAU * k as f64 / count as f64);
                [0.045 * x, 0.02 * y]
            };
            let corners: Vec<Point2> = (0..count).map(corner).collect();
            arena.add_convex(Convex::prism(&corners, 0.05).placed(at, stream.range_f64(-3.0, 3.0)));
        } else if free > 0 {
            free -= 1;
            arena.add_robot(MobileRobot::khepera(), at, stream.range_f64(-3.0, 3.0));
        }
    }
    arena
}

fn babble(world: &mut World, stream: &mut Stream) {
    for robot in 0..world.robots() {
        for motor in world.parts(robot).motors {
            world.command(motor, [stream.range(-3.0, 7.0), 0.0]);
        }
    }
}

#[test]
fn nobody_is_ever_left_inside_an_obstacle() {
    for collisions in [CollisionRule::Revert, CollisionRule::Circles] {
        for robots in [1, 6, 60] {
            let arena = crowd(robots, Search::Auto, collisions);
            let outlines: Vec<Vec<Point2>> = arena.convexes.iter().map(Convex::outline).collect();
            let mut world = World::new(&arena).unwrap();
            let mut stream = Stream::new(1, Domain::Motor, 0, 0, 0);
            let (mut obstacles, mut moved, mut nearest) = (0, 0.0, f64::INFINITY);
            for step in 0..2000 {
                if step % 10 == 0 {
                    babble(&mut world, &mut stream);
                }
                let before = world.pose(BodyId(0)).position;
                world.step();
                let after = world.pose(BodyId(0)).position;
                moved += (after[0] - before[0]).hypot(after[1] - before[1]);
                for robot in 0..world.robots() {
                    let at = world.pose(BodyId(robot as u16)).position;
                    let at = [f64::from(at[0]), f64::from(at[1])];
                    let gap = outlines.iter().map(|outline| signed(outline, at)).fold(f64::INFINITY, f64::min);
                    nearest = nearest.min(gap - 0.035);
                    assert!(gap > 0.035 - 1e-6, "{collisions:?}, {robots}, step {step}: {gap}");
                    let pair = PairId(robot as u16);
                    // The body of the contact is one of those at this distance.
                    let met = world.touches(pair) && world.pair_bodies(pair)[1].is_none();
                    obstacles += usize::from(met && gap < 0.04);
                }
            }
            println!("{collisions:?}: {robots} robots met obstacles {obstacles} times, went {moved} m, to {nearest} m");
            assert!(obstacles > 50 && moved > 0.5);
        }
    }
}

#[test]
fn the_grid_changes_no_bit_among_obstacles() {
    for collisions in [CollisionRule::Revert, CollisionRule::Circles] {
        let [mut all, mut grid] =
            [Search::All, Search::Grid].map(|search| World::new(&crowd(40, search, collisions)).unwrap());
        let mut streams = [Stream::new(2, Domain::Motor, 0, 0, 0); 2];
        for step in 0..500 {
            if step % 8 == 0 {
                babble(&mut all, &mut streams[0]);
                babble(&mut grid, &mut streams[1]);
            }
            all.step();
            grid.step();
            for robot in 0..all.robots() {
                let body = BodyId(robot as u16);
                assert_eq!(all.pose(body), grid.pose(body), "{collisions:?}, step {step}");
                let mut rings = [[0.0_f32; 8]; 2];
                all.infrared(robot, &mut rings[0]);
                grid.infrared(robot, &mut rings[1]);
                assert_eq!(rings[0].map(f32::to_bits), rings[1].map(f32::to_bits));
            }
        }
    }
}

/// A robot of each kind among obstacles, with a hull where there is parry.
fn mixed() -> Arena {
    let mut arena = Arena::walled(0.9, 0.8);
    arena.time_step = 0.1;
    let hexagon: [Point2; 6] = core::array::from_fn(|i| {
        let (y, x) = farsa_num::sin_cos(std::f64::consts::TAU * i as f64 / 6.0);
        [0.06 * x, 0.06 * y]
    });
    arena.add_convex(Convex::prism(&hexagon, 0.1).placed([0.42, 0.4], 0.2).with_color([1.0, 0.0, 0.0]));
    arena.add_convex(Convex::prism(&[[0.9, 0.8], [0.8, 0.8], [0.9, 0.7]], 0.2));
    if cfg!(feature = "parry") {
        let pyramid = [[-0.05, -0.05, 0.0], [0.05, -0.05, 0.0], [0.05, 0.05, 0.0], [-0.05, 0.05, 0.0], [0.0, 0.0, 0.1]];
        arena.add_convex(Convex::hull(&pyramid).placed([0.15, 0.6], 0.5));
    }
    arena.add_cylinder(Cylinder { lamp: 2.0, ..Cylinder::new([0.65, 0.6], 0.05) });
    arena.add_robot(MobileRobot::khepera(), [0.15, 0.3], 0.3);
    arena.add_robot(MobileRobot::e_puck(), [0.45, 0.6], -2.0);
    arena.add_robot(MobileRobot::marxbot(), [0.7, 0.3], 1.9);
    arena
}

#[test]
fn an_arena_with_obstacles_conforms() {
    for collisions in [CollisionRule::Revert, CollisionRule::Circles] {
        for search in [Search::All, Search::Grid] {
            let arena = Arena { collisions, search, ..mixed() };
            let bodies: Vec<BodyId> = (0..4).map(BodyId).collect();
            let wheels = (0..3).flat_map(|robot| {
                let most = arena.robots[robot].robot.max_wheel_speed as f32;
                arena.parts(robot).motors.map(|motor| (motor, [[-most, 0.0], [most, 0.0]]))
            });
            let probe = Probe {
                planar: bodies.clone(),
                joints: (0..6).map(|joint| (JointId(joint), [-3.0, 3.0])).collect(),
                actuators: wheels.collect(),
                steps: 400,
                bodies: bodies.clone(),
                ..Probe::numbered(0, [[0.0; 2]; 2])
            };
            let make = || World::new(&arena).unwrap();
            assert_eq!(check_world(make, &probe), Ok(()), "{collisions:?} {search:?}");
            assert_eq!(check_arrange(make, &probe), Ok(()), "{collisions:?} {search:?}");
            let origins = [[0.3, 0.2, 0.02], [0.42, 0.4, 0.3], [-0.2, 0.4, 0.05], [0.15, 0.6, 0.2], [0.42, 0.4, 0.05]];
            let places = [[0.3, 0.2], [0.42, 0.4], [0.15, 0.68], [0.83, 0.77], [0.52, 0.42]];
            for range in [0.2, 2.0, f32::INFINITY] {
                assert_eq!(check_rays(&make(), &bodies, &origins, range), Ok(()), "{search:?}");
            }
            for range in [0.2, 2.0] {
                assert_eq!(check_planar(&make(), &bodies, &places, range), Ok(()), "{search:?}");
            }
        }
    }
}

#[test]
fn free_places_keep_from_obstacles() {
    let arena = mixed();
    let world = World::new(&arena).unwrap();
    let mut stream = Stream::new(1, Domain::Start, 0, 0, 0);
    let free = FreePlace { walls: 0.02, ..FreePlace::new([[0.0, 0.0], [0.9, 0.8]], 0.035) };
    let mut close = 0;
    for _ in 0..2000 {
        let at = free.find(&world, &mut stream).unwrap().map(f64::from);
        let gap = arena.convexes.iter().map(|convex| signed(&convex.outline(), at)).fold(f64::INFINITY, f64::min);
        assert!(gap > 0.055 - 1e-6, "{at:?} {gap}");
        close += usize::from(gap < 0.065);
    }
    assert!(close > 20, "{close}");
}

#[test]
fn no_number_is_near_no_obstacle() {
    let mut world = among(&[vec![[0.1, 0.1], [0.3, 0.1], [0.2, 0.3]]]);
    world.place_body(BodyId(0), Pose::planar([f32::NAN, 0.3], 0.0), Twist::default());
    world.finish_placement();
    world.step();
    assert!(!world.touches(PairId(0)));
    for from in [[f32::NAN, 0.1], [f32::INFINITY, 0.1], [1e30, -1e30]] {
        world.query_near(from, 0.5, &mut |near| assert!(near.body.is_some(), "{near:?}"));
        assert!(world.cast_planar(from, [1.0, 0.0], 0.5, None).is_none_or(|sight| sight.body.is_some()));
        assert!(world.cast([from[0], from[1], 0.05], [1.0, 0.0, 0.0], 0.5).is_none_or(|hit| hit.body.is_some()));
    }
}
