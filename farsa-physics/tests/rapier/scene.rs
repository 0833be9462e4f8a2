//! Objects that only the world of rapier has: boxes to push, cylinders, hulls, meshes, height fields.

use farsa_body::actuators::{Law, Servo};
use farsa_body::ports::{
    Actuated, ActuatorId, Arrange, BodyId, Contacts, JointId, Joints, Kinematics, Rays, World as _,
};
use farsa_body::robot::{Collider, Joint, MassProperties, Robot, RobotError, Segment, Shape};
use farsa_body::testing::{Probe, check_arrange, check_rays, check_world};
use farsa_body::{Pose, Twist};
use farsa_physics::articulated::ModelError;
use farsa_physics::rapier::{Geometry, Options, RapierError, Scene, SceneObject, World};

/// A block that a servo slides along x, its front at x = 0.
fn pusher() -> Robot {
    let mut robot = Robot::new("pusher");
    let half = [0.02, 0.05, 0.02];
    let slide = Joint::prismatic("slide", [1.0, 0.0, 0.0], Pose::at([-0.02, 0.0, 0.03]), [-1.0, 1.0]);
    let block = robot.add_segment(Segment::new("pusher", None, slide, MassProperties::cuboid(1.0, half)));
    robot.add_collider(Collider::new("block", Some(block), Shape::Box { half }, Pose::identity()));
    let law = Law::Servo(Servo { stiffness: 2000.0, damping: 200.0, limit: 50.0 });
    robot.add_actuator("slide", JointId(block.0), law);
    robot
}

fn ground() -> SceneObject {
    SceneObject::fixed("ground", Geometry::Simple(Shape::Plane), Pose::identity())
}

fn simple(name: &str, shape: Shape, at: [f64; 3], mass: f64) -> SceneObject {
    SceneObject::movable(name, Geometry::Simple(shape), Pose::at(at), mass)
}

fn run(world: &mut World, steps: usize) {
    for _ in 0..steps {
        world.step();
    }
}

#[test]
fn a_box_is_pushed() {
    let mut scene = Scene::new(pusher());
    scene.add(ground());
    let half = [0.04, 0.04, 0.04];
    let crate_body =
        scene.add(SceneObject { friction: 0.4, ..simple("crate", Shape::Box { half }, [0.1, 0.0, 0.04], 0.5) });
    let mut world = World::from_scene(&scene, &Options::default()).unwrap();
    let (front, below) = (scene.pair("block", "crate").unwrap(), scene.pair("ground", "crate").unwrap());
    assert_eq!(world.pair_bodies(front), [Some(crate_body), Some(BodyId(0))]);
    assert_eq!(scene.body("crate"), Some(crate_body));
    assert_eq!(scene.pair("ground", "nothing"), None);
    run(&mut world, 50);
    assert!(!world.touches(front) && world.touches(below));
    // At a steady 5 cm/s the push is what friction takes: the geometric mean of 0.4 and 0.5 of the weight.
    let (mut pushes, mut weights) = (Vec::new(), Vec::new());
    for t in 0..400 {
        world.command(ActuatorId(0), [0.0005 * t as f32, 0.0]);
        world.step();
        if t >= 250 {
            pushes.push(world.pair_contact(front).force[0]);
            weights.push(world.pair_contact(below).normal_force);
        }
    }
    let [push, weight] = [pushes, weights].map(|x| x.iter().sum::<f32>() / x.len() as f32);
    // The front rubs down the crate, too, which adds to its weight.
    let (friction, at) = ((0.4_f64 * 0.5).sqrt() as f32 * weight, world.pose(crate_body).position);
    println!("crate at {at:?}, pushed with {push} of {friction} N, presses {weight} N");
    assert!((push - friction).abs() < 0.06 * friction && (weight - 0.5 * 9.81).abs() < 1.0, "{push} {friction}");
    assert!((at[0] - 0.04 - world.position(JointId(0))).abs() < 1e-3 && (at[2] - 0.04).abs() < 5e-4, "{at:?}");
}

