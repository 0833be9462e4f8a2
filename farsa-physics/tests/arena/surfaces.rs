//! Surfaces, rays, ground and lamps of the planar world against oracles that look at everything in small steps.

use farsa_body::ports::{Actuated, Arrange, BodyId, Kinematics, Lamp, NearbySurface, Planar, Rays, Sight, World as _};
use farsa_body::robots::MobileRobot;
use farsa_body::{Pose, Twist};
use farsa_physics::arena::{Area, Arena, Cylinder, Search, Wall, World};
use proptest::prelude::*;

/// The draws of a scene.
#[derive(Clone, Debug)]
struct Scene {
    walls: Vec<([f64; 2], [f64; 2], f64)>,
    robots: Vec<[f64; 3]>,
    cylinders: Vec<([f64; 2], f64)>,
}

fn scene() -> impl Strategy<Value = Scene> {
    let at = || prop::array::uniform2(-1.0..1.0);
    let walls = prop::collection::vec((at(), prop::array::uniform2(0.02..0.6), -4.0..4.0), 0..6);
    let robots = prop::collection::vec(prop::array::uniform3(-1.0..1.0), 1..4);
    (walls, robots, prop::collection::vec((at(), 0.01..0.2), 0..5)).prop_map(|(walls, robots, cylinders)| Scene {
        walls,
        robots,
        cylinders,
    })
}

impl Scene {
    /// The world. Its bodies are put where they belong afterwards, since here they may overlap.
    fn build(&self, search: Search) -> (Arena, World) {
        let mut arena = Arena { search, ..Arena::new() };
        for (centre, size, heading) in &self.walls {
            arena.add_wall(Wall::cuboid(*centre, *size, *heading).with_height(0.2));
        }
        for i in 0..self.robots.len() {
            arena.add_robot(MobileRobot::khepera(), [10.0 + i as f64, 0.0], 0.0);
        }
        for (i, (_, radius)) in self.cylinders.iter().enumerate() {
            arena.add_cylinder(Cylinder::new([10.0 + i as f64, 5.0], *radius));
        }
        let mut world = World::new(&arena).unwrap();
        for (i, [x, y, heading]) in self.robots.iter().enumerate() {
            let pose = Pose::planar([*x, *y], *heading).cast();
            world.place_body(BodyId(i as u16), pose, Twist::default());
        }
        for (i, (at, _)) in self.cylinders.iter().enumerate() {
            world.place_body(arena.cylinder(i), Pose::planar(*at, 0.0).cast(), Twist::default());
        }
        world.finish_placement();
        (arena, world)
    }

    /// Signed distance to the surface of a wall and of a body at a place [m], each with its body.
    fn distances(&self, arena: &Arena, [x, y]: [f64; 2]) -> Vec<(Option<BodyId>, f64)> {
        let wall = |(centre, size, heading): &([f64; 2], [f64; 2], f64)| {
            let [u, v] = [x - centre[0], y - centre[1]];
            let (sine, cosine) = farsa_num::sin_cos(*heading);
            let [a, b] = [(u * cosine + v * sine).abs() - 0.5 * size[0], (v * cosine - u * sine).abs() - 0.5 * size[1]];
            (None, a.max(0.0).hypot(b.max(0.0)) + a.max(b).min(0.0))
        };
        let robots = self.robots.iter().enumerate().map(|(i, [a, b, _])| (Some(BodyId(i as u16)), [*a, *b], 0.035));
        let cylinders = self.cylinders.iter().enumerate().map(|(i, (at, r))| (Some(arena.cylinder(i)), *at, *r));
        let discs = robots.chain(cylinders).map(|(body, [a, b], radius)| (body, (x - a).hypot(y - b) - radius));
        self.walls.iter().map(wall).chain(discs).collect()
    }
}

