//! An arm in the plane and three balls that slide on the ground.
#![allow(dead_code, reason = "every test uses a part of it")]

use farsa_body::Pose;
use farsa_body::actuators::{Law, Velocity};
use farsa_body::ports::JointId;
use farsa_body::robot::{Collider, Ground, Joint, MassProperties, Robot, Segment, Shape, Surface};

/// Mass of a ball [kg].
pub(crate) const MASS: f64 = 0.3;
/// Its coefficient of friction on the ground.
pub(crate) const FRICTION: f64 = 0.5;
/// Gravity [m/s2].
pub(crate) const GRAVITY: f64 = 9.81;
/// Radius of a ball [m].
const RADIUS: f64 = 0.06;

/// The arm of two segments and three balls of the instructions' experiment.
pub(crate) fn arm(turns: bool) -> Robot {
    let mut robot = Robot::new("arm");
    let mut parent = None;
    let mut at = Pose::at([0.0, 0.0, RADIUS]);
    let mut shapes = Vec::new();
    for (name, length, mass, range, gain, limit) in
        [("first", 1.0, 1.5, 2.967, 40.0, 20.0), ("second", 0.5, 0.75, 2.356, 20.0, 10.0)]
    {
        let capsule = Collider::capsule_between(name, None, [0.0; 3], [length, 0.0, 0.0], 0.03);
        let joint = Joint::revolute(&format!("{name} joint"), [0.0, 0.0, 1.0], at, [-range, range]);
        let body = robot.add_segment(Segment::new(name, parent, joint, capsule.mass_properties(mass)));
        shapes.push(robot.add_collider(Collider { body: Some(body), ..capsule }));
        robot.add_actuator(name, JointId(body.0), Law::Velocity(Velocity { gain, limit }));
        (parent, at) = (Some(body), Pose::at([length, 0.0, 0.0]));
    }
    let surface = Surface { friction: 0.3, rolling_friction: 0.0, stiffness: 2e4, damping: 40.0 };
    let mut balls = Vec::new();
    for (i, place) in [[0.675, 1.169], [1.35, 0.0], [0.675, -1.169]].into_iter().enumerate() {
        let ball = MassProperties::sphere(MASS, RADIUS);
        let body = robot.add_sliding_body(&format!("ball {i}"), Pose::at([place[0], place[1], RADIUS]), ball, turns);
        robot.add_ground(Ground { body, friction: FRICTION, load: MASS * GRAVITY, radius: 0.01 });
        let ball = Collider::new(&format!("ball {i}"), Some(body), Shape::Sphere { radius: RADIUS }, Pose::identity());
        let ball = robot.add_collider(ball);
        for shape in shapes.iter().chain(&balls) {
            robot.add_pair([ball, *shape], surface);
        }
        balls.push(ball);
    }
    robot
}
