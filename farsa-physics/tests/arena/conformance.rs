//! The planar world keeps the promises of `farsa_body::testing`.

use farsa_body::ports::{BodyId, JointId};
use farsa_body::robots::MobileRobot;
use farsa_body::testing::{Probe, check_arrange, check_rays, check_world};
use farsa_physics::arena::{Area, Arena, CollisionRule, Cylinder, Search, Wall, World};

/// Three robots of three kinds among obstacles, close enough to run into all of them.
fn arena() -> Arena {
    let mut arena = Arena::walled(0.9, 0.8);
    arena.time_step = 0.1;
    arena.add_wall(Wall::segment([0.3, 0.3], [0.5, 0.4], 0.02).with_height(0.2));
    arena.add_cylinder(Cylinder { lamp: 2.0, ..Cylinder::new([0.65, 0.6], 0.05) });
    arena.add_cylinder(Cylinder::new([0.2, 0.5], 0.0125));
    arena.add_area(Area::circle([0.2, 0.2], 0.1, [1.0, 0.0, 0.0]));
    arena.add_area(Area::rectangle([0.6, 0.2], [0.2, 0.1], 0.4, [0.0, 0.0, 1.0]));
    arena.add_robot(MobileRobot::khepera(), [0.15, 0.3], 0.3);
    arena.add_robot(MobileRobot::e_puck(), [0.45, 0.6], -2.0);
    arena.add_robot(MobileRobot::marxbot(), [0.7, 0.3], 1.9);
    arena
}

fn probe(arena: &Arena) -> Probe {
    let bodies: Vec<BodyId> = (0..7).map(BodyId).collect();
    let wheels = (0..3).flat_map(|robot| {
        let most = arena.robots[robot].robot.max_wheel_speed as f32;
        arena.parts(robot).motors.map(|motor| (motor, [[-most, 0.0], [most, 0.0]]))
    });
    Probe {
        planar: bodies.clone(),
        joints: (0..6).map(|joint| (JointId(joint), [-3.0, 3.0])).collect(),
        actuators: wheels.collect(),
        steps: 400,
        bodies,
        ..Probe::numbered(0, [[0.0; 2]; 2])
    }
}

#[test]
fn the_arena_conforms() {
    for collisions in [CollisionRule::Revert, CollisionRule::Circles] {
        for search in [Search::All, Search::Grid] {
            let arena = Arena { collisions, search, ..arena() };
            let probe = probe(&arena);
            let make = || World::new(&arena).unwrap();
            assert_eq!(check_world(make, &probe), Ok(()), "{collisions:?} {search:?}");
            assert_eq!(check_arrange(make, &probe), Ok(()), "{collisions:?} {search:?}");
            let origins = [[0.3, 0.2, 0.02], [0.45, 0.45, 0.3], [-0.2, 0.4, 0.05], [0.15, 0.3, 0.05]];
            for range in [0.2, 2.0, f32::INFINITY] {
                assert_eq!(check_rays(&make(), &probe.bodies, &origins, range), Ok(()), "{search:?}");
            }
        }
    }
}
