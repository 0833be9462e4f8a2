//! Sensors, motors and their compositions, in the point world and in a lane of it.

use core::f32::consts::{FRAC_1_SQRT_2, FRAC_PI_2, PI};

use crate::shared::read;
use farsa_body::motors::{Muscles, ServoGroup, ServoRange, TorqueMotor, VelocityMotor};
use farsa_body::ports::{
    Actuated, ActuatorId, Arrange, BodyId, Channels, Contacts, Handles, JointId, Joints, Kinematics, Motor,
    PairContact, PairId, Sensor, World,
};
use farsa_body::sensors::{
    Axes, BodyPose, BodyVelocity, ContactForce, Height, JointPosition, JointSpeed, Point, Signal, TargetPosition, Touch,
};
use farsa_body::testing::{PointWorld, check_motor, check_sensor};
use farsa_body::wrappers::{Delayed, Lesioned, Noise, Noisy, Recorded, Saturated, Scaled, Stuck, StuckAt};
use farsa_body::{ChannelError, Pose, Twist};
use farsa_num::{Domain, Stream};
use proptest::prelude::*;

/// One world of a batch: ports without a step.
struct Lane<'a>(&'a mut PointWorld);

impl Handles for Lane<'_> {
    type Body = BodyId;
    type Joint = JointId;
    type Actuator = ActuatorId;
}
impl Joints for Lane<'_> {
    fn position(&self, joint: JointId) -> f32 {
        self.0.position(joint)
    }
    fn speed(&self, joint: JointId) -> f32 {
        self.0.speed(joint)
    }
}
impl Kinematics for Lane<'_> {
    fn pose(&self, body: BodyId) -> Pose {
        self.0.pose(body)
    }
    fn velocity(&self, body: BodyId) -> Twist {
        self.0.velocity(body)
    }
}
impl Actuated for Lane<'_> {
    fn command(&mut self, actuator: ActuatorId, value: [f32; 2]) {
        self.0.command(actuator, value);
    }
}
impl Contacts for Lane<'_> {
    fn pairs(&self) -> usize {
        self.0.pairs()
    }
    fn pair_bodies(&self, pair: PairId) -> [Option<BodyId>; 2] {
        self.0.pair_bodies(pair)
    }
    fn pair_contact(&self, pair: PairId) -> PairContact {
        self.0.pair_contact(pair)
    }
}

/// Points at heights 0.1, 0.2, 0.3 m. The last sinks into the floor.
fn world() -> PointWorld {
    let mut world = PointWorld::new(4);
    for (i, height) in [0.1, 0.2, 0.3, -0.01].into_iter().enumerate() {
        world.place_joint(JointId(i as u16), height, 0.5 * i as f32);
    }
    world.place_joint(JointId(3), -0.01, 0.0);
    world.finish_placement();
    world
}

fn every_sensor() -> Vec<Box<dyn AnySensor>> {
    let (j, b, stream) = (JointId(1), BodyId(2), Stream::new(1, Domain::Sensor, 0, 0, 0));
    let origin = Point::origin(BodyId(0));
    let position = JointPosition::new(j, 0.0, -FRAC_PI_2).unwrap();
    vec![
        Box::new(position),
        Box::new(JointSpeed::new(j)),
        Box::new(Touch::new([PairId(0), PairId(3)], 3.0).unwrap()),
        Box::new(ContactForce::new(vec![PairId(0), PairId(3)])),
        Box::new(TargetPosition::new(Point { body: b, at: [0.1, 0.2, 0.3] }, origin, Axes::Body, 100.0).unwrap()),
        Box::new(TargetPosition::new(Point::origin(b), origin, Axes::World, 1.0).unwrap()),
        Box::new(Height::new(origin)),
        Box::new(BodyPose::new(b)),
        Box::new(BodyVelocity::new(b, Axes::Body)),
        Box::new(Signal::<3>::one_hot(1, 50.0)),
        Box::new(Noisy::new(BodyPose::new(b), Noise::Normal(0.1), stream).unwrap()),
        Box::new(Noisy::new_in(position, Noise::Uniform(0.1), stream, [0.0; 1]).unwrap()),
        Box::new(Delayed::new(BodyPose::new(b), 3)),
        Box::new(Delayed::new_in(position, 2, [0.0; 2]).unwrap()),
        Box::new(Scaled::new(position, 2.0, 1.0).unwrap()),
        Box::new(Saturated::new(BodyPose::new(b), -0.1, 0.1).unwrap()),
        Box::new(Stuck::new(BodyPose::new(b), 1..=2, StuckAt::Last, 0).unwrap()),
        Box::new(Lesioned::new(BodyPose::new(b), ..).unwrap()),
        Box::new(Recorded::new(BodyPose::new(b))),
        Box::new((position, [JointSpeed::new(j); 3], vec![Height::new(origin); 2], Some(BodyPose::new(b)))),
        Box::new((None::<Signal<3>>, ())),
    ]
}

