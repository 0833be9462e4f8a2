//! Robots that were written are read as they were.

use farsa_body::Pose;
use farsa_body::actuators::{Law, Torque};
use farsa_body::kinematics::KinematicTree;
use farsa_body::robot::{JointKind, Robot, Shape, Stop};
use farsa_body::robots::{ArmAndHand, Tabletop};
use farsa_models::mjcf::{self, MjcfOptions};
use farsa_models::{Imported, ReadOptions, urdf};

use crate::{fixture, read};

fn scene() -> Robot {
    Tabletop::default().scene(&ArmAndHand::default()).unwrap()
}

/// Returns the robot, but for the laws and surfaces that a format does not have. The caller compares them.
fn same(written: &Robot, read: &Robot, tolerance: f64) {
    assert_eq!(read.name, written.name);
    assert_eq!(read.segments.len(), written.segments.len());
    let close = |a: &[f64], b: &[f64]| a.iter().zip(b).all(|(a, b)| a == b || (a - b).abs() <= tolerance);
    for (a, b) in written.segments.iter().zip(&read.segments) {
        assert_eq!((&b.name, b.parent, b.joint.kind), (&a.name, a.parent, a.joint.kind));
        let poses = [&a.joint.placement, &b.joint.placement];
        assert!(close(&poses[0].position, &poses[1].position), "{}", a.name);
        let same: f64 = poses[0].rotation.iter().zip(&poses[1].rotation).map(|(a, b)| a * b).sum();
        assert!((same.abs() - 1.0).abs() <= tolerance.max(1e-15), "{}", a.name);
        assert!(
            close(&[a.mass], &[b.mass]) && close(&a.centre, &b.centre) && close(&a.inertia, &b.inertia),
            "{}",
            a.name
        );
        if a.joint.kind.is_single() {
            assert_eq!(b.joint.name, a.joint.name);
            let unit = |v: [f64; 3]| v.map(|x| x / v.iter().map(|x| x * x).sum::<f64>().sqrt());
            assert!(close(&unit(a.joint.axis), &unit(b.joint.axis)), "{}", a.joint.name);
            assert_eq!((b.joint.range, b.joint.damping), (a.joint.range, a.joint.damping));
        }
    }
    assert_eq!(read.colliders.len(), written.colliders.len());
    for a in &written.colliders {
        let b = &read.colliders[read.collider(&a.name).unwrap_or_else(|| panic!("collider {}", a.name))];
        assert_eq!(b.body, a.body);
        assert!(close(&a.placement.position, &b.placement.position), "{}", a.name);
    }
}

#[test]
fn mjcf_is_read_as_it_was_written() {
    for (name, robot) in [("tabletop", scene()), ("zoo", read(&fixture("zoo.xml")).unwrap().robot)] {
        let text = mjcf::write(&robot, &MjcfOptions::default()).unwrap();
        let reading = read(&text).unwrap();
        // To the last bit, except for the parts that the format does not have.
        let mut expected = robot.clone();
        for actuator in &mut expected.actuators {
            if let Law::MusclePair(_) | Law::Held(_) = actuator.law {
                actuator.law = Law::Torque(Torque { limit: f64::INFINITY });
            }
        }
        // Geoms follow their bodies, and bodies are depth first, so the lists may have another order.
        same(&expected, &reading.robot, 0.0);
        assert_eq!(reading.robot.actuators, expected.actuators, "{name}");
        let stops = reading.robot.segments.iter().filter(|segment| segment.joint.stop.is_some());
        let limited = expected.segments.iter().filter(|segment| segment.joint.range.iter().any(|end| end.is_finite()));
        let limited = limited.filter(|segment| segment.joint.kind.is_single());
        assert_eq!(stops.count(), limited.count(), "{name}");
        let without_stops = |robot: &Robot| {
            let mut segments = robot.segments.clone();
            for segment in &mut segments {
                segment.joint.stop = None;
            }
            segments
        };
        assert_eq!(without_stops(&reading.robot), without_stops(&expected), "{name}");
        for collider in &expected.colliders {
            let read = &reading.robot.colliders[reading.robot.collider(&collider.name).unwrap()];
            assert_eq!(read, collider, "{name}");
        }
        assert_eq!(reading.robot.pairs.len(), expected.pairs.len(), "{name}");
        for pair in &expected.pairs {
            let [a, b] = pair.colliders.map(|i| expected.colliders[i].name.as_str());
            let read = reading.robot.pairs[reading.robot.pair(a, b).unwrap().index()].surface;
            assert_eq!(read.friction, pair.surface.friction);
            assert_eq!(read.rolling_friction, pair.surface.rolling_friction);
            // The stiffness is written as a time constant and an impedance near 1.
            assert!((read.stiffness / pair.surface.stiffness - 1.0).abs() < 1e-8, "{name}: {a}, {b}: {read:?}");
        }
        let warnings: Vec<&str> = reading.warnings.iter().map(|note| note.what.as_str()).collect();
        let options = ["option `integrator`", "option `timestep`"];
        assert_eq!(warnings, options, "{name}");
    }
}

