//! Tests of the errors of a description.

use super::*;
use crate::actuators::law::{Held, Servo, Torque, Velocity};
use crate::actuators::muscle::MusclePair;
use crate::ports::{BodyId, JointId};
use crate::robot::description::{Collider, SoftContact};
use crate::robot::joint::{Joint, Stop};
use crate::robot::mass_properties::MassProperties;
use alloc::format;
use alloc::string::ToString;
use alloc::vec::Vec;

fn good() -> Robot {
    let mut r = Robot::new("good");
    let at = Pose::at([0.0, 0.0, 0.1]);
    let ball = MassProperties::sphere(1.0, 0.1);
    let hinge = Joint::revolute("hinge", [0.0, 2.0, 0.0], at, [f64::NEG_INFINITY, f64::INFINITY]);
    let arm = r.add_segment(Segment::new("arm", None, hinge, ball));
    let slide = Joint::prismatic("slide", [1.0, 0.0, 0.0], at, [0.0, 0.1]);
    r.add_segment(Segment::new("hand", Some(arm), slide, ball));
    let skin = MassProperties::sphere(0.0, 0.0);
    r.add_segment(Segment::new("skin", Some(arm), Joint::fixed(at), skin));
    r.add_segment(Segment::new("thing", None, Joint::floating(at), ball));
    let shapes = [
        ("a", Some(BodyId(0)), Shape::Sphere { radius: 0.1 }),
        ("b", Some(BodyId(1)), Shape::Capsule { radius: 0.1, half_length: 0.0 }),
        ("c", Some(BodyId(3)), Shape::Box { half: [0.1; 3] }),
        ("d", None, Shape::Plane),
        ("e", Some(BodyId(2)), Shape::Plane),
    ];
    for (name, body, shape) in shapes {
        r.add_collider(Collider::new(name, body, shape, at));
    }
    let surface = Surface { friction: 1.0, rolling_friction: 0.0, stiffness: 1e4, damping: 10.0 };
    for pair in [[0, 1], [0, 2], [0, 3], [1, 2], [3, 1], [3, 2]] {
        r.add_pair(pair, surface);
    }
    r.add_actuator("muscles", JointId(0), Law::MusclePair(MusclePair::thesis(300.0, 0.01, [-1.0, 1.0])));
    r.add_actuator("servo", JointId(1), Law::Servo(Servo { stiffness: 1.0, damping: 0.1, limit: f64::INFINITY }));
    r.add_actuator("torque", JointId(0), Law::Torque(Torque { limit: 1.0 }));
    r.add_actuator("velocity", JointId(0), Law::Velocity(Velocity { gain: 1.0, limit: f64::INFINITY }));
    r.add_actuator("held", JointId(0), Law::Held(Held { stiffness: 1.0, damping: 0.0 }));
    r
}

fn fault(change: impl FnOnce(&mut Robot)) -> RobotError {
    let mut robot = good();
    change(&mut robot);
    robot.validate().expect_err("a fault")
}

fn muscles(robot: &mut Robot) -> &mut MusclePair<f64> {
    let Law::MusclePair(m) = &mut robot.actuators[0].law else { panic!("no muscles") };
    m
}

#[test]
fn a_good_robot_passes() {
    assert_eq!(good().validate(), Ok(()));
    assert_eq!(Robot::default().validate(), Ok(()));
}

