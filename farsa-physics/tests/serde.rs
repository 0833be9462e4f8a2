//! Arenas, scenes and options survive being written and read. Invalid arenas are refused.
#![cfg(all(feature = "serde", feature = "alloc"))]
#![allow(missing_docs)]

use farsa_body::robots::MobileRobot;
use farsa_physics::arena::{
    Area, Arena, ArenaError, CollisionRule, Convex, Cylinder, Part, RobotPlacement, Search, Wall, World,
};
use farsa_physics::articulated;
use serde::{Serialize, de::DeserializeOwned};

/// Written and read.
fn again<T: Serialize + DeserializeOwned>(value: &T) -> T {
    let text = serde_json::to_string(value).expect("numbers and names");
    serde_json::from_str(&text).unwrap_or_else(|error| panic!("{text}: {error}"))
}

fn arena() -> Arena {
    let mut arena = Arena::walled(1.0, 0.7);
    arena.add_wall(Wall::segment([0.1, 0.5], [0.3, 0.6], 0.01).with_height(0.05));
    arena.add_convex(Convex::prism(&[[0.4, 0.4], [0.7, 0.4], [0.4, 0.7]], 0.1).with_color([0.1, 0.2, 0.3]));
    arena.add_cylinder(Cylinder { lamp: 2.0, ..Cylinder::new([0.3, 0.2], 0.0125) });
    arena.add_area(Area::circle([0.5, 0.2], 0.05, [1.0, 0.0, 0.0]));
    arena.add_area(Area::rectangle([0.6, 0.2], [0.1, 0.2], 1.0 / 3.0, [0.0, 1.0, 0.0]));
    arena.add_robot(MobileRobot::khepera(), [0.1, 0.2], 0.7);
    arena.add_robot(MobileRobot::marxbot(), [0.8, 0.2], -0.7);
    Arena { ground: [0.9; 3], time_step: 0.1, collisions: CollisionRule::Circles, search: Search::Grid, ..arena }
}

#[test]
fn an_arena_reads_back_as_it_was() {
    let arena = arena();
    assert_eq!(again(&arena), arena);
    assert!(World::new(&again(&arena)).is_ok());
    let hull = Convex::hull(&[[0.0, 0.0, 0.0], [0.1, 0.0, 0.0], [0.0, 0.1, 0.0], [0.0, 0.0, 0.1]]);
    assert_eq!(again(&hull), hull);
}

