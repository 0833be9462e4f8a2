//! Faults of planar worlds, and places that do not exist.
#![allow(missing_docs, clippy::unwrap_used)]

use farsa_body::ports::{BodyId, Sight};
use farsa_body::robots::MobileRobot;
use farsa_num::{Domain, Stream};
use farsa_physics::arena::{Area, Arena, ArenaError, Convex, ConvexFault, Cylinder, FreePlace, Part, Wall, World};

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

fn of_convex(convex: Convex) -> ArenaError {
    error(|arena| {
        arena.add_convex(Convex::prism(&[[0.1, 0.6], [0.2, 0.6], [0.1, 0.7]], 0.1));
        arena.add_convex(convex);
    })
}

#[test]
fn what_is_not_convex_is_refused() {
    let part = Part::Convex(1);
    let range = |found: &ArenaError, what: &str| {
        matches!(found, ArenaError::Range { part: p, what: w, value, range }
            if *p == part && *w == what && !range.contains(value) && found.to_string().contains("convex obstacle 1"))
    };
    let square = [[0.7, 0.5], [0.8, 0.5], [0.8, 0.6], [0.7, 0.6]];
    for (corners, what) in [(&square[..2], "number of corners"), (&[], "number of corners")] {
        let found = of_convex(Convex::prism(corners, 0.1));
        assert!(range(&found, what), "{found}");
    }
    for x in [f64::NAN, f64::INFINITY, -1e9] {
        let found = of_convex(Convex::prism(&[[0.7, 0.5], [0.8, x], [0.8, 0.6]], 0.1));
        assert!(range(&found, "corner"), "{found}");
        let found = of_convex(Convex::hull(&[[0.7, 0.5, 0.0], [0.8, 0.5, 0.0], [0.8, x, 0.1], [0.7, 0.6, 0.1]]));
        assert!(range(&found, "point"), "{found}");
        assert!(
            range(&of_convex(Convex::prism(&square, x)), "height")
                && range(&of_convex(Convex::prism(&square, 0.0)), "height")
        );
        assert!(range(&of_convex(Convex::prism(&square, 0.1).with_color([0.0, x, 0.0])), "colour"));
    }
    let many: Vec<[f64; 2]> = (0..1025).map(|i| [0.7 + 1e-4 * f64::from(i), 0.5]).collect();
    assert!(range(&of_convex(Convex::prism(&many, 0.1)), "number of corners"));
    // On a line, and nearly.
    for off in [0.0, 4e-7] {
        let found = of_convex(Convex::prism(&[[0.6, 0.5], [0.7, 0.6 + off], [0.8, 0.7]], 0.1));
        assert!(range(&found, "width"), "{found}");
    }
    // A dent, by its corner and depth.
    let dent = of_convex(Convex::prism(&[[0.6, 0.5], [0.8, 0.5], [0.8, 0.7], [0.75, 0.55]], 0.1));
    let ArenaError::Convex { part: p, fault: ConvexFault::Dent { corner: 3, depth } } = dent else {
        panic!("{dent:?}")
    };
    assert!(p == part && (depth - 0.05).abs() < 1e-9, "{dent}");
    // Two corners at one place, the polygon closed explicitly.
    let closed = of_convex(Convex::prism(&[square[0], square[1], square[2], square[3], square[0]], 0.1));
    assert_eq!(closed, ArenaError::Convex { part, fault: ConvexFault::SameCorner { corners: [0, 4], distance: 0.0 } });
    // A bow tie and a five-pointed star: all corners on the hull.
    let tie = of_convex(Convex::prism(&[square[0], square[1], square[3], square[2]], 0.1));
    assert!(matches!(tie, ArenaError::Convex { part: p, fault: ConvexFault::OutOfTurn { .. } } if p == part), "{tie}");
    let star: [[f64; 2]; 5] = core::array::from_fn(|i| {
        let (y, x) = farsa_num::sin_cos(2.0 * std::f64::consts::TAU * i as f64 / 5.0);
        [0.8 + 0.1 * x, 0.6 + 0.1 * y]
    });
    let star = of_convex(Convex::prism(&star, 0.1));
    assert!(
        matches!(star, ArenaError::Convex { part: p, fault: ConvexFault::OutOfTurn { .. } } if p == part),
        "{star}"
    );
    for found in [tie, star, closed, dent] {
        assert!(found.to_string().contains("convex obstacle 1"), "{found}");
    }
    // Either way round, and a corner on a side, are right.
    let mut right = arena();
    let mut corners = vec![square[0], [0.75, 0.5], square[1], square[2], square[3]];
    right.add_convex(Convex::prism(&corners, 0.1));
    corners.reverse();
    right.convexes[0] = Convex::prism(&corners, 0.1);
    World::new(&right).unwrap();
    assert_eq!(right.convexes[0].outline(), square);
}