/// A sensor of the point world and of all its lanes.
trait AnySensor: Sensor<PointWorld> + for<'a> Sensor<Lane<'a>> {}
impl<S: Sensor<PointWorld> + for<'a> Sensor<Lane<'a>>> AnySensor for S {}

#[test]
fn every_sensor_keeps_its_promises_in_a_world_and_in_a_lane() {
    let mut world = world();
    for (i, sensor) in every_sensor().iter_mut().enumerate() {
        assert_eq!(check_sensor::<PointWorld, dyn AnySensor>(sensor.as_mut(), &world), Ok(()), "sensor {i}");
        sensor.reset();
        let mut alone = vec![0.0; sensor.channels()];
        Sensor::<PointWorld>::read(sensor.as_mut(), &world, &mut alone);
        let lane = Lane(&mut world);
        assert_eq!(check_sensor::<Lane, dyn AnySensor>(sensor.as_mut(), &lane), Ok(()), "sensor {i}");
        sensor.reset();
        let mut in_lane = vec![0.0; sensor.channels()];
        Sensor::<Lane>::read(sensor.as_mut(), &lane, &mut in_lane);
        assert_eq!(alone, in_lane, "sensor {i}");
    }
}

#[test]
fn the_proprioceptor_reads_fractions_of_any_range() {
    let mut world = PointWorld::new(2);
    world.place_joint(JointId(0), -PI / 8.0, 0.25);
    let read = |from, to| read(&mut JointPosition::new(JointId(0), from, to).unwrap(), &world)[0];
    assert_eq!(read(0.0, -FRAC_PI_2), 0.25);
    assert_eq!(read(-PI / 8.0, 1.0), 0.0);
    assert_eq!(read(1.0, -PI / 8.0), 1.0);
    // Beyond the range it is not clamped.
    assert!(read(-0.1, 0.0) < 0.0);
    assert_eq!(JointPosition::new(JointId(0), 1.0, 1.0), Err(ChannelError::Range { from: 1.0, to: 1.0 }));
    assert!(JointPosition::new(JointId(0), f32::NAN, 1.0).is_err());
    assert!(JointPosition::new(JointId(0), f32::MIN, f32::MAX).is_err());
    assert_eq!(self::read(&mut JointSpeed::new(JointId(0)), &world), [0.25]);
}

#[test]
fn touch_counts_pairs_and_saturates() {
    let mut world = PointWorld::new(5);
    let mut touch = Touch::new((0..5).map(PairId).collect::<Vec<_>>(), 3.0).unwrap();
    for i in 0..5u16 {
        assert_eq!(read(&mut touch, &world), [(f32::from(i) / 3.0).min(1.0)]);
        world.place_joint(JointId(i), -0.01, 0.0);
    }
    // A pair that parts faster than the floor pushes does not touch, however deep it is.
    world.place_joint(JointId(0), -0.01, 2.0);
    assert_eq!(read(&mut Touch::new([PairId(0)], 1.0).unwrap(), &world), [0.0]);
    assert_eq!(read(&mut Touch::new([PairId(1), PairId(77)], 4.0).unwrap(), &world), [0.25]);
    let force = world.pair_contact(PairId(1)).normal_force;
    assert_eq!(read(&mut ContactForce::new([PairId(0), PairId(1), PairId(2)]), &world), [force + force]);
    for bad in [0.0, -1.0, f32::NAN, f32::INFINITY] {
        assert!(Touch::new([PairId(0)], bad).is_err());
    }
}

