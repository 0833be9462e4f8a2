//! Cylinders at rest, rolling and under other shapes, against closed forms, in one world, in lanes and in rapier.

use farsa_body::ports::{BodyId, World as _};
use farsa_body::robot::{Collider, Joint, MassProperties, PairFault, Robot, RobotError, Segment, Shape, Surface};
use farsa_body::{Pose, Twist};
use farsa_num::sin_cos;
use farsa_physics::articulated::{Model, ModelError, Options, World};

const SURFACE: Surface = Surface { friction: 0.8, rolling_friction: 0.0, stiffness: 1e4, damping: 60.0 };
const RADIUS: f64 = 0.06;
const HALF: f64 = 0.1;
const MASS: f64 = 0.5;
const CYLINDER: Shape = Shape::Cylinder { radius: RADIUS, half_length: HALF };

/// Rotation about the y axis.
fn turned(angle: f64) -> [f64; 4] {
    let (sine, cosine) = sin_cos(0.5 * angle);
    [0.0, sine, 0.0, cosine]
}

const QUARTER: f64 = core::f64::consts::FRAC_PI_2;

/// A cylinder at a pose, and another shape in the world.
fn cylinder_on(start: Pose<f64>, ground: Shape, at: Pose<f64>) -> Robot {
    let mut robot = Robot::new("cylinder");
    let mass = MassProperties::from_shape(&CYLINDER, MASS);
    let body = robot.add_segment(Segment::new("cylinder", None, Joint::floating(start), mass));
    let skin = Collider::new("skin", Some(body), CYLINDER, Pose::identity());
    let pair = [skin, Collider::new("ground", None, ground, at)].map(|collider| robot.add_collider(collider));
    robot.add_pair(pair, SURFACE);
    robot
}

/// Settles for two seconds. Returns the height and the largest speed.
fn settled(robot: &Robot) -> (f64, f64) {
    let mut world = World::new(Model::<f64>::new(robot, &Options::default()).unwrap());
    for _ in 0..200 {
        world.step();
    }
    (world.positions()[2], world.velocities().iter().fold(0.0, |most, v| v.abs().max(most)))
}

/// Upright on three points, and lying on two.
#[test]
fn a_cylinder_rests_at_its_height() {
    let weight = MASS * 9.81;
    for (start, wanted) in [
        (Pose::at([0.0, 0.0, HALF + 0.01]), HALF - weight / 3e4),
        (Pose { position: [0.0, 0.0, HALF + 0.02], rotation: turned(0.2) }, HALF - weight / 3e4),
        (Pose { position: [0.0, 0.0, HALF + 0.01], rotation: turned(2.0 * QUARTER) }, HALF - weight / 3e4),
        (Pose { position: [0.0, 0.0, RADIUS + 0.01], rotation: turned(QUARTER) }, RADIUS - weight / 2e4),
        (Pose { position: [0.0, 0.0, RADIUS + 0.02], rotation: turned(QUARTER - 0.2) }, RADIUS - weight / 2e4),
    ] {
        let (height, speed) = settled(&cylinder_on(start, Shape::Plane, Pose::identity()));
        println!("{height:.6} m, {:.1e} m from the closed form", (height - wanted).abs());
        assert!((height - wanted).abs() < 1e-5 && speed < 1e-4, "{start:?}: {height} at {speed}");
    }
}

/// Beyond the angle `atan(r / h)` it falls on its side.
#[test]
fn a_cylinder_tips_over_beyond_its_rim() {
    let angle = farsa_num::atan2(RADIUS, HALF);
    for (angle, wanted) in [(angle - 0.05, HALF), (angle + 0.05, RADIUS)] {
        let start = Pose { position: [0.0, 0.0, 0.13], rotation: turned(angle) };
        let (height, _) = settled(&cylinder_on(start, Shape::Plane, Pose::identity()));
        assert!((height - wanted).abs() < 1e-3, "{angle}: {height}");
    }
}

/// A cylinder that rolls down a slope without slipping accelerates by 2/3 g sin a.
#[test]
fn a_cylinder_rolls_down_a_slope() {
    let angle = 0.2;
    let ground = Pose { position: [0.0; 3], rotation: turned(angle) };
    // Its axis along y, across the slope.
    let (sine, cosine) = sin_cos(0.5 * QUARTER);
    let start = Pose { position: ground.rotate([0.0, 0.0, RADIUS]), rotation: [sine, 0.0, 0.0, cosine] };
    let robot = cylinder_on(start, Shape::Plane, ground);
    let mut world = World::new(Model::<f64>::new(&robot, &Options::default()).unwrap());
    for _ in 0..100 {
        world.step();
    }
    let [x, z] = [world.velocities()[3], world.velocities()[5]];
    let speed = (x * x + z * z).sqrt();
    let wanted = 2.0 / 3.0 * 9.81 * sin_cos(angle).0;
    assert!((speed / wanted - 1.0).abs() < 5e-3, "{speed}, not {wanted}");
    assert!((world.velocities()[1] * RADIUS / speed - 1.0).abs() < 1e-2, "{:?}", world.velocities());
}