proptest! {
    #[test]
    fn near_tells_every_surface_within_range_and_no_other(
        scene in scene(), from in prop::array::uniform2(-1.2_f64..1.2), range in 0.0_f64..1.0, grid in any::<bool>(),
    ) {
        let (arena, world) = scene.build(if grid { Search::Grid } else { Search::All });
        let mut told: Vec<NearbySurface<BodyId>> = Vec::new();
        world.query_near(from.map(|x| x as f32), range as f32, &mut |near| told.push(near));
        let mut told = told.into_iter().peekable();
        for (body, distance) in scene.distances(&arena, from) {
            // A wall has no inside: there its distance is 0.
            let wanted = if body.is_none() { distance.max(0.0) } else { distance };
            if (wanted - range).abs() < 1e-5 {
                told.next_if(|near| near.body == body);
                continue;
            }
            if wanted > range {
                continue;
            }
            let near = told.next().unwrap();
            prop_assert!(near.body == body && (f64::from(near.distance) - wanted).abs() < 1e-5, "{:?}: {}", near, wanted);
            let point = near.point.map(f64::from);
            let away = (point[0] - from[0]).hypot(point[1] - from[1]);
            prop_assert!((away - wanted.abs()).abs() < 1e-5);
            let there = scene.distances(&arena, point);
            prop_assert!(body.is_none() && distance < 0.0 || there.iter().any(|(b, d)| *b == body && d.abs() < 1e-5));
            let radius = if body.is_some_and(|body| body.index() < scene.robots.len()) { 0.035 } else { near.radius };
            prop_assert!(near.radius == radius && near.signal.is_none());
        }
        prop_assert!(told.next().is_none());
    }

    #[test]
    fn what_is_seen_is_what_marching_meets(
        scene in scene(), from in prop::array::uniform2(-1.2_f64..1.2), heading in -3.2_f64..3.2, grid in any::<bool>(),
        but in 0..3_u16,
    ) {
        let (arena, world) = scene.build(if grid { Search::Grid } else { Search::All });
        let (sine, cosine) = farsa_num::sin_cos(heading);
        let range = 2.0;
        let sight = world.cast_planar(from.map(|x| x as f32), [cosine as f32, sine as f32], range as f32, Some(BodyId(but)));
        // Bodies around the start are invisible.
        let inside: Vec<bool> = scene.distances(&arena, from).iter().map(|(_, d)| *d < 0.0).collect();
        prop_assume!(scene.distances(&arena, from).iter().all(|(_, d)| d.abs() > 1e-4));
        let nearest = |t: f64| {
            let all = scene.distances(&arena, [from[0] + t * cosine, from[1] + t * sine]);
            let seen = all.into_iter().zip(&inside).filter(|((body, _), inside)| !**inside && *body != Some(BodyId(but)));
            seen.map(|(x, _)| x).min_by(|a, b| a.1.total_cmp(&b.1))
        };
        let (mut t, mut met, mut grazed) = (0.0, None, false);
        while t <= range {
            let Some((body, gap)) = nearest(t) else { break };
            if gap < 1e-7 {
                met = Some((t, body));
                break;
            }
            grazed |= gap < 1e-4;
            t += gap;
        }
        match (sight, met) {
            (Some(sight), Some((t, body))) if !grazed || (f64::from(sight.distance) - t).abs() < 1e-3 => {
                prop_assert!((f64::from(sight.distance) - t).abs() < 2e-3, "{:?} {}", sight, t);
                prop_assert!(sight.body == body || (f64::from(sight.distance) - t).abs() < 1e-5);
            }
            (None, None) => {}
            // Rounding may let a ray pass what it grazes, and end short of the range.
            _ => prop_assert!(grazed || (t - range).abs() < 1e-3, "{:?} {:?}", sight, met),
        }
        // In space, level and below every robot's height, the result is equal, and a ray above everything hits nothing.
        let cast = |z: f32| world.cast([from[0] as f32, from[1] as f32, z], [cosine as f32, sine as f32, 0.0], range as f32);
        let flat = world.cast_planar(from.map(|x| x as f32), [cosine as f32, sine as f32], range as f32, None);
        let hit = cast(0.02);
        prop_assert_eq!(hit.is_some(), flat.is_some());
        if let (Some(hit), Some(flat)) = (hit, flat) {
            prop_assert!((hit.distance - flat.distance).abs() < 1e-4 && hit.normal[2] == 0.0);
        }
        prop_assert!(cast(0.3).is_none());
    }

    #[test]
    fn rays_in_space_meet_what_marching_meets(
        scene in scene(), from in prop::array::uniform2(-1.2_f64..1.2), z in 0.001_f64..0.4, heading in -3.2_f64..3.2,
        slope in -1.5_f64..1.5,
    ) {
        let (arena, world) = scene.build(Search::Auto);
        let ((sine, cosine), (up, level)) = (farsa_num::sin_cos(heading), farsa_num::sin_cos(slope));
        let way = [cosine * level, sine * level, up];
        let [x, y] = from;
        let hit = world.cast([x as f32, y as f32, z as f32], way.map(|w| w as f32), 3.0);
        let height = |body: Option<BodyId>| match body {
            None => 0.2,
            Some(body) if body.index() < scene.robots.len() => 0.03,
            Some(_) => Wall::HEIGHT,
        };
        // Distances to upright prisms from the plane's, and to the ground.
        let gaps = |t: f64| {
            let p = [x + t * way[0], y + t * way[1], z + t * way[2]];
            let all = scene.distances(&arena, [p[0], p[1]]).into_iter().map(move |(body, d)| {
                let h = p[2] - height(body);
                (body, d.max(0.0).hypot(h.max(0.0)) + d.max(h).min(0.0))
            });
            all.chain([(None, p[2])]).collect::<Vec<_>>()
        };
        let start = gaps(0.0);
        prop_assume!(start.iter().all(|(_, gap)| gap.abs() > 1e-4));
        let (mut t, mut met, mut grazed) = (0.0, None, false);
        while t <= 3.0 {
            let seen = gaps(t).into_iter().zip(&start).filter(|(_, (_, gap))| *gap > 0.0);
            let (body, gap) = seen.map(|(x, _)| x).min_by(|a, b| a.1.total_cmp(&b.1)).unwrap();
            if gap < 1e-7 {
                met = Some((t, body));
                break;
            }
            grazed |= gap < 1e-4;
            t += gap;
        }
        match (hit, met) {
            (Some(hit), Some((t, body))) if !grazed || (f64::from(hit.distance) - t).abs() < 1e-3 => {
                prop_assert!((f64::from(hit.distance) - t).abs() < 2e-3, "{:?} {}", hit, t);
                prop_assert!(hit.body == body || (f64::from(hit.distance) - t).abs() < 1e-5);
            }
            (None, None) => {}
            _ => prop_assert!(grazed || (t - 3.0).abs() < 1e-3, "{:?} {:?}", hit, met),
        }
    }
}