#[test]
fn cylinders_and_hulls_stand_where_they_are_put() {
    let mut scene = Scene::default();
    scene.add(ground());
    let geometry = Geometry::Cylinder { radius: 0.03, half_length: 0.05 };
    let can = scene.add(SceneObject::movable("can", geometry, Pose::at([0.0, 0.0, 0.05]), 0.2));
    // A pyramid on a square base. Its center of mass is a quarter of its height above that.
    let corners =
        vec![[0.05, 0.05, 0.0], [0.05, -0.05, 0.0], [-0.05, 0.05, 0.0], [-0.05, -0.05, 0.0], [0.0, 0.0, 0.08]];
    let pyramid = scene.add(SceneObject::movable("pyramid", Geometry::Hull(corners), Pose::at([0.3, 0.0, 0.0]), 0.3));
    let mut world = World::from_scene(&scene, &Options::default()).unwrap();
    run(&mut world, 200);
    for (body, height) in [(can, 0.05), (pyramid, 0.0)] {
        let pose = world.pose(body);
        assert!((pose.position[2] - height).abs() < 5e-4 && pose.rotation[3].abs() > 0.9999, "{body:?}: {pose:?}");
    }
    // Turning about the center of mass moves the origin.
    let spin = Twist { linear: [0.0; 3], angular: [0.0, 2.0, 0.0] };
    world.place_body(pyramid, Pose::at([0.0, 0.0, 5.0]), spin);
    world.finish_placement();
    let (pose, twist) = (world.pose(pyramid), world.velocity(pyramid));
    assert_eq!(pose.position, [0.0, 0.0, 5.0]);
    assert!(twist.linear.iter().all(|v| v.abs() < 1e-6) && twist.angular == [0.0, 2.0, 0.0], "{twist:?}");
    let body = world.body_handle(pyramid).unwrap();
    let centre = world.physics().bodies[body].center_of_mass();
    assert!((centre.z - 5.02).abs() < 1e-5, "{centre}");
    run(&mut world, 10);
    // The center's own horizontal speed was 2 * 0.02 m/s and stays.
    let moved = world.physics().bodies[body].center_of_mass() - centre;
    assert!((moved.x - 0.004).abs() < 1e-5, "{moved}");
}