/// Balls and capsules on the end of an upright cylinder, and on a lying one.
#[test]
fn shapes_rest_on_a_cylinder() {
    let capsule = Shape::Capsule { radius: 0.03, half_length: 0.02 };
    for (shape, thick, points) in [(Shape::Sphere { radius: 0.03 }, 0.03, 1.0), (capsule, 0.03, 2.0)] {
        let rotation = if points > 1.0 { turned(QUARTER) } else { turned(0.0) };
        let mut robot = Robot::new("tower");
        let start = Pose { position: [0.0, 0.0, 2.0 * HALF + thick + 0.001], rotation };
        let mass = MassProperties::from_shape(&shape, MASS);
        let body = robot.add_segment(Segment::new("thing", None, Joint::floating(start), mass));
        let skin = robot.add_collider(Collider::new("skin", Some(body), shape, Pose::identity()));
        let stand = robot.add_collider(Collider::new("stand", None, CYLINDER, Pose::at([0.0, 0.0, HALF])));
        robot.add_pair([stand, skin], SURFACE);
        let (height, speed) = settled(&robot);
        let wanted = 2.0 * HALF + thick - MASS * 9.81 / (points * 1e4);
        assert!((height - wanted).abs() < 1e-5 && speed < 1e-4, "{shape:?}: {height}, not {wanted}");
    }
}

#[test]
fn a_cylinder_on_a_box_is_refused() {
    let robot = cylinder_on(Pose::identity(), Shape::Box { half: [0.1; 3] }, Pose::identity());
    let error = Model::<f64>::new(&robot, &Options::default()).unwrap_err();
    assert!(matches!(error, ModelError::Robot(RobotError::Pair { fault: PairFault::Shapes, .. })), "{error}");
}

#[test]
fn cylinders_have_equal_bits_in_lanes() {
    let mut robot = cylinder_on(Pose::identity(), Shape::Plane, Pose::identity());
    for (i, shape) in
        [Shape::Sphere { radius: 0.05 }, Shape::Capsule { radius: 0.03, half_length: 0.06 }].into_iter().enumerate()
    {
        let mass = MassProperties::from_shape(&shape, 0.3);
        let body = Segment::new(&format!("thing {i}"), None, Joint::floating(Pose::identity()), mass);
        let body = robot.add_segment(body);
        let skin = robot.add_collider(Collider::new(&format!("skin {i}"), Some(body), shape, Pose::identity()));
        robot.add_pair([skin, 0], Surface { rolling_friction: 0.001, ..SURFACE });
        robot.add_pair([skin, 1], SURFACE);
    }
    let model = Model::new(&robot, &Options::default()).unwrap();
    crate::lanes_have_the_bits_of_the_world(&model, 120, |world, stream, step| {
        if step % 60 == 0 {
            for i in 0..3 {
                let at = [stream.range(-0.03, 0.03), stream.range(-0.03, 0.03), 0.12 + 0.12 * f32::from(i)];
                let angular = [stream.range(-5.0, 5.0), stream.range(-5.0, 5.0), stream.range(-5.0, 5.0)];
                world.place_body(BodyId(i), Pose::at(at), Twist { linear: [0.0, 0.0, -0.5], angular });
            }
            world.finish_placement();
        }
    });
}

#[cfg(feature = "rapier")]
#[test]
fn a_cylinder_rests_in_rapier() {
    use farsa_body::ports::Kinematics as _;
    for (rotation, wanted) in [(turned(0.0), HALF), (turned(QUARTER), RADIUS)] {
        let start = Pose { position: [0.0, 0.0, wanted + 0.01], rotation };
        let robot = cylinder_on(start, Shape::Plane, Pose::identity());
        let options = farsa_physics::rapier::Options::default();
        let mut world = farsa_physics::rapier::World::new(&robot, &options).unwrap();
        for _ in 0..200 {
            world.step();
        }
        let height = f64::from(world.pose(BodyId(0)).position[2]);
        println!("rapier: {:.1e} m below", wanted - height);
        assert!((height - wanted).abs() < 1e-3, "{height}, not {wanted}");
    }
}