#[test]
fn places_are_read_in_either_axes() {
    let mut world = PointWorld::new(2);
    // Body 0 turned by 90 degrees about z.
    world.place_joint(JointId(0), FRAC_PI_2 / PointWorld::TURN, 0.3);
    world.place_joint(JointId(1), 0.5, 0.0);
    let (own, target) = (Point::origin(BodyId(0)), Point::origin(BodyId(1)));
    let rise = 0.5 - FRAC_PI_2 / PointWorld::TURN;
    let near = |a: &[f32], b: &[f32]| a.len() == b.len() && a.iter().zip(b).all(|(a, b)| (a - b).abs() < 1e-4);
    let way = read(&mut TargetPosition::new(target, own, Axes::World, 100.0).unwrap(), &world);
    assert!(near(&way, &[10.0, 0.0, 100.0 * rise]), "{way:?}");
    let way = read(&mut TargetPosition::new(target, own, Axes::Body, 1.0).unwrap(), &world);
    assert!(near(&way, &[0.0, -0.1, rise]), "{way:?}");
    // The way from a point of the sensor's body is shorter by that point in any pose.
    let own = Point { body: BodyId(0), at: [0.0, -0.1, 0.2] };
    let way = read(&mut TargetPosition::new(target, own, Axes::Body, 1.0).unwrap(), &world);
    assert!(near(&way, &[0.0, 0.0, rise - 0.2]), "{way:?}");
    assert!(near(&read(&mut Height::new(own), &world), &[0.5 - rise + 0.2]));
    // The way leads from the one point to the other, wherever they are.
    let (from, to) = (Point { body: BodyId(0), at: [0.3, -0.1, 0.2] }, Point { body: BodyId(1), at: [-0.2, 0.5, 0.1] });
    let (here, there) = (world.pose(BodyId(0)), world.pose(BodyId(1)).transform(to.at));
    let way = read(&mut TargetPosition::new(to, from, Axes::World, 1.0).unwrap(), &world);
    let at = here.transform(from.at);
    assert!(near(&[0, 1, 2].map(|i| at[i] + way[i]), &there), "{way:?}");
    let way = read(&mut TargetPosition::new(to, from, Axes::Body, 1.0).unwrap(), &world);
    assert!(near(&here.transform([0, 1, 2].map(|i| from.at[i] + way[i])), &there), "{way:?}");
    let h = FRAC_1_SQRT_2;
    assert!(near(&read(&mut BodyPose::new(BodyId(0)), &world), &[0.0, 0.0, 0.5 - rise, 0.0, 0.0, h, h]));
    let turn = 0.3 * PointWorld::TURN;
    assert!(near(&read(&mut BodyVelocity::new(BodyId(0), Axes::Body), &world), &[0.0, 0.0, 0.3, 0.0, 0.0, turn]));
    // Turned by 270 degrees the raw quaternion has w < 0.
    world.place_joint(JointId(0), 3.0 * FRAC_PI_2 / PointWorld::TURN, 0.0);
    assert!(near(&read(&mut BodyPose::new(BodyId(0)), &world)[3..], &[0.0, 0.0, -h, h]));
    assert!(TargetPosition::new(target, own, Axes::Body, f32::NAN).is_err());
    assert!(TargetPosition::new(Point { at: [f32::INFINITY; 3], ..target }, own, Axes::Body, 1.0).is_err());
}

#[test]
fn signals_are_set_from_outside_even_within_a_composition() {
    let world = PointWorld::new(1);
    let mut sensors = (Signal::new([1.0]), Some(Signal::<3>::one_hot(0, 50.0)));
    assert_eq!(read(&mut sensors, &world), [1.0, 50.0, 0.0, 0.0]);
    sensors.1.iter_mut().for_each(|label| label.set_one_hot(2, 50.0));
    sensors.reset();
    assert_eq!(read(&mut sensors, &world), [1.0, 0.0, 0.0, 50.0]);
    sensors.1.iter_mut().for_each(|label| label.set_one_hot(3, 50.0));
    assert_eq!(read(&mut sensors, &world), [1.0, 0.0, 0.0, 0.0]);
    sensors.1 = None;
    assert_eq!(read(&mut sensors, &world), [1.0]);
}