#[test]
fn the_zoo_is_described_as_the_readers_of_the_fixtures_say() {
    // Written by `mjcf::write` from tests/export.rs, where its numbers are compared with MuJoCo's.
    let reading = read(&fixture("zoo.xml")).unwrap();
    let robot = &reading.robot;
    assert_eq!(robot.name, "zoo & \"co\"");
    let kinds: Vec<JointKind> = robot.segments.iter().map(|segment| segment.joint.kind).collect();
    assert_eq!(kinds.iter().filter(|kind| **kind == JointKind::Prismatic).count(), 2);
    assert!(kinds.contains(&JointKind::Fixed) && kinds.contains(&JointKind::Floating));
    assert_eq!(robot.colliders.iter().filter(|collider| collider.shape == Shape::Plane).count(), 1);
    assert_eq!((robot.pairs.len(), robot.actuators.len()), (2, 2));
    assert!(robot.segments.iter().any(|segment| segment.joint.range == [f64::NEG_INFINITY, f64::INFINITY]));
}

#[test]
fn urdf_is_read_as_it_was_written() {
    for robot in [scene(), read(&fixture("zoo.xml")).unwrap().robot] {
        let reading = read(&urdf::write(&robot).unwrap()).unwrap();
        // A plane is a block in a URDF, whose middle is in other places.
        let mut expected = robot.clone();
        for collider in &mut expected.colliders {
            if collider.shape == Shape::Plane {
                collider.shape = Shape::Box { half: [50.0; 3] };
                collider.placement = collider.placement.compose(&Pose::at([0.0, 0.0, -50.0]));
            }
        }
        same(&expected, &reading.robot, 1e-14);
        for collider in &expected.colliders {
            let read = &reading.robot.colliders[reading.robot.collider(&collider.name).unwrap()];
            assert_eq!(read.shape, collider.shape, "{}", collider.name);
        }
        assert!(reading.robot.pairs.is_empty());
        // Efforts are kept, as motors.
        for actuator in &robot.actuators {
            let limit = match actuator.law {
                Law::MusclePair(pair) => pair.moment_arm * pair.tension,
                Law::Servo(servo) => servo.limit,
                Law::Torque(torque) => torque.limit,
                Law::Velocity(motor) => motor.limit,
                Law::Held(_) => f64::INFINITY,
            };
            let name = &robot.segments[actuator.joint.index()].joint.name;
            let read = reading.robot.actuator(name).map(|id| &reading.robot.actuators[id.index()]);
            assert_eq!(
                read.map(|read| (read.joint, read.law)),
                (limit > 0.0).then_some((actuator.joint, Law::Torque(Torque { limit })))
            );
        }
        let tree = KinematicTree::new(&robot).unwrap();
        let again = KinematicTree::new(&reading.robot).unwrap();
        let q = tree.zero();
        for (a, b) in tree.poses(&q).iter().zip(again.poses(&q)) {
            assert!((0..3).all(|k| (a.position[k] - b.position[k]).abs() < 1e-12));
        }
    }
}

