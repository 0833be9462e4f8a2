//! Ranges of commands: a motor with a range moves as one without, whose commands are clamped by the caller.

use farsa_body::Pose;
use farsa_body::actuators::{Held, Law, Servo, Torque, Velocity};
use farsa_body::ports::{Actuated, ActuatorId, JointId, Joints, World as _};
use farsa_body::robot::{Joint, MassProperties, Robot, Segment};
use farsa_num::{Domain, Stream};
use farsa_physics::articulated::{Model, Options, World};

const RANGES: [Option<[f64; 2]>; 5] =
    [Some([-0.25, 0.5]), Some([0.125, 0.75]), Some([-1.0, 0.0]), Some([f64::NEG_INFINITY, 0.5]), None];

/// A chain with a motor of each law.
fn chain(limited: bool) -> Robot {
    let mut robot = Robot::new("chain");
    let mut parent = None;
    let laws = [
        Law::Servo(Servo { stiffness: 20.0, damping: 1.0, limit: 5.0 }),
        Law::Torque(Torque { limit: 5.0 }),
        Law::Velocity(Velocity { gain: 2.0, limit: 5.0 }),
        Law::Held(Held { stiffness: 0.5, damping: 0.1 }),
        Law::Servo(Servo { stiffness: 5.0, damping: 0.5, limit: f64::INFINITY }),
    ];
    for (i, law) in laws.into_iter().enumerate() {
        let joint = Joint::revolute(&format!("J{i}"), [0.0, 1.0, 0.0], Pose::at([0.0, 0.0, -0.2]), [-3.0, 3.0]);
        let rod = MassProperties::capsule(0.4, 0.02, 0.1).placed(&Pose::at([0.0, 0.0, -0.1]));
        let body = robot.add_segment(Segment::new(&format!("rod{i}"), parent, joint, rod));
        parent = Some(body);
        robot.add_actuator(&format!("motor {i}"), JointId(body.0), law);
        robot.actuators[i].command_range = RANGES[i].filter(|_| limited);
    }
    robot
}

/// Positions of the joints under random commands, which are within the ranges if `clamped`.
fn positions(
    world: &mut (impl farsa_body::ports::World + Actuated<Actuator = ActuatorId> + Joints<Joint = JointId>),
    clamped: bool,
) -> Vec<u32> {
    let mut stream = Stream::new(3, Domain::General, 0, 0, 0);
    let mut bits = Vec::new();
    for _ in 0..100 {
        for (i, range) in RANGES.iter().enumerate() {
            let mut command = stream.range(-2.0, 2.0);
            if let (Some([low, high]), true) = (range, clamped) {
                command = command.clamp(*low as f32, *high as f32);
            }
            world.command(ActuatorId(i as u16), [command, 0.25]);
        }
        world.step();
        bits.extend((0..5).map(|i| world.position(JointId(i)).to_bits()));
    }
    bits
}

#[test]
fn a_range_clamps_commands_of_every_law() {
    let [limited, free] = [true, false].map(|limited| {
        let robot = chain(limited);
        let mut world = World::<f32>::new(Model::new(&robot, &Options::default()).unwrap());
        let mut exact = World::<f64>::new(Model::new(&robot, &Options::default()).unwrap());
        (positions(&mut world, !limited), positions(&mut exact, !limited))
    });
    assert_eq!(limited, free);
    let mut free = World::<f32>::new(Model::new(&chain(false), &Options::default()).unwrap());
    assert_ne!(limited.0, positions(&mut free, false), "the commands exceed the ranges");
}

#[cfg(feature = "rapier")]
#[test]
fn a_range_clamps_commands_in_rapier() {
    let [limited, free] = [true, false].map(|limited| {
        let options = farsa_physics::rapier::Options::default();
        positions(&mut farsa_physics::rapier::World::new(&chain(limited), &options).unwrap(), !limited)
    });
    assert_eq!(limited, free);
}

/// A command of 0 outside of the range counts as the nearest end, as in MuJoCo.
#[test]
fn the_command_of_the_start_is_clamped() {
    let mut robot = chain(true);
    for segment in &mut robot.segments[1..] {
        segment.joint.range = [0.0, 0.0];
    }
    robot.actuators[0].command_range = Some([0.5, 1.0]);
    let options = Options { gravity: [0.0; 3], ..Options::default() };
    let mut world = World::<f64>::new(Model::new(&robot, &options).unwrap());
    for _ in 0..3000 {
        world.step();
    }
    assert!((world.position(JointId(0)) - 0.5).abs() < 1e-3, "{}", world.position(JointId(0)));
}

#[test]
fn ranges_of_commands_have_equal_bits_in_lanes() {
    let model = Model::new(&chain(true), &Options::default()).unwrap();
    crate::lanes_have_the_bits_of_the_world(&model, 100, |world, stream, _| {
        for i in 0..5 {
            world.command(ActuatorId(i), [stream.range(-2.0, 2.0), 0.25]);
        }
    });
}