#[test]
fn faults_of_structure() {
    let name = |s: &str| s.to_string();
    let structure = |why: &str| RobotError::Structure { why: why.into() };
    assert_eq!(
        fault(|r| r.segments[1].parent = Some(BodyId(1))),
        structure("segment hand: parent 1 is not an earlier segment")
    );
    let floating = structure("segment thing: a floating joint must not have a parent");
    assert_eq!(fault(|r| r.segments[3].parent = Some(BodyId(0))), floating);
    assert_eq!(fault(|r| r.segments[1].name = name("arm")), RobotError::Name { name: name("arm") });
    assert_eq!(fault(|r| r.segments[1].joint.name = name("hinge")), RobotError::Name { name: name("hinge") });
    assert_eq!(fault(|r| r.colliders[1].name = name("a")), RobotError::Name { name: name("a") });
    assert_eq!(fault(|r| r.actuators[1].name = name("held")), RobotError::Name { name: name("held") });
    assert_eq!(fault(|r| r.segments[1].name.clear()), structure("segment 1 has no name"));
    assert_eq!(fault(|r| r.segments[1].joint.name.clear()), structure("joint 1 has no name"));
    let body = RobotError::Index { part: name("a"), field: "body", index: 4, count: 4 };
    assert_eq!(fault(|r| r.colliders[0].body = Some(BodyId(4))), body);
    let joint = RobotError::Index { part: name("servo"), field: "joint", index: 9, count: 4 };
    assert_eq!(fault(|r| r.actuators[1].joint = JointId(9)), joint);
    assert_eq!(
        fault(|r| r.actuators[1].joint = JointId(2)),
        structure("actuator servo: the joint of segment skin neither turns nor slides")
    );
    let collider = RobotError::Index { part: name("a pair"), field: "collider", index: 5, count: 5 };
    assert_eq!(fault(|r| r.pairs[0].colliders[1] = 5), collider);
    let colliders = [name("b"), name("a")];
    assert_eq!(fault(|r| r.pairs[1].colliders = [1, 0]), RobotError::Pair { colliders, fault: PairFault::Twice });
    let same = RobotError::Pair { colliders: [name("a"), name("a")], fault: PairFault::SameBody };
    assert_eq!(fault(|r| r.pairs[0].colliders = [0, 0]), same);
    let colliders = [name("d"), name("e")];
    assert_eq!(fault(|r| r.pairs[0].colliders = [3, 4]), RobotError::Pair { colliders, fault: PairFault::Shapes });
    let many = fault(|r| r.pairs = alloc::vec![r.pairs[0]; 65536]);
    assert_eq!(many, RobotError::Count { parts: "pairs", count: 65536 });
}

fn stop(robot: &mut Robot, [stiffness, damping, inertia]: [f64; 3]) {
    robot.segments[0].joint.stop = Some(Stop { stiffness, damping, inertia, impedance: None });
}

fn soft(robot: &mut Robot, [inertia, margin]: [f64; 2], change: fn(&mut Impedance)) {
    let mut impedance = Impedance { surface: 0.9, deep: 0.95, width: 0.001, midpoint: 0.5, power: 2 };
    change(&mut impedance);
    let friction = [1.0, inertia];
    let soft = SoftContact { inertia: 0.0, friction, margin, is_pyramid: true, impedance: Some(impedance) };
    robot.pairs[0].soft = Some(soft);
}