#[test]
fn landscapes_and_meshes_carry() {
    // A tray of triangles with its floor at z = 0.1, and a valley along y whose bottom is at x = 0.5.
    let (mut vertices, mut triangles) = (Vec::new(), Vec::new());
    for (k, [x, y]) in [[-0.2, -0.2], [0.2, -0.2], [0.2, 0.2], [-0.2, 0.2]].into_iter().enumerate() {
        vertices.push([x, y, 0.1]);
        triangles.push([4, k as u32, (k as u32 + 1) % 4]);
    }
    vertices.push([0.0, 0.0, 0.1]);
    let [rows, columns] = [9, 11];
    let height = |x: f32| 0.5 * (x - 0.5) * (x - 0.5);
    // Columns lie 0.1 m apart about x = 0.8.
    let heights = (0..rows * columns).map(|i| height(0.3 + 0.1 * (i % columns) as f32)).collect();
    let valley = Geometry::HeightField { heights, size: [rows, columns], extent: [1.0, 0.8] };
    let mut scene = Scene::default();
    scene.add(SceneObject::fixed("tray", Geometry::Mesh { vertices, triangles }, Pose::at([-1.0, 0.0, 0.0])));
    scene.add(SceneObject::fixed("valley", valley, Pose::at([0.8, 0.0, 0.0])));
    let ball = Shape::Sphere { radius: 0.03 };
    let lying = scene.add(simple("lying", ball, [-1.0, 0.05, 0.15], 0.1));
    let brick = scene.add(simple("brick", Shape::Box { half: [0.05, 0.03, 0.02] }, [-0.92, -0.1, 0.13], 0.1));
    let rolling = scene.add(simple("rolling", ball, [0.7, 0.02, 0.055], 0.1));
    let mut world = World::from_scene(&scene, &Options::default()).unwrap();

    // Rays see the surfaces where the formulas have them, but for 1.25 mm between the grid's lines.
    for (x, y) in [(-1.05, 0.1), (0.51, -0.32), (0.83, 0.12), (1.23, 0.35)] {
        let z = if x < 0.0 { 0.1 } else { height(x) };
        let hit = world.cast([x, y, 2.0], [0.0, 0.0, -1.0], 5.0);
        let hit = hit.unwrap_or_else(|| panic!("nothing below {x}, {y}"));
        assert!((2.0 - hit.distance - z).abs() < 1.5e-3 && hit.normal[2] > 0.5, "at {x}, {y}: {hit:?}");
        assert_eq!(hit.body, scene.body(if x < 0.0 { "tray" } else { "valley" }));
    }
    run(&mut world, 100);
    let z = |body| world.pose(body).position[2];
    println!("lying at {}, brick at {}", z(lying), z(brick));
    assert!((z(lying) - 0.13).abs() < 5e-4 && (z(brick) - 0.12).abs() < 5e-4);
    let (mut low, mut high) = (f32::INFINITY, f32::NEG_INFINITY);
    for _ in 0..400 {
        world.step();
        let [x, y, z] = world.pose(rolling).position;
        // It rolls through the valley, on pieces that are 0.1 m long and up to 2 mm off the parabola.
        assert!((z - 0.03 - height(x)).abs() < 0.02 && y.abs() < 0.2, "{x} {y} {z}");
        (low, high) = (low.min(x), high.max(x));
    }
    println!("rolled from {low} to {high}");
    assert!(low < 0.45 && high > 0.55);
}

#[test]
fn scenes_conform() {
    let mut scene = Scene::new(pusher());
    scene.add(ground());
    let geometry = Geometry::Cylinder { radius: 0.03, half_length: 0.05 };
    let objects = [
        simple("crate", Shape::Box { half: [0.04; 3] }, [0.06, 0.0, 0.04], 0.5),
        SceneObject::movable("can", geometry, Pose::at([0.15, 0.0, 0.05]), 0.2),
    ];
    let floating = objects.map(|object| scene.add(object));
    let heights = vec![0.0, 0.1, 0.05, 0.0, 0.2, 0.1];
    let hill = Geometry::HeightField { heights, size: [2, 3], extent: [0.5, 0.5] };
    scene.add(SceneObject::fixed("hill", hill, Pose::at([0.5, 0.0, -0.05])));
    let fresh = World::from_scene(&scene, &Options::default()).unwrap();
    let bodies = (0..=scene.objects.len() as u16).map(BodyId).collect();
    let probe = Probe { bodies, floating: floating.to_vec(), steps: 120, ..Probe::for_robot(&scene.robot) };
    assert_eq!(check_world(|| fresh.clone(), &probe), Ok(()));
    assert_eq!(check_arrange(|| fresh.clone(), &probe), Ok(()));
    assert_eq!(check_rays(&fresh, &probe.bodies, &[[0.1, 0.3, 0.4], [0.4, -0.3, 0.5]], 2.0), Ok(()));
}