#[test]
fn an_arena_names_only_what_differs() {
    assert_eq!(serde_json::from_str::<Arena>("{}").expect("valid"), Arena::new());
    let text = r#"{"size": [1.0, 1.0], "collisions": "circles", "cylinders": [
        {"centre": [0.5, 0.5], "radius": 0.1, "height": 0.1, "color": [1.0, 0.0, 0.0], "lamp": 0.0}]}"#;
    let arena: Arena = serde_json::from_str(text).expect("valid");
    let cylinder = Cylinder { color: [1.0, 0.0, 0.0], ..Cylinder::new([0.5; 2], 0.1) };
    let expected =
        Arena { size: Some([1.0; 2]), collisions: CollisionRule::Circles, cylinders: vec![cylinder], ..Arena::new() };
    assert_eq!(arena, expected);
    let options = articulated::Options { substeps: 8, ..articulated::Options::default() };
    assert_eq!(serde_json::from_str::<articulated::Options>(r#"{"substeps": 8}"#).expect("valid"), options);
    assert_eq!(again(&options), options);
}

#[test]
fn a_typing_mistake_is_refused_with_its_name() {
    for (text, name) in [
        (r#"{"wals": []}"#, "wals"),
        (r#"{"collisions": "circle"}"#, "circle"),
        (r#"{"cylinders": [{"centre": [0.5, 0.5]}]}"#, "radius"),
        (r#"{"areas": [{"shape": {"circle": {"radios": 1.0}}}]}"#, "radios"),
    ] {
        let error = serde_json::from_str::<Arena>(text).expect_err("a typing mistake").to_string();
        assert!(error.contains(name), "{error}");
    }
    let error = serde_json::from_str::<articulated::Options>(r#"{"substep": 8}"#).expect_err("a typing mistake");
    assert!(error.to_string().contains("substep"));
}

/// A file may contain anything. An invalid one makes no world.
#[test]
fn what_no_world_can_be_made_of_is_refused_with_its_number() {
    let refused = |change: &dyn Fn(&mut Arena)| {
        let mut arena = arena();
        change(&mut arena);
        World::new(&again(&arena)).expect_err("no world")
    };
    let error = refused(&|arena| arena.cylinders[0].radius = -0.1);
    assert!(matches!(error, ArenaError::Range { part: Part::Cylinder(0), value: -0.1, .. }), "{error}");
    let error = refused(&|arena| arena.robots.clear());
    assert_eq!(error, ArenaError::Count { what: "robots", count: 0, range: [1, 32_768] });
    let error = refused(&|arena| {
        let RobotPlacement { robot, at, .. } = arena.robots[0].clone();
        arena.add_robot(robot, at, 0.0);
    });
    assert!(matches!(error, ArenaError::Overlap { .. }), "{error}");
}

#[cfg(feature = "rapier")]
mod rapier {
    use farsa_body::Pose;
    use farsa_body::robot::Shape;
    use farsa_body::robots::{ArmAndHand, MobileRobot};
    use farsa_physics::arena::Arena;
    use farsa_physics::rapier::{
        ArenaOptions, ArenaScene, Block, Chassis, Geometry, Options, RapierError, Scene, SceneObject, World,
    };

    use super::again;

    fn scene() -> Scene {
        let mut scene = Scene::new(ArmAndHand::default().robot().expect("a valid robot"));
        scene.add(SceneObject::fixed("ground", Geometry::Simple(Shape::Plane), Pose::at([0.0, 0.0, -1.0])));
        let corners = vec![[0.0, 0.0, 0.0], [0.1, 0.0, 0.0], [0.0, 0.1, 0.0], [0.0, 0.0, 0.1]];
        scene.add(SceneObject::movable("stone", Geometry::Hull(corners.clone()), Pose::at([1.0, 0.0, 0.0]), 0.1));
        let can = Geometry::Cylinder { radius: 0.03, half_length: 0.05 };
        scene.add(SceneObject::movable("can", can, Pose::at([1.0, 1.0, 0.0]), 1.0 / 3.0));
        let mesh = Geometry::Mesh { vertices: corners, triangles: vec![[0, 1, 2]] };
        scene.add(SceneObject::fixed("slope", mesh, Pose::at([2.0, 0.0, 0.0])));
        let field = Geometry::HeightField { heights: vec![0.0, 0.1, 0.2, 0.3], size: [2, 2], extent: [1.0, 1.0] };
        scene.add(SceneObject::fixed("hills", field, Pose::at([4.0, 0.0, 0.0])));
        scene
    }

    #[test]
    fn a_scene_reads_back_as_it_was() {
        let scene = scene();
        assert_eq!(again(&scene), scene);
        assert!(World::from_scene(&again(&scene), &Options::default()).is_ok());
        let mut arena = Arena::walled(1.0, 1.0);
        arena.add_robot(MobileRobot::khepera(), [0.5, 0.5], 0.0);
        let chassis = vec![Chassis::for_robot(&MobileRobot::khepera())];
        let block =
            Block { centre: [0.2, 0.2], heading: 0.1, size: [0.1; 3], mass: 0.2, friction: 0.4, color: [0.5; 3] };
        let scene = ArenaScene { arena, chassis, blocks: vec![block] };
        assert_eq!(again(&scene), scene);
    }

    #[test]
    fn options_name_only_what_differs() {
        let options = Options { sweeps: 4, ..Options::default() };
        assert_eq!(serde_json::from_str::<Options>(r#"{"sweeps": 4}"#).expect("valid"), options);
        assert_eq!(again(&options), options);
        let options = ArenaOptions { sweeps: 7, ..ArenaOptions::default() };
        assert_eq!(serde_json::from_str::<ArenaOptions>(r#"{"sweeps": 7}"#).expect("valid"), options);
        assert!(serde_json::from_str::<ArenaOptions>(r#"{"sweep": 7}"#).is_err());
    }

    #[test]
    fn what_no_scene_can_hold_is_refused_with_its_name() {
        let mut scene = scene();
        scene.objects[2].friction = -1.0;
        let error = World::from_scene(&again(&scene), &Options::default()).expect_err("no friction");
        let expected = RapierError::SceneObject { name: "can".into(), why: "friction is -1".into() };
        assert_eq!(error, expected);
        // A mass that is misspelt would make an object that does not move.
        let text = serde_json::to_string(&scene).expect("numbers and names").replace("\"mass\":0.1", "\"mas\":0.1");
        let error = serde_json::from_str::<Scene>(&text).expect_err("a typing mistake").to_string();
        assert!(error.contains("mas"), "{error}");
    }
}