fn every_motor() -> Vec<Box<dyn AnyMotor>> {
    let (a, stream) = (ActuatorId(1), Stream::new(1, Domain::Motor, 0, 0, 0));
    let group = [(0, 0.0, 15.0), (1, -2.0, 2.0), (2, 0.0, -10.0)];
    let group = group.map(|(servo, from, to)| ServoRange { servo: ActuatorId(servo), from, to });
    let muscles = [Muscles::new(ActuatorId(0)), Muscles::new(ActuatorId(2))];
    vec![
        Box::new(muscles),
        Box::new(ServoGroup::new(group).unwrap()),
        Box::new(TorqueMotor::new(a, 2.0).unwrap()),
        Box::new((muscles, ServoGroup::new(group.to_vec()).unwrap(), vec![TorqueMotor::new(a, 1.0).unwrap(); 2])),
        Box::new(Delayed::new(muscles, 3)),
        Box::new(Delayed::new(muscles, 0)),
        Box::new(Noisy::new(muscles, Noise::Uniform(0.1), stream).unwrap()),
        Box::new(Scaled::new(muscles, -1.0, 1.0).unwrap()),
        Box::new(Saturated::new(muscles, 0.2, 0.3).unwrap()),
        Box::new(Stuck::new(muscles, .., StuckAt::Value(0.5), 1).unwrap()),
        Box::new(Lesioned::new(muscles, 3..).unwrap()),
        Box::new(Recorded::new_in(muscles, [0.0; 4]).unwrap()),
    ]
}

trait AnyMotor: Motor<PointWorld> + for<'a> Motor<Lane<'a>> {}
impl<M: Motor<PointWorld> + for<'a> Motor<Lane<'a>>> AnyMotor for M {}

#[test]
fn every_motor_keeps_its_promises() {
    for (i, motor) in every_motor().iter_mut().enumerate() {
        assert_eq!(check_motor::<PointWorld, dyn AnyMotor>(motor.as_mut(), world), Ok(()), "motor {i}");
        let (mut alone, mut batch) = (world(), world());
        let y: Vec<f32> = (0..motor.channels()).map(|c| 0.1 + 0.2 * c as f32).collect();
        motor.reset();
        Motor::<PointWorld>::drive(motor.as_mut(), &y, &mut alone);
        motor.reset();
        Motor::<Lane>::drive(motor.as_mut(), &y, &mut Lane(&mut batch));
        assert_eq!(alone, batch, "motor {i}");
    }
}

#[test]
fn servos_of_a_group_go_their_own_ways() {
    let degrees = |x: f32| x.to_radians();
    let spread = [(0.0, 15.0), (-2.0, 2.0), (0.0, -10.0), (0.0, -15.0)];
    let servos = [0, 1, 2, 3].map(|i| {
        let (from, to) = spread[i];
        ServoRange { servo: ActuatorId(i as u16), from: degrees(from), to: degrees(to) }
    });
    let mut world = PointWorld::new(4);
    let mut group = ServoGroup::new(&servos).unwrap();
    for (y, expected) in [
        (0.0, [0.0, -2.0, 0.0, 0.0]),
        (0.5, [7.5, 0.0, -5.0, -7.5]),
        (1.0, [15.0, 2.0, -10.0, -15.0]),
        (3.0, [15.0, 2.0, -10.0, -15.0]),
        (f32::NAN, [0.0, -2.0, 0.0, 0.0]),
    ] {
        group.drive(&[y], &mut world);
        for (i, expected) in expected.into_iter().enumerate() {
            let [position, unused] = world.commanded(ActuatorId(i as u16));
            assert!((position - degrees(expected)).abs() < 1e-6 && unused == 0.0, "{y}: servo {i} to {position}");
        }
    }
    let bad = [ServoRange { servo: ActuatorId(0), from: 0.0, to: f32::INFINITY }];
    assert!(ServoGroup::new(&bad).is_err());
}

