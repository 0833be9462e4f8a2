//! Largest speeds of joints, against closed forms, in one world, in lanes and in rapier.

use farsa_body::Pose;
use farsa_body::actuators::{Law, Torque};
use farsa_body::ports::{Actuated as _, ActuatorId, Arrange as _, JointId, Joints as _, World as _};
use farsa_body::robot::{Collider, Joint, MassProperties, Robot, Segment, Shape, Stop, Surface};
use farsa_physics::articulated::{Model, Options, World};

const ENDLESS: [f64; 2] = [f64::NEG_INFINITY, f64::INFINITY];

/// A mass of 2 kg on a horizontal rail, with a motor and a largest speed of 1.25 m/s.
fn cart() -> Robot {
    let mut robot = Robot::new("cart");
    let rail = Joint::prismatic("rail", [1.0, 0.0, 0.0], Pose::identity(), ENDLESS).with_speed_limit(1.25);
    robot.add_segment(Segment::new("cart", None, rail, MassProperties::sphere(2.0, 0.1)));
    robot.add_actuator("motor", JointId(0), Law::Torque(Torque { limit: 100.0 }));
    robot
}

#[test]
fn a_motor_pushes_to_the_largest_speed_and_back() {
    let mut world = World::new(Model::<f64>::new(&cart(), &Options::default()).unwrap());
    let mut speed = 0.0_f64;
    for step in 0..200 {
        // 4 m/s2 forwards, then 6 m/s2 backwards: the limit does not delay the return.
        let acceleration = if step < 100 { 4.0 } else { -6.0 };
        world.command(ActuatorId(0), [2.0 * acceleration as f32, 0.0]);
        world.step();
        speed = (speed + 0.01 * acceleration).clamp(-1.25, 1.25);
        assert!((world.velocities()[0] - speed).abs() < 1e-12, "step {step}: {:?}", world.velocities());
    }
    assert!((speed + 1.25).abs() < 1e-12);
}

/// A speed above the limit, for example of a start, is reduced to it in the first step.
#[test]
fn a_faster_start_is_slowed_at_once() {
    let mut world = World::new(Model::<f64>::new(&cart(), &Options::default()).unwrap());
    world.place_joint(JointId(0), 0.0, -3.0);
    world.finish_placement();
    world.step();
    assert!((world.velocities()[0] + 1.25).abs() < 1e-12, "{:?}", world.velocities());
}

/// Two bodies in free space on one hinge: the limit ends their acceleration and changes no momentum.
#[test]
fn free_bodies_keep_their_momentum_at_the_largest_speed() {
    let mut robot = Robot::new("pair");
    let ball = |at: f64| MassProperties::sphere(1.0, 0.1).placed(&Pose::at([at, 0.0, 0.0]));
    let base = robot.add_segment(Segment::new("base", None, Joint::floating(Pose::identity()), ball(-0.2)));
    let joint = Joint::revolute("joint", [0.0, 0.0, 1.0], Pose::identity(), ENDLESS).with_speed_limit(2.0);
    let tip = robot.add_segment(Segment::new("tip", Some(base), joint, ball(0.2)));
    robot.add_actuator("motor", JointId(tip.0), Law::Torque(Torque { limit: 1.0 }));
    let options = Options { gravity: [0.0; 3], time_step: 1e-4, substeps: 1, ..Options::default() };
    let mut world = World::new(Model::<f64>::new(&robot, &options).unwrap());
    world.command(ActuatorId(0), [0.2, 0.0]);
    for _ in 0..10_000 {
        world.step();
        assert!(world.velocities()[6] <= 2.0 + 1e-9, "{:?}", world.velocities());
    }
    assert!((world.velocities()[6] - 2.0).abs() < 1e-9, "{:?}", world.velocities());
    assert!(world.momentum().iter().all(|x| x.abs() < 3e-4), "{:?}", world.momentum());
}

/// A chain above a floor, with limits on all joints, soft stops on some and dry friction on others.
fn chain() -> Robot {
    let mut robot = Robot::new("chain");
    let mut parent = None;
    let floor = robot.add_collider(Collider::new("floor", None, Shape::Plane, Pose::at([0.0, 0.0, -0.7])));
    for i in 0..4_u16 {
        let at = Pose::at([0.0, 0.0, if i == 0 { 0.0 } else { -0.2 }]);
        let mut joint = Joint::revolute(&format!("J{i}"), [0.0, 1.0, 0.0], at, [-1.0, 1.5]).with_speed_limit(3.0);
        if i % 2 == 0 {
            joint.stop = Some(Stop { stiffness: 50.0, damping: 1.0, inertia: 0.01, impedance: None });
        } else {
            joint = joint.with_friction(0.02);
        }
        let rod = MassProperties::capsule(0.4, 0.02, 0.1).placed(&Pose::at([0.0, 0.0, -0.1]));
        let body = robot.add_segment(Segment::new(&format!("rod{i}"), parent, joint, rod));
        let skin = Collider::capsule_between(&format!("skin{i}"), Some(body), [0.0; 3], [0.0, 0.0, -0.2], 0.02);
        let skin = robot.add_collider(skin);
        robot.add_pair([skin, floor], Surface { friction: 0.6, rolling_friction: 0.0, stiffness: 1e4, damping: 50.0 });
        robot.add_actuator(&format!("motor {i}"), JointId(body.0), Law::Torque(Torque { limit: 6.0 }));
        parent = Some(body);
    }
    robot
}

/// The motors and the floor push all joints to their limits, together.
#[test]
fn no_joint_of_a_chain_exceeds_its_largest_speed() {
    let options = Options { sweeps: 500, settled: 0.0, ..Options::default() };
    let mut world = World::new(Model::<f64>::new(&chain(), &options).unwrap());
    let mut at_limit = [0; 4];
    for step in 0..300 {
        for i in 0..4 {
            world.command(ActuatorId(i), [if (step / 20 + usize::from(i)) % 2 == 0 { 6.0 } else { -6.0 }, 0.0]);
        }
        world.step();
        for (count, speed) in at_limit.iter_mut().zip(world.velocities()) {
            assert!(speed.abs() <= 3.0 + 1e-6, "step {step}: {speed}");
            *count += usize::from(speed.abs() > 3.0 - 1e-6);
        }
    }
    assert!(at_limit.iter().all(|count| *count > 20), "{at_limit:?}");
}

#[test]
fn largest_speeds_have_equal_bits_in_lanes() {
    let options = Options { path_error: Some(1e-4), ..Options::default() };
    let model = Model::new(&chain(), &options).unwrap();
    crate::lanes_have_the_bits_of_the_world(&model, 120, |world, stream, step| {
        if step % 8 == 0 {
            for i in 0..4 {
                world.command(ActuatorId(i), [stream.range(-8.0, 8.0), 0.0]);
            }
        }
    });
}

/// rapier clamps the speed after each of its steps.
#[cfg(feature = "rapier")]
#[test]
fn rapier_has_the_same_largest_speeds() {
    let mut world = farsa_physics::rapier::World::new(&cart(), &farsa_physics::rapier::Options::default()).unwrap();
    for (force, wanted) in [(8.0, 1.25), (-12.0, -1.25)] {
        world.command(ActuatorId(0), [force, 0.0]);
        for _ in 0..100 {
            world.step();
            assert!(world.speed(JointId(0)).abs() <= 1.25, "{}", world.speed(JointId(0)));
        }
        assert!((world.speed(JointId(0)) - wanted).abs() < 1e-6, "{}", world.speed(JointId(0)));
    }
}
