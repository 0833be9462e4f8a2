//! What no planar world is built from, and places that there are not.
#![allow(missing_docs, clippy::unwrap_used)]

use farsa_body::{BodyId, MobileRobot, Planar};
use farsa_num::{Domain, Stream};
use farsa_physics::arena::{Area, Arena, ArenaError, Cylinder, FreePlace, Part, Wall, World};

fn arena() -> Arena {
    let mut arena = Arena::walled(1.0, 0.8);
    arena.add_robot(MobileRobot::khepera(), [0.5, 0.4], 0.0);
    arena.add_cylinder(Cylinder::new([0.2, 0.2], 0.05));
    arena.add_area(Area::circle([0.8, 0.6], 0.1, [0.0; 3]));
    arena
}

fn error(change: impl FnOnce(&mut Arena)) -> ArenaError {
    let mut arena = arena();
    change(&mut arena);
    World::new(&arena).unwrap_err()
}

#[test]
fn a_number_out_of_its_range_is_named() {
    type Change = fn(&mut Arena, f64);
    let numbers: [(&str, Part, &[f64], Change); 14] = [
        ("time step", Part::Arena, &[0.0, -0.1], |a, x| a.time_step = x),
        ("colour", Part::Arena, &[-0.1, 1.5], |a, x| a.ground[2] = x),
        ("size", Part::Arena, &[0.0, -1.0], |a, x| a.size = Some([x, 1.0])),
        ("size", Part::Wall(1), &[0.0, -0.1], |a, x| a.walls[1].size[0] = x),
        ("height", Part::Wall(1), &[0.0, -0.1], |a, x| a.walls[1].height = x),
        ("heading", Part::Wall(3), &[1e9], |a, x| a.walls[3].heading = x),
        ("radius", Part::Cylinder(0), &[0.0, -0.1], |a, x| a.cylinders[0].radius = x),
        ("lamp", Part::Cylinder(0), &[-1.0], |a, x| a.cylinders[0].lamp = x),
        ("place", Part::Cylinder(0), &[1e9], |a, x| a.cylinders[0].centre[1] = x),
        ("radius", Part::Area(0), &[0.0, -0.1], |a, x| a.areas[0] = Area::circle([0.5; 2], x, [0.0; 3])),
        ("radius", Part::Robot(0), &[0.0, -0.1], |a, x| a.robots[0].robot.radius = x),
        ("track", Part::Robot(0), &[0.0, -0.1], |a, x| a.robots[0].robot.track = x),
        ("heading", Part::Robot(0), &[1e9], |a, x| a.robots[0].heading = x),
        ("reach of the attachment device", Part::Robot(0), &[-0.1], |a, x| a.robots[0].robot.attachment = Some(x)),
    ];
    for (what, part, values, change) in numbers {
        for x in values.iter().copied().chain([f64::NAN, f64::INFINITY]) {
            let found = error(|arena| change(arena, x));
            let ArenaError::Range { part: p, what: w, value, range } = &found else { panic!("{what}: {found:?}") };
            let same = *value == x || value.is_nan() && x.is_nan();
            assert!((*p, *w) == (part, what) && same && !range.contains(&x) && range[0] < range[1], "{found}");
            assert!(found.to_string().contains(what) && found.to_string().contains(&part.to_string()));
        }
    }
}