#[test]
fn muscles_and_torques_are_commanded_within_their_limits() {
    let mut world = PointWorld::new(2);
    let mut motors = (Muscles::new(ActuatorId(0)), TorqueMotor::new(ActuatorId(1), 4.0).unwrap());
    assert_eq!(Channels::channels(&motors), 3);
    motors.drive(&[0.25, 2.0, 0.75], &mut world);
    assert_eq!((world.commanded(ActuatorId(0)), world.commanded(ActuatorId(1))), ([0.25, 1.0], [2.0, 0.0]));
    motors.drive(&[-1.0, f32::NAN, f32::NAN], &mut world);
    assert_eq!((world.commanded(ActuatorId(0)), world.commanded(ActuatorId(1))), ([0.0, 0.0], [-4.0, 0.0]));
    // A short slice leaves the later motors as they are.
    motors.drive(&[1.0], &mut world);
    assert_eq!((world.commanded(ActuatorId(0)), world.commanded(ActuatorId(1))), ([1.0, 0.0], [-4.0, 0.0]));
    assert!(TorqueMotor::new(ActuatorId(0), f32::NAN).is_err());
}

#[test]
fn speeds_are_commanded_as_torques_of_a_gain() {
    let mut world = PointWorld::new(1);
    let mut motor = VelocityMotor::new(ActuatorId(0), 2.0, 5.0).unwrap();
    assert_eq!(Channels::channels(&motor), 1);
    for (y, torque) in [(0.5, 0.0), (0.75, 5.0), (0.25, -5.0), (2.0, 10.0), (f32::NAN, -10.0)] {
        motor.drive(&[y], &mut world);
        assert_eq!(world.commanded(ActuatorId(0)), [torque, 0.0], "{y}");
    }
    for [largest, gain] in [[f32::NAN, 1.0], [1.0, f32::INFINITY]] {
        assert!(VelocityMotor::new(ActuatorId(0), largest, gain).is_err());
    }
}

#[test]
fn the_four_lines_of_a_tick() {
    let mut world = PointWorld::new(2);
    let mut sensors = [0, 1].map(|i| JointPosition::new(JointId(i), 0.0, 1.0).unwrap());
    let mut motors = [0, 1].map(|i| TorqueMotor::new(ActuatorId(i), 20.0).unwrap());
    let (mut x, mut y) = ([0.0; 2], [0.0; 2]);
    for _ in 0..100 {
        sensors.read(&world, &mut x);
        y.iter_mut().zip(x).for_each(|(y, x)| *y = 0.75 + 0.5 * (0.5 - x));
        motors.drive(&y, &mut world);
        world.step();
    }
    assert!(x.iter().all(|x| (0.3..0.7).contains(x)), "{x:?}");
}

proptest! {
    /// A composition reads what its parts read one after the other, whatever its form and however short the slice.
    #[test]
    fn compositions_are_their_parts_in_order(widths in prop::collection::vec(0usize..4, 0..6), length in 0usize..20) {
        let world = PointWorld::new(1);
        let mut part = 0.0;
        let mut parts: Vec<Vec<Signal<1>>> = Vec::new();
        for width in widths {
            parts.push((0..width).map(|_| { part += 1.0; Signal::new([part]) }).collect());
        }
        let all: Vec<f32> = parts.iter().flatten().map(|s| s.values()[0]).collect();
        let mut out = vec![-1.0; length];
        Sensor::<PointWorld>::read(&mut parts, &world, &mut out);
        let n = length.min(all.len());
        prop_assert_eq!(&out[..n], &all[..n]);
        prop_assert!(out[n..].iter().all(|&x| x == -1.0));
        let boxed: Vec<Box<dyn Sensor<PointWorld>>> =
            parts.into_iter().map(|p| Box::new(p) as Box<dyn Sensor<PointWorld>>).collect();
        let mut halves = { let mut a = boxed; let b = a.split_off(a.len() / 2); (a, b) };
        prop_assert_eq!(read(&mut (&mut halves.0, &mut halves.1), &world), all);
    }
}