/// Stops are those of the numbers of MuJoCo's limits, and stay what they are in a written file.
#[test]
fn stops_are_written_as_limits_and_read_back() {
    let text = "<mujoco><compiler angle='radian'/><worldbody><body><joint name='a' axis='0 1 0' range='-1 0.5' armature='1'/>\
                <geom type='capsule' size='0.05' fromto='0 0 0 1 0 0' mass='1'/><body pos='1 0 0'><joint name='b' axis='0 1 0' \
                range='-1 1' solreflimit='-300 -20' solimplimit='0 0.8 0.03'/><geom size='0.1' pos='0.2 0 0' mass='2'/></body>\
                <body><joint name='c'/><geom size='0.1' mass='1'/></body></body></worldbody></mujoco>";
    let robot = read(text).unwrap().robot;
    let stop = |robot: &Robot, joint: &str| robot.segments[robot.joint(joint).unwrap().index()].joint.stop;
    assert_eq!(stop(&robot, "c"), None, "it has no limits");
    // MuJoCo 4.0.0: `dof_invweight0` of a and b.
    for (joint, weight, [spring, damper], d) in
        [("a", 0.6530021635334463, [2500.0, 100.0], 0.95), ("b", 31.444802070313656, [300.0, 20.0], 0.8)]
    {
        let Stop { stiffness, damping, inertia, .. } = stop(&robot, joint).unwrap();
        let yielding = (1.0 - d) * weight;
        for (found, wanted) in [(stiffness, spring / yielding), (damping, damper / yielding), (inertia, d / yielding)] {
            assert!((found / wanted - 1.0).abs() < 1e-9, "{joint}: {found}, not {wanted}");
        }
    }
    let again = read(&mjcf::write(&robot, &MjcfOptions::default()).unwrap()).unwrap().robot;
    for joint in ["a", "b"] {
        let [a, b] = [&robot, &again].map(|robot| stop(robot, joint).unwrap());
        for (a, b) in [(a.stiffness, b.stiffness), (a.damping, b.damping), (a.inertia, b.inertia)] {
            assert!((a / b - 1.0).abs() < 1e-9, "{joint}: {a} and {b}");
        }
    }
}

/// Cylinders are read as such on demand, and stay what they are in written files.
#[test]
fn cylinders_are_read_on_demand_and_written() {
    let cylinder = Shape::Cylinder { radius: 0.05, half_length: 0.2 };
    let mjcf_text = "<mujoco><worldbody><body><freejoint/><geom name='g' type='cylinder' size='0.05 0.2' mass='1'/></body>\
                     </worldbody></mujoco>";
    let urdf_text = "<robot name='r'><link name='a'><collision name='g'><geometry><cylinder radius='0.05' length='0.4'/></geometry>\
                     </collision></link></robot>";
    for text in [mjcf_text, urdf_text] {
        let with = |text: &str, cylinders: bool| {
            Imported::from_text(text, &ReadOptions { cylinders, ..ReadOptions::default() }).unwrap()
        };
        let capsule = with(text, false);
        assert_eq!(capsule.robot.colliders[0].shape, Shape::Capsule { radius: 0.05, half_length: 0.15000000000000002 });
        assert!(capsule.warnings.iter().any(|note| note.why.contains("became the capsule")), "{:?}", capsule.warnings);
        let read = with(text, true);
        assert_eq!(read.robot.colliders[0].shape, cylinder);
        assert!(!read.warnings.iter().any(|note| note.why.contains("capsule")), "{:?}", read.warnings);
        let mass = |robot: &Robot| robot.segments.iter().map(|segment| segment.mass).sum::<f64>();
        assert_eq!(mass(&read.robot), mass(&capsule.robot));
        for written in [mjcf::write(&read.robot, &MjcfOptions::default()).unwrap(), urdf::write(&read.robot).unwrap()] {
            assert_eq!(with(&written, true).robot.colliders[0].shape, cylinder, "{written}");
        }
    }
}