#[test]
fn places_are_checked() {
    let overlap = error(|arena| {
        arena.add_robot(MobileRobot::khepera(), [0.56, 0.4], 0.0);
    });
    let ArenaError::Overlap { parts, depth } = overlap else { panic!("{overlap:?}") };
    assert!(parts == [Part::Robot(0), Part::Robot(1)] && (depth - 0.01).abs() < 1e-9, "{depth}");
    let overlap = error(|arena| arena.cylinders[0].centre = [0.5, 0.32]);
    assert!(matches!(overlap, ArenaError::Overlap { parts, .. } if parts.contains(&Part::Cylinder(0))), "{overlap}");
    let overlap = error(|arena| {
        arena.add_wall(Wall::segment([0.5, 0.0], [0.5, 0.7], 0.01));
    });
    assert!(matches!(overlap, ArenaError::Overlap { parts: [Part::Robot(0), Part::Wall(4)], .. }), "{overlap}");
    // Touching is allowed.
    let mut touching = arena();
    touching.robots[0].at = [0.035, 0.4];
    touching.add_robot(MobileRobot::khepera(), [0.105, 0.4], 0.0);
    World::new(&touching).unwrap();
    let outside = error(|arena| arena.robots[0].at = [0.5, 0.79]);
    assert!(matches!(outside, ArenaError::Outside { part: Part::Robot(0), size: [1.0, 0.8], .. }), "{outside}");
    let outside = error(|arena| arena.areas[0].centre = [-0.1, 0.5]);
    assert!(matches!(outside, ArenaError::Outside { part: Part::Area(0), .. }), "{outside}");
    // A wall without length.
    let flat = error(|arena| {
        arena.add_wall(Wall::segment([0.1, 0.1], [0.1, 0.1], 0.01));
    });
    assert!(matches!(flat, ArenaError::Range { part: Part::Wall(4), what: "size", value: 0.0, .. }), "{flat}");
}

#[test]
fn there_are_robots_but_not_too_many_nor_too_fast() {
    assert_eq!(error(|arena| arena.robots.clear()), ArenaError::NoRobots);
    let long = error(|arena| arena.time_step = 0.5);
    assert!(matches!(long, ArenaError::StepTooLong { robot: 0, radius: 0.035, .. }), "{long}");
    let many = error(|arena| {
        let one = arena.robots[0].clone();
        arena.robots = vec![one; 40_000];
    });
    assert_eq!(many, ArenaError::TooMany { what: "robots", count: 40_000, most: 32_768 });
    let many = error(|arena| {
        let one = arena.cylinders[0];
        arena.cylinders = vec![one; 70_000];
    });
    assert!(matches!(many, ArenaError::TooMany { count: 70_002, most: 65_536, .. }), "{many}");
    let many = error(|arena| {
        let one = farsa_physics::arena::Placed { robot: MobileRobot::marxbot(), ..arena.robots[0].clone() };
        arena.robots = vec![one; 10_000];
    });
    assert_eq!(many, ArenaError::TooMany { what: "actuators of robots", count: 70_000, most: 65_536 });
}

#[test]
fn a_free_place_is_found_or_not() {
    let arena = arena();
    let world = World::new(&arena).unwrap();
    let mut stream = Stream::new(1, Domain::Start, 0, 0, 0);
    let bodies = [(BodyId(0), 0.1), (arena.cylinder(0), 0.02)];
    let free = FreePlace { walls: 0.05, ..FreePlace::new([[0.0, 0.0], [1.0, 0.8]], 0.035) }.clear_of(&bodies);
    let (mut near_robot, mut others) = (0, 0);
    for _ in 0..2000 {
        let at = free.find(&world, &mut stream).unwrap();
        let mut least = [f32::INFINITY; 3];
        world.near(at, 1.0, &mut |near| {
            let which = near.body.map_or(0, |body| 1 + usize::from(body == arena.cylinder(0)));
            least[which] = least[which].min(near.distance - 0.035);
        });
        assert!(least[0] >= 0.05 - 1e-6 && least[1] >= 0.1 - 1e-6 && least[2] >= 0.02 - 1e-6, "{at:?} {least:?}");
        near_robot += usize::from(least[1] < 0.15);
        others += usize::from(least[0] > 0.2);
    }
    // They are all over what is free.
    assert!(near_robot > 50 && others > 50, "{near_robot} {others}");
    let none = FreePlace { walls: 0.5, tries: 100, ..FreePlace::new([[0.0, 0.0], [1.0, 0.8]], 0.035) };
    let Err(ArenaError::NoFreePlace { tries: 100, radius, short }) = none.find(&world, &mut stream) else { panic!() };
    assert!(radius == 0.035 && (0.134..0.3).contains(&short), "{short}");
    let nowhere = FreePlace { tries: 0, ..free }.find(&world, &mut stream).unwrap_err();
    assert!(matches!(nowhere, ArenaError::NoFreePlace { tries: 0, .. }) && !nowhere.to_string().is_empty());
}
