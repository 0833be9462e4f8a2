//! The arm without a heap, compared with the articulated bodies of farsa-physics.

use farsa_body::robot::Robot;
use farsa_body::robots::ArmAndHand;
use farsa_num::{Domain, Stream};
use farsa_physics::articulated::{LinkData, Model, Options, forward_kinematics, inverse_dynamics};
use firmware_controller::ARM;

/// The arm of the description without its fingers.
fn arm() -> Robot {
    let mut robot = ArmAndHand::default().robot().expect("the default");
    robot.segments.truncate(7);
    robot.colliders.clear();
    robot.pairs.clear();
    robot.actuators.clear();
    robot
}

#[test]
fn the_numbers_are_those_of_the_description() {
    for (link, segment) in ARM.links.iter().zip(&arm().segments) {
        let near = |own: [f32; 3], other: [f64; 3]| {
            let close = own.iter().zip(other).all(|(a, b)| (f64::from(*a) - b).abs() <= 1e-6 * b.abs() + 1e-9);
            assert!(close, "{}: {own:?} where the description has {other:?}", segment.name);
        };
        let [xx, yy, zz, ..] = segment.inertia;
        near(link.axis, segment.joint.axis);
        near(link.offset, segment.joint.placement.position);
        near(link.centre, segment.centre);
        near(link.inertia, [xx, yy, zz]);
        near([link.mass, link.armature, 0.0], [segment.mass, segment.joint.armature, 0.0]);
    }
}

#[test]
fn torques_are_those_of_the_articulated_bodies() {
    let model = Model::<f64>::new(&arm(), &Options::default()).expect("an arm");
    let mut stream = Stream::new(1, Domain::Start, 0, 0, 0);
    let mut work = vec![LinkData::<f64>::new(()); model.links().len()];
    let mut worst = 0.0_f64;
    for case in 0..1000 {
        let mut draw = |range: f32| core::array::from_fn::<f32, 7, _>(|_| stream.range(-range, range));
        let moving = if case % 2 == 0 { 0.0 } else { 5.0 };
        let (q, qd, qdd) = (draw(3.0), draw(moving), draw(4.0 * moving));
        let [wide, speeds, accelerations] = [q, qd, qdd].map(|values| values.map(f64::from));
        let mut expected = [0.0; 7];
        forward_kinematics((), model.links(), &wide, &speeds, &mut work);
        inverse_dynamics((), model.links(), model.gravity(), &accelerations, &mut work, &mut expected);
        let found = ARM.torques(&q, &qd, &qdd);
        if case % 2 == 0 {
            assert_eq!(found, ARM.holding_torques(&q));
        }
        let largest = expected.iter().fold(1.0_f64, |most, torque| most.max(torque.abs()));
        for (a, b) in found.iter().zip(expected) {
            worst = worst.max((f64::from(*a) - b).abs() / largest);
        }
    }
    assert!(worst < 5e-6, "{worst:e} of the largest torque");
}