#[test]
fn the_last_area_is_seen_where_it_lies() {
    let mut arena = Arena::walled(1.0, 1.0);
    arena.ground = [0.9, 0.8, 0.7];
    arena.add_robot(MobileRobot::khepera(), [0.9, 0.9], 0.0);
    arena.add_area(Area::circle([0.3, 0.3], 0.1, [1.0, 0.0, 0.0]));
    arena.add_area(Area::rectangle([0.3, 0.3], [0.2, 0.02], 0.0, [0.0, 0.0, 1.0]));
    let mut world = World::new(&arena).unwrap();
    let colours = [[0.35, 0.305], [0.35, 0.32], [0.3, 0.39], [0.3, 0.41]].map(|at| world.ground(at));
    assert_eq!(colours, [[0.0, 0.0, 1.0], [1.0, 0.0, 0.0], [1.0, 0.0, 0.0], [0.9, 0.8, 0.7]]);
    // Turned by a quarter and moved aside.
    let pose = Pose::planar([0.6, 0.5], std::f32::consts::FRAC_PI_2);
    world.place_body(arena.area(1), pose, Twist::default());
    world.finish_placement();
    assert_eq!(world.ground([0.605, 0.59]), [0.0, 0.0, 1.0]);
    assert_eq!(world.ground([0.65, 0.5]), [0.9, 0.8, 0.7]);
    assert!((world.pose(arena.area(1)).heading() - std::f32::consts::FRAC_PI_2).abs() < 1e-6);
    // There is nothing on the ground there.
    world.query_near([0.6, 0.5], 0.2, &mut |near| panic!("{near:?}"));
}

#[test]
fn lamps_are_told_where_they_stand_and_leds_are_seen() {
    let mut arena = Arena::walled(1.0, 1.0);
    arena.add_robot(MobileRobot::e_puck(), [0.5, 0.5], 0.0);
    arena.add_cylinder(Cylinder::new([0.2, 0.2], 0.01));
    arena.add_cylinder(Cylinder { lamp: 3.0, ..Cylinder::new([0.8, 0.2], 0.01) });
    let mut world = World::new(&arena).unwrap();
    world.place_body(arena.cylinder(1), Pose::planar([0.7, 0.3], 0.0), Twist::default());
    world.finish_placement();
    let mut lamps = Vec::new();
    world.lamps(&mut |lamp| lamps.push(lamp));
    assert_eq!(lamps, [Lamp { body: arena.cylinder(1), position: [0.7, 0.3], intensity: 3.0 }]);
    let [red, ..] = world.parts(0).leds.unwrap();
    world.command(red, [1.0, 0.0]);
    world.step();
    let sight = world.cast_planar([0.2, 0.5], [1.0, 0.0], 1.0, None).unwrap();
    assert_eq!((sight.body, sight.color), (Some(BodyId(0)), [1.0, 0.0, 0.0]));
    assert!((sight.distance - 0.265).abs() < 1e-6);
    let behind = world.cast_planar([0.2, 0.5], [1.0, 0.0], 1.0, Some(BodyId(0))).unwrap();
    assert_eq!((behind.body, behind.color), (None, Wall::COLOR.map(|x| x as f32)));
}