#[test]
fn obstacles_lie_in_the_arena_and_on_nobody() {
    let outside = of_convex(Convex::prism(&[[0.9, 0.5], [1.01, 0.5], [0.9, 0.6]], 0.1));
    let expected = ArenaError::Outside { part: Part::Convex(1), at: [1.01, 0.5], radius: 0.0, size: [1.0, 0.8] };
    assert_eq!(outside, expected);
    // Next to the robot at (0.5, 0.4), and around the cylinder at (0.2, 0.2).
    let overlap = of_convex(Convex::prism(&[[0.53, 0.3], [0.6, 0.3], [0.6, 0.5], [0.53, 0.5]], 0.1));
    let ArenaError::Overlap { parts: [Part::Robot(0), Part::Convex(1)], depth } = overlap else {
        panic!("{overlap:?}")
    };
    assert!((depth - 0.005).abs() < 1e-9);
    let overlap = of_convex(Convex::prism(&[[0.1, 0.1], [0.3, 0.1], [0.3, 0.3], [0.1, 0.3]], 0.1));
    let ArenaError::Overlap { parts: [Part::Cylinder(0), Part::Convex(1)], depth } = overlap else {
        panic!("{overlap:?}")
    };
    assert!((depth - 0.15).abs() < 1e-9);
    let mut touching = arena();
    touching.add_convex(Convex::prism(&[[0.535, 0.3], [0.6, 0.3], [0.6, 0.5], [0.535, 0.5]], 0.1));
    World::new(&touching).unwrap();
}

/// Corners of a slab in the corner of the arena.
fn slab(height: f64) -> Vec<[f64; 3]> {
    let ends = [[0.8, 0.6], [0.9, 0.6], [0.9, 0.7], [0.8, 0.7]];
    ends.iter().flat_map(|[x, y]| [[*x, *y, 0.0], [*x, *y, height]]).collect()
}

#[cfg(not(feature = "parry"))]
#[test]
fn hulls_name_the_feature_that_they_need() {
    let found = of_convex(Convex::hull(&slab(0.1)));
    assert_eq!(
        found,
        ArenaError::Convex { part: Part::Convex(1), fault: ConvexFault::NeedsFeature { feature: "parry" } }
    );
    assert!(found.to_string().contains("`parry`"), "{found}");
}

#[cfg(feature = "parry")]
#[test]
fn hulls_are_checked() {
    let part = Part::Convex(1);
    let found = of_convex(Convex::hull(&slab(0.1)[..3]));
    assert!(
        matches!(found, ArenaError::Range { part: p, what: "number of points", value: 3.0, .. } if p == part),
        "{found}"
    );
    let found = of_convex(Convex::hull(&slab(0.0)));
    assert!(matches!(found, ArenaError::Range { part: p, what: "thickness", value: 0.0, .. } if p == part), "{found}");
    let upright: Vec<[f64; 3]> = slab(0.1).into_iter().map(|[x, _, z]| [x, 0.6, z]).collect();
    let found = of_convex(Convex::hull(&upright));
    assert!(matches!(found, ArenaError::Range { part: p, what: "width", value: 0.0, .. } if p == part), "{found}");
    let mut below = slab(0.1);
    below[3][2] = -0.01;
    let found = of_convex(Convex::hull(&below));
    assert!(matches!(found, ArenaError::Range { what: "height of a point", value: -0.01, .. }), "{found}");
    // As thin as paper is thick enough.
    let mut thin = arena();
    thin.add_convex(Convex::hull(&slab(1e-4)));
    World::new(&thin).unwrap();
}

#[test]
fn there_are_robots_but_not_too_many_nor_too_fast() {
    assert_eq!(error(|arena| arena.robots.clear()), ArenaError::Count { what: "robots", count: 0, range: [1, 32_768] });
    let long = error(|arena| arena.time_step = 0.5);
    assert!(matches!(long, ArenaError::StepTooLong { robot: 0, radius: 0.035, .. }), "{long}");
    let many = error(|arena| {
        let one = arena.robots[0].clone();
        arena.robots = vec![one; 40_000];
    });
    assert_eq!(many, ArenaError::Count { what: "robots", count: 40_000, range: [1, 32_768] });
    let many = error(|arena| {
        let one = arena.cylinders[0];
        arena.cylinders = vec![one; 70_000];
    });
    assert!(matches!(many, ArenaError::Count { count: 70_002, range: [0, 65_536], .. }), "{many}");
    let many = error(|arena| {
        let one = farsa_physics::arena::RobotPlacement { robot: MobileRobot::marxbot(), ..arena.robots[0].clone() };
        arena.robots = vec![one; 10_000];
    });
    assert_eq!(many, ArenaError::Count { what: "actuators of robots", count: 70_000, range: [0, 65_536] });
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
        world.query_near(at, 1.0, &mut |near| {
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