#[test]
fn faults_of_numbers() {
    type Change = fn(&mut Robot);
    let values: [(&str, Change); 52] = [
        ("rotation", |r| r.segments[0].joint.placement.rotation[3] = 1.1),
        ("rotation", |r| r.colliders[0].placement.rotation[0] = f64::NAN),
        ("position", |r| r.colliders[0].placement.position[0] = f64::INFINITY),
        ("mass", |r| r.segments[0].mass = -1.0),
        ("mass", |r| r.segments[2].mass = f64::NAN),
        ("centre of mass", |r| r.segments[0].centre[2] = f64::NAN),
        ("inertia", |r| r.segments[0].inertia[5] = f64::NAN),
        ("armature", |r| r.segments[0].joint.armature = -1.0),
        ("joint damping", |r| r.segments[0].joint.damping = f64::NAN),
        ("joint stiffness", |r| r.segments[0].joint.stiffness = -1.0),
        ("rest position", |r| r.segments[0].joint.rest = f64::INFINITY),
        ("joint friction", |r| r.segments[0].joint.friction = -0.1),
        ("stiffness of the stops", |r| stop(r, [0.0, 1.0, 0.0])),
        ("damping of the stops", |r| stop(r, [1.0, -1.0, 0.0])),
        ("inertia of the stops", |r| stop(r, [1.0, 1.0, -1.0])),
        ("axis", |r| r.segments[0].joint.axis = [0.0; 3]),
        ("axis", |r| r.segments[0].joint.axis[0] = f64::NAN),
        ("radius", |r| r.colliders[0].shape = Shape::Sphere { radius: 0.0 }),
        ("half length", |r| r.colliders[0].shape = Shape::Capsule { radius: 1.0, half_length: -1.0 }),
        ("half edge length", |r| r.colliders[0].shape = Shape::Box { half: [1.0, 0.0, 1.0] }),
        ("friction", |r| r.pairs[0].surface.friction = -0.1),
        ("rolling friction", |r| r.pairs[0].surface.rolling_friction = f64::NAN),
        ("contact stiffness", |r| r.pairs[0].surface.stiffness = 0.0),
        ("contact damping", |r| r.pairs[0].surface.damping = -1.0),
        ("inertia of friction", |r| soft(r, [0.0, 0.0], |_| ())),
        ("margin of the contact", |r| soft(r, [1.0, -0.1], |_| ())),
        ("impedance at the surface", |r| soft(r, [1.0, 0.0], |law| law.surface = 0.0)),
        ("impedance at depth", |r| soft(r, [1.0, 0.0], |law| law.deep = 1.0)),
        ("friction of the pyramid", |r| {
            soft(r, [1.0, 0.0], |_| ());
            r.pairs[0].surface.friction = 0.0;
        }),
        ("width of the impedance", |r| soft(r, [1.0, 0.0], |law| law.width = 0.0)),
        ("midpoint of the impedance", |r| soft(r, [1.0, 0.0], |law| law.midpoint = f64::NAN)),
        ("power of the impedance", |r| soft(r, [1.0, 0.0], |law| law.power = 3)),
        ("tension", |r| muscles(r).tension = f64::NAN),
        ("moment arm", |r| muscles(r).moment_arm = -0.01),
        ("range", |r| muscles(r).upper = f64::INFINITY),
        ("upper end of the range", |r| muscles(r).upper = muscles(r).lower),
        ("rest length", |r| muscles(r).rest_length = 1.0),
        ("longest length", |r| muscles(r).longest = 2.5),
        ("shape", |r| muscles(r).shape = 0.0),
        ("viscosity", |r| muscles(r).viscosity = -0.9),
        ("limit", |r| r.actuators[2].law = Law::Torque(Torque { limit: f64::NAN })),
        ("damping", |r| r.actuators[3].law = Law::Held(Held { stiffness: 1.0, damping: -1.0 })),
        ("colour", |r| r.colliders[0].color = Some([0.0, 1.5, 0.0])),
        ("restitution", |r| r.pairs[0].restitution = 1.5),
        ("restitution", |r| r.pairs[0].restitution = f64::NAN),
        ("restitution of a pyramid", |r| {
            soft(r, [1.0, 0.0], |_| ());
            r.pairs[0].restitution = 0.5;
        }),
        ("largest speed", |r| r.segments[0].joint.speed_limit = Some(0.0)),
        ("largest speed", |r| r.segments[0].joint.speed_limit = Some(f64::INFINITY)),
        ("lower end of the commands", |r| r.actuators[1].command_range = Some([f64::NAN, 1.0])),
        ("upper end of the commands", |r| r.actuators[1].command_range = Some([1.0, 0.5])),
        ("upper end of the commands", |r| r.actuators[1].command_range = Some([0.0, f64::NAN])),
        ("gain", |r| r.actuators[3].law = Law::Velocity(Velocity { gain: -1.0, limit: 1.0 })),
    ];
    for (expected, change) in values {
        let error = fault(change);
        let RobotError::Value { part, field, .. } = &error else { panic!("{expected}: {error}") };
        assert!(field.contains(expected), "{expected}: {error}");
        assert_eq!(format!("{error}").find(part.as_str()), Some(0), "the message names the part");
    }
    for range in [[1.0, -1.0], [f64::NAN, 1.0], [f64::INFINITY; 2]] {
        let error = fault(|r| r.segments[0].joint.range = range);
        assert!(matches!(&error, RobotError::Range { joint, .. } if joint == "hinge"), "{error}");
    }
    let impossible: Vec<fn(&mut Robot)> =
        alloc::vec![|r| r.segments[0].mass = 0.0, |r| r.segments[3].inertia = [0.0; 6], |r| r.segments[1].inertia =
            [1.0, 1.0, 3.0, 0.0, 0.0, 0.0],];
    for change in impossible {
        let error = fault(change);
        assert!(matches!(error, RobotError::Inertia { .. }), "{error}");
    }
}
