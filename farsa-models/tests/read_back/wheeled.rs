//! Wheeled robots that were written are read as they were.

use farsa_body::actuators::{Law, Torque};
use farsa_body::robot::JointKind;
use farsa_body::robots::MobileRobot;
use farsa_models::mjcf::{self, MjcfOptions};
use farsa_models::urdf;
use farsa_num::sin_cos;

use crate::{read, round_trip};

fn robots() -> [MobileRobot; 3] {
    [MobileRobot::khepera(), MobileRobot::e_puck(), MobileRobot::marxbot()]
}

#[test]
fn wheeled_robots_are_read_as_they_were_written() {
    for mobile in robots() {
        let robot = mobile.description();
        round_trip::lost(&robot).unwrap();
        let text = mjcf::write(&robot, &MjcfOptions::default()).unwrap();
        let back = read(&text).unwrap().robot;
        for pair in &robot.pairs {
            let [a, b] = pair.colliders.map(|i| robot.colliders[i].name.as_str());
            let surface = back.pairs[back.pair(a, b).unwrap().index()].surface;
            assert_eq!(surface.friction, pair.surface.friction, "{}: {a}, {b}", mobile.name);
            let ratio = surface.stiffness / pair.surface.stiffness;
            assert!((ratio - 1.0).abs() < 1e-8, "{}: {a}, {b}: {ratio}", mobile.name);
        }
    }
}

#[test]
fn a_urdf_has_the_wheels_and_a_frame_at_every_sensor() {
    for mobile in robots() {
        let text = urdf::write(&mobile.description()).unwrap();
        let back = read(&text).unwrap().robot;
        for (name, left) in [("left wheel", 0.5), ("right wheel", -0.5)] {
            assert!(text.contains(&format!("<joint name=\"{name}\" type=\"continuous\">")), "{text}");
            let wheel = &back.segments[back.body(name).unwrap().index()];
            assert_eq!((wheel.joint.kind, wheel.joint.axis), (JointKind::Revolute, [0.0, 1.0, 0.0]));
            assert_eq!(wheel.joint.placement.position, [0.0, left * mobile.track, mobile.wheel_radius]);
            let motor = &back.actuators[back.actuator(name).unwrap().index()];
            let limit = 0.25 * 9.81 * mobile.mass() * mobile.wheel_radius;
            assert_eq!(motor.law, Law::Torque(Torque { limit }), "{}", mobile.name);
        }
        let frame = |name: String| {
            let body = back.body(&name).unwrap_or_else(|| panic!("{}: no {name}", mobile.name));
            let segment = &back.segments[body.index()];
            assert_eq!((segment.parent, segment.joint.kind), (back.body("hull"), JointKind::Fixed), "{name}");
            let place = segment.joint.placement;
            (place.position, place.rotate([1.0, 0.0, 0.0]))
        };
        let near = |a: [f64; 3], b: [f64; 3]| a.iter().zip(b).all(|(a, b)| (a - b).abs() < 1e-14);
        for (number, angle) in mobile.infrared.angles.iter().enumerate() {
            let (position, ahead) = frame(format!("infrared {}", number + 1));
            let (sine, cosine) = sin_cos(*angle);
            assert!(near(ahead, [cosine, sine, 0.0]), "{} {number}: {ahead:?}", mobile.name);
            let on_the_hull = [mobile.radius * cosine, mobile.radius * sine, position[2]];
            assert!(near(position, on_the_hull) && position[2] < mobile.height, "{} {number}", mobile.name);
        }
        for (number, [x, y]) in mobile.ground.iter().enumerate() {
            let (position, down) = frame(format!("ground {}", number + 1));
            assert!(near(down, [0.0, 0.0, -1.0]) && near(position, [*x, *y, position[2]]), "{} {number}", mobile.name);
        }
        let frames = mobile.infrared.angles.len() + mobile.ground.len();
        assert_eq!(back.segments.len(), 3 + frames, "{}", mobile.name);
    }
}