#[test]
fn things_that_cannot_be_built_are_refused() {
    let refused = |object: SceneObject| {
        let scene = Scene { robot: pusher(), objects: vec![ground(), object] };
        let error = World::from_scene(&scene, &Options::default()).err().unwrap();
        println!("{error}");
        error
    };
    let still = |geometry| SceneObject::fixed("thing", geometry, Pose::identity());
    let moving = |geometry| SceneObject::movable("thing", geometry, Pose::identity(), 1.0);
    let sphere = |radius| Geometry::Simple(Shape::Sphere { radius });
    let triangle = vec![[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0]];
    let mesh = |vertices: &[[f32; 3]], triangles: &[[u32; 3]]| Geometry::Mesh {
        vertices: vertices.to_vec(),
        triangles: triangles.to_vec(),
    };
    let grid = |heights: &[f32], size| Geometry::HeightField { heights: heights.to_vec(), size, extent: [1.0, 1.0] };
    for (field, object) in [
        ("radius", moving(sphere(0.0))),
        ("radius", moving(sphere(f64::NAN))),
        ("half length", moving(Geometry::Cylinder { radius: 1.0, half_length: -1.0 })),
        ("half edge", moving(Geometry::Simple(Shape::Box { half: [1.0, f64::INFINITY, 1.0] }))),
        ("mass", SceneObject { mass: Some(0.0), ..moving(sphere(1.0)) }),
        ("mass", SceneObject { mass: Some(f64::NAN), ..moving(sphere(1.0)) }),
        ("friction", SceneObject { friction: -1.0, ..moving(sphere(1.0)) }),
        ("position", SceneObject { placement: Pose::at([0.0, f64::NAN, 0.0]), ..moving(sphere(1.0)) }),
        ("length", SceneObject { placement: Pose { position: [0.0; 3], rotation: [0.0; 4] }, ..moving(sphere(1.0)) }),
        ("coordinate", still(mesh(&[[f32::NAN; 3]; 3], &[[0, 1, 2]]))),
        ("coordinate", moving(Geometry::Hull(vec![[0.0, f32::INFINITY, 0.0]; 4]))),
        ("number of triangles", still(mesh(&triangle, &[]))),
        ("height", still(grid(&[0.0, 1.0, f32::NAN, 0.0], [2, 2]))),
    ] {
        let error = refused(object);
        assert!(matches!(&error, RapierError::SceneObject { name, why } if name == "thing" && why.starts_with(field)));
    }
    for geometry in [Geometry::Simple(Shape::Plane), mesh(&triangle, &[[0, 1, 2]]), grid(&[0.0; 4], [2, 2])] {
        let error = refused(moving(geometry));
        assert!(
            matches!(&error, RapierError::SceneObject { why, .. } if why.ends_with("does not move, so it has no mass"))
        );
    }
    let error = refused(still(mesh(&triangle, &[[0, 1, 2], [0, 1, 3]])));
    assert_eq!(
        error,
        RapierError::SceneObject { name: "thing".into(), why: "triangle 1 has vertex 3; the last of 3 is 2".into() }
    );
    for (count, size) in [(4, [2, 3]), (0, [0, 0]), (3, [1, 3]), (1, [usize::MAX, usize::MAX])] {
        let error = refused(still(grid(&vec![0.0; count], size)));
        let [rows, columns] = size;
        let why = format!("{count} heights for {rows} rows of {columns}, of which there are at least two");
        assert_eq!(error, RapierError::SceneObject { name: "thing".into(), why });
    }
    let flat = vec![[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [1.0, 1.0, 0.0], [0.0, 1.0, 0.0], [0.3, 0.3, 0.0]];
    for points in [vec![], flat[..3].to_vec(), flat.clone(), vec![[0.1; 3]; 8]] {
        let error = refused(moving(Geometry::Hull(points)));
        assert!(
            matches!(&error, RapierError::SceneObject { why, .. } if why.ends_with("points span no solid")),
            "{error}"
        );
    }
    for name in ["ground", "pusher", "block"] {
        let error = refused(SceneObject { name: name.into(), ..moving(sphere(1.0)) });
        assert_eq!(error, RapierError::Model(ModelError::Robot(RobotError::Name { name: name.into() })));
    }
    let many = (0..400).map(|k| SceneObject { name: format!("{k}"), ..moving(sphere(0.1)) }).collect();
    let error =
        World::from_scene(&Scene { robot: Robot::default(), objects: many }, &Options::default()).err().unwrap();
    assert_eq!(error, RapierError::Model(ModelError::TooMany { what: "pairs", count: 400 * 399 / 2 }));
}
