//! Every sensor and motor of `farsa_body` that requests no plane, for a world of the main experiment's scene.

use farsa_body::motors::{Muscles, ServoGroup, TorqueMotor};
use farsa_body::ports::{
    Actuated, ActuatorId, BodyId, Contacts, Handles, JointId, Joints, Kinematics, Motor, PairId, Rays, Sensor, Snapshot,
};
use farsa_body::robot::Robot;
use farsa_body::robots::{ArmAndHand, Tabletop};
use farsa_body::sensors::infrared::InfraredRays;
use farsa_body::sensors::{
    Axes, Beam, BodyPose, BodyVelocity, ContactForce, Height, JointPosition, JointSpeed, LaserDistance, Point, Signal,
    TargetPosition, Touch,
};
use farsa_body::testing::{check_motor, check_sensor};
use farsa_body::wrappers::{Delayed, Lesioned, Noise, Noisy, Recorded, Saturated, Scaled, Stuck, StuckAt};
use farsa_num::{Domain, Stream};

fn every_sensor<W>(robot: &Robot) -> Vec<Box<dyn Sensor<W>>>
where
    W: Kinematics + Joints + Contacts + Rays + Handles<Body = BodyId, Joint = JointId> + 'static,
{
    let (joint, hand, stream) = (JointId(3), ArmAndHand::PALM, Stream::new(1, Domain::Sensor, 0, 0, 0));
    let sphere = Point::origin(Tabletop::SPHERE);
    let palm = Point { body: hand, at: [0.05, 0.0, -0.02] };
    let position = JointPosition::new(joint, 0.0, 2.0).unwrap();
    let pairs: Vec<PairId> = (0..robot.pairs.len() as u16).map(PairId).collect();
    let fan: Vec<Beam> = (0..8).map(|i| Beam::in_cone(0.05, 0.0, 3.0, i, 8)).collect();
    vec![
        Box::new(position),
        Box::new(JointSpeed::new(joint)),
        Box::new(Touch::new(pairs.clone(), 3.0).unwrap()),
        Box::new(ContactForce::new(pairs)),
        Box::new(TargetPosition::new(sphere, palm, Axes::Body, 100.0).unwrap()),
        Box::new(TargetPosition::new(sphere, palm, Axes::World, 1.0).unwrap()),
        Box::new(Height::new(palm)),
        Box::new(BodyPose::new(hand)),
        Box::new(BodyVelocity::new(hand, Axes::Body)),
        Box::new(LaserDistance::new(hand, fan.clone(), 0.0, 1.0).unwrap()),
        Box::new(InfraredRays::new(hand, fan, 1, 0.0, 1.0).unwrap()),
        Box::new(Signal::<3>::one_hot(1, 50.0)),
        Box::new(Noisy::new(BodyPose::new(hand), Noise::Normal(0.1), stream).unwrap()),
        Box::new(Delayed::new(BodyPose::new(hand), 3)),
        Box::new(Scaled::new(position, 2.0, 1.0).unwrap()),
        Box::new(Saturated::new(BodyPose::new(hand), -0.1, 0.1).unwrap()),
        Box::new(Stuck::new(BodyPose::new(hand), 1..=2, StuckAt::Last, 0).unwrap()),
        Box::new(Lesioned::new(BodyPose::new(hand), ..).unwrap()),
        Box::new(Recorded::new(BodyPose::new(hand))),
        Box::new((position, [JointSpeed::new(joint); 3], vec![Height::new(palm); 2], Some(BodyPose::new(hand)))),
    ]
}

fn every_motor<W>() -> Vec<Box<dyn Motor<W>>>
where
    W: Actuated + Handles<Actuator = ActuatorId> + 'static,
{
    let stream = Stream::new(1, Domain::Motor, 0, 0, 0);
    let muscles = [0, 3, 6].map(|pair| Muscles::new(ActuatorId(pair)));
    let groups = ArmAndHand::default().servo_groups();
    vec![
        Box::new(muscles),
        Box::new(groups.iter().map(|group| ServoGroup::new(group.clone()).unwrap()).collect::<Vec<_>>()),
        Box::new(TorqueMotor::new(ActuatorId(9), 0.2).unwrap()),
        Box::new(Delayed::new(muscles, 3)),
        Box::new(Noisy::new(muscles, Noise::Uniform(0.1), stream).unwrap()),
        Box::new(Scaled::new(muscles, -1.0, 1.0).unwrap()),
        Box::new(Saturated::new(muscles, 0.2, 0.3).unwrap()),
        Box::new(Stuck::new(muscles, .., StuckAt::Value(0.5), 1).unwrap()),
        Box::new(Lesioned::new(muscles, 3..).unwrap()),
        Box::new(Recorded::new_in(muscles, [0.0; 6]).unwrap()),
    ]
}

/// Checks every sensor in the worlds' state, and every motor.
pub(crate) fn channels_conform<W>(robot: &Robot, make: impl Fn() -> W)
where
    W: Kinematics
        + Joints
        + Contacts
        + Rays
        + Actuated
        + Snapshot
        + Handles<Body = BodyId, Joint = JointId, Actuator = ActuatorId>
        + 'static,
{
    let world = make();
    assert!((0..world.pairs() as u16).any(|pair| world.touches(PairId(pair))), "nothing touches");
    for (i, sensor) in every_sensor::<W>(robot).iter_mut().enumerate() {
        assert_eq!(check_sensor(sensor.as_mut(), &world), Ok(()), "sensor {i}");
    }
    for (i, motor) in every_motor::<W>().iter_mut().enumerate() {
        assert_eq!(check_motor(motor.as_mut(), &make), Ok(()), "motor {i}");
    }
}
