//! The conformance kit passes what is right and names what is wrong.

use std::cell::Cell;

use farsa_body::motors::{Muscles, TorqueMotor};
use farsa_body::ports::{
    Actuated, ActuatorId, Arrange, BodyId, Channels, Contacts, ExternalForces, Handles, Hit, JointId, Joints,
    Kinematics, Motor, PairContact, PairId, Rays, Sensor, Snapshot, World,
};
use farsa_body::robots::{ArmAndHand, Tabletop};
use farsa_body::testing::{
    ConformanceError, PointWorld, Probe, Promise, check_arrange, check_external_forces, check_motor, check_rays,
    check_sensor, check_world,
};
use farsa_body::{Pose, Twist};

const POINTS: usize = 3;

fn probe() -> Probe {
    Probe::numbered(POINTS as u16, [[-20.0, 0.0], [20.0, 1.0]])
}

/// The fault of a [`Broken`] world.
#[derive(Clone, Copy, Debug, PartialEq)]
enum Fault {
    NoTime,
    NanSpeed,
    LongRotation,
    OriginElsewhere,
    NoVelocity,
    BodyAxes,
    WrongTurn,
    DoubleSpeed,
    StrangerInPair,
    EmptyPair,
    PullingFloor,
    ForceWithoutPoint,
    PairBeyond,
    UnlikeTwin,
    ShortSave,
    ForgottenReading,
    ForgottenForce,
    ForgottenPast,
    FadingCommand,
    DeafActuator,
    CommandSurvivesClear,
    SpeedNotPlaced,
    BodyPlacedOnJoint,
    StaleAfterPlacing,
    InwardNormal,
    EndlessRay,
    DeafBody,
    LastingForce,
    LastForceAlone,
    ForceOnNobody,
}

/// A point world with a fault, and something that it keeps to itself.
struct Broken {
    world: PointWorld,
    fault: Option<Fault>,
    hidden: f32,
}

impl Broken {
    fn new(fault: Option<Fault>) -> Self {
        Self { world: PointWorld::new(POINTS), fault, hidden: 0.0 }
    }
    fn has(&self, fault: Fault) -> bool {
        self.fault == Some(fault)
    }
}

impl Handles for Broken {
    type Body = BodyId;
    type Joint = JointId;
    type Actuator = ActuatorId;
}

impl World for Broken {
    fn step(&mut self) {
        match self.fault {
            Some(Fault::FadingCommand) => {
                for i in 0..POINTS as u16 {
                    let [a, b] = self.world.commanded(ActuatorId(i));
                    self.world.command(ActuatorId(i), [0.9 * a, b]);
                }
            }
            Some(Fault::ForgottenReading) => self.hidden += 1e-4,
            Some(Fault::LastingForce) => {
                let force = [0.0, 0.0, self.hidden];
                (0..POINTS as u16).for_each(|i| self.world.apply_force(BodyId(i), [0.0; 3], force));
            }
            Some(Fault::ForgottenForce) => self.hidden += 0.1,
            Some(Fault::StaleAfterPlacing | Fault::LastForceAlone) => self.hidden = 0.0,
            _ => {}
        }
        if matches!(self.fault, Some(Fault::ForgottenForce | Fault::ForgottenPast | Fault::UnlikeTwin)) {
            let [a, b] = self.world.commanded(ActuatorId(0));
            self.world.command(ActuatorId(0), [a + self.hidden, b]);
            self.world.step();
            self.world.command(ActuatorId(0), [a, b]);
        } else {
            self.world.step();
        }
    }
    fn time_step(&self) -> f32 {
        if self.has(Fault::NoTime) { 0.0 } else { self.world.time_step() }
    }
}

impl Joints for Broken {
    fn position(&self, joint: JointId) -> f32 {
        self.world.position(joint) + if self.has(Fault::ForgottenReading) { self.hidden } else { 0.0 }
    }
    fn speed(&self, joint: JointId) -> f32 {
        let speed = self.world.speed(joint);
        match self.fault {
            Some(Fault::NanSpeed) if speed > 0.5 => f32::NAN,
            Some(Fault::DoubleSpeed) => 2.0 * speed,
            _ => speed,
        }
    }
}

impl Kinematics for Broken {
    fn pose(&self, body: BodyId) -> Pose {
        let mut pose = self.world.pose(body);
        match self.fault {
            Some(Fault::LongRotation) => pose.rotation = pose.rotation.map(|x| 1.1 * x),
            Some(Fault::StaleAfterPlacing) => pose.position[2] += self.hidden,
            _ => {}
        }
        pose
    }
    fn origin(&self, body: BodyId) -> [f32; 3] {
        let [x, y, z] = self.pose(body).position;
        [x, y, if self.has(Fault::OriginElsewhere) { z + 1e-6 } else { z }]
    }
    fn velocity(&self, body: BodyId) -> Twist {
        let twist = self.world.velocity(body);
        match self.fault {
            Some(Fault::NoVelocity) => Twist::default(),
            Some(Fault::BodyAxes) => Twist { linear: [twist.linear[2], 0.0, 0.0], ..twist },
            Some(Fault::WrongTurn) => Twist { angular: twist.angular.map(|x| -x), ..twist },
            _ => twist,
        }
    }
}

impl Actuated for Broken {
    fn command(&mut self, actuator: ActuatorId, value: [f32; 2]) {
        if self.has(Fault::ForgottenPast) && self.hidden == 0.0 {
            self.hidden = value[0];
        }
        if !(self.has(Fault::DeafActuator) && actuator.index() == 1) {
            self.world.command(actuator, value);
        }
    }
}

impl ExternalForces for Broken {
    fn apply_force(&mut self, body: BodyId, point: [f32; 3], force: [f32; 3]) {
        match self.fault {
            Some(Fault::DeafBody) if body.0 == 2 => {}
            Some(Fault::LastForceAlone) => {
                self.world.apply_force(body, point, [0.0, 0.0, force[2] - self.hidden]);
                self.hidden = force[2];
            }
            Some(Fault::LastingForce) => {
                self.hidden += force[2];
                self.world.apply_force(body, point, force);
            }
            Some(Fault::ForceOnNobody) if body.index() >= POINTS => self.world.apply_force(BodyId(0), point, force),
            _ => self.world.apply_force(body, point, force),
        }
    }
}

impl Contacts for Broken {
    fn pairs(&self) -> usize {
        self.world.pairs()
    }
    fn pair_bodies(&self, pair: PairId) -> [Option<BodyId>; 2] {
        match self.fault {
            Some(Fault::StrangerInPair) if pair.0 == 1 => [Some(BodyId(99)), None],
            Some(Fault::EmptyPair) if pair.0 == 1 => [None, None],
            _ => self.world.pair_bodies(pair),
        }
    }
    fn pair_contact(&self, pair: PairId) -> PairContact {
        let contact = self.world.pair_contact(pair);
        match self.fault {
            Some(Fault::PullingFloor) => PairContact { normal_force: -contact.normal_force, ..contact },
            Some(Fault::ForceWithoutPoint) => PairContact { points: 0, ..contact },
            Some(Fault::PairBeyond) if pair.index() >= POINTS => PairContact { depth: -1.0, ..contact },
            _ => contact,
        }
    }
}

impl Snapshot for Broken {
    fn snapshot_len(&self) -> usize {
        self.world.snapshot_len()
    }
    fn save(&self, out: &mut [f32]) {
        let short = out.len() - if self.has(Fault::ShortSave) { 4 } else { 0 };
        self.world.save(&mut out[..short]);
    }
    fn restore(&mut self, from: &[f32]) {
        if self.has(Fault::StaleAfterPlacing) || self.has(Fault::LastingForce) {
            self.hidden = 0.0;
        }
        self.world.restore(from);
    }
}

impl Arrange for Broken {
    fn clear(&mut self) {
        let command = self.world.commanded(ActuatorId(0));
        self.world.clear();
        if self.has(Fault::CommandSurvivesClear) {
            self.world.command(ActuatorId(0), command);
        }
    }
    fn place_joint(&mut self, joint: JointId, position: f32, speed: f32) {
        let speed = if self.has(Fault::SpeedNotPlaced) { 0.0 } else { speed };
        if self.has(Fault::StaleAfterPlacing) {
            self.hidden = 1.0;
        }
        self.world.place_joint(joint, position, speed);
    }
    fn place_body(&mut self, body: BodyId, pose: Pose, _: Twist) {
        if self.has(Fault::BodyPlacedOnJoint) {
            self.world.place_joint(JointId(body.0), pose.position[2], 0.0);
        }
    }
    fn finish_placement(&mut self) {}
}

impl Rays for Broken {
    fn cast(&self, origin: [f32; 3], direction: [f32; 3], range: f32) -> Option<Hit<BodyId>> {
        let range = if self.has(Fault::EndlessRay) { f32::INFINITY } else { range };
        let hit = self.world.cast(origin, direction, range)?;
        Some(if self.has(Fault::InwardNormal) { Hit { normal: hit.normal.map(|x| -x), ..hit } } else { hit })
    }
}

fn promise(checked: Result<(), ConformanceError>) -> Option<Promise> {
    checked.err().map(|error| error.promise)
}

#[test]
fn the_point_world_keeps_every_promise() {
    assert_eq!(check_world(|| PointWorld::new(POINTS), &probe()), Ok(()));
    assert_eq!(check_arrange(|| PointWorld::new(POINTS), &probe()), Ok(()));
    assert_eq!(check_external_forces(|| PointWorld::new(POINTS), &probe(), &probe().bodies, BodyId(99)), Ok(()));
    let mut world = PointWorld::new(POINTS);
    world.place_joint(JointId(1), 0.05, 0.0);
    assert_eq!(check_rays(&world, &probe().bodies, &[[0.05, 0.0, 0.1], [0.1, 0.0, 0.1]], 1.0), Ok(()));
    assert_eq!(check_world(|| Broken::new(None), &probe()), Ok(()));
    assert_eq!(check_arrange(|| Broken::new(None), &probe()), Ok(()));
}

#[test]
fn a_probe_of_a_robot_finds_its_parts() {
    let arm = ArmAndHand::default();
    let probe = Probe::for_robot(&Tabletop::default().scene(&arm).unwrap());
    assert_eq!((probe.bodies.len(), probe.joints.len(), probe.actuators.len()), (28, 27, 27));
    assert_eq!(probe.floating, [Tabletop::SPHERE]);
    let (elbow, [low, high]) = probe.joints[3];
    assert_eq!((elbow, high), (JointId(3), 0.0));
    assert!((low + 170.0f32.to_radians()).abs() < 1e-6);
    assert_eq!(probe.actuators[3], (ActuatorId(3), [[0.0; 2], [1.0; 2]]));
    let (servo, [[from, a], [to, b]]) = probe.actuators[8];
    assert_eq!((servo, a, b, to), (ActuatorId(8), 0.0, 0.0, 0.0));
    assert!((from + 90.0f32.to_radians()).abs() < 1e-6);
}

#[test]
fn every_broken_promise_of_a_world_is_named() {
    let faults = [
        (Fault::NoTime, Promise::TimeStep),
        (Fault::NanSpeed, Promise::Finite),
        (Fault::LongRotation, Promise::UnitRotation),
        (Fault::OriginElsewhere, Promise::Origin),
        (Fault::NoVelocity, Promise::Velocity),
        (Fault::BodyAxes, Promise::Velocity),
        (Fault::WrongTurn, Promise::Velocity),
        (Fault::DoubleSpeed, Promise::JointSpeed),
        (Fault::StrangerInPair, Promise::PairBodies),
        (Fault::EmptyPair, Promise::PairBodies),
        (Fault::PullingFloor, Promise::Contact),
        (Fault::ForceWithoutPoint, Promise::Contact),
        (Fault::PairBeyond, Promise::NoSuchPair),
        (Fault::ShortSave, Promise::SnapshotFilled),
        (Fault::ForgottenReading, Promise::SnapshotRestores),
        (Fault::ForgottenForce, Promise::SnapshotReplays),
        (Fault::ForgottenPast, Promise::SnapshotTravels),
        (Fault::FadingCommand, Promise::CommandHolds),
        (Fault::DeafActuator, Promise::CommandActs),
    ];
    for (fault, expected) in faults {
        let checked = check_world(|| Broken::new(Some(fault)), &probe());
        assert_eq!(promise(checked.clone()), Some(expected), "{fault:?}: {checked:?}");
    }
}

#[test]
fn worlds_that_differ_are_noticed() {
    let made = Cell::new(0.0);
    let make = || {
        made.set(made.get() + 1e-3);
        Broken { hidden: made.get(), ..Broken::new(Some(Fault::UnlikeTwin)) }
    };
    assert_eq!(promise(check_world(make, &probe())), Some(Promise::Deterministic));
}

#[test]
fn every_broken_promise_of_setting_up_is_named() {
    let faults = [
        (Fault::CommandSurvivesClear, Promise::ClearForgets),
        (Fault::SpeedNotPlaced, Promise::JointPlaced),
        (Fault::BodyPlacedOnJoint, Promise::BodyPlaced),
        (Fault::StaleAfterPlacing, Promise::Arranged),
    ];
    for (fault, expected) in faults {
        let checked = check_arrange(|| Broken::new(Some(fault)), &probe());
        assert_eq!(promise(checked.clone()), Some(expected), "{fault:?}: {checked:?}");
    }
    // A body that is declared as floating and cannot be placed.
    let floating = Probe { floating: vec![BodyId(0)], ..probe() };
    assert_eq!(promise(check_arrange(|| PointWorld::new(POINTS), &floating)), Some(Promise::BodyPlaced));
}

#[test]
fn every_broken_promise_of_forces_is_named() {
    let checked = |fault| check_external_forces(|| Broken::new(fault), &probe(), &probe().bodies, BodyId(99));
    assert_eq!(checked(None), Ok(()));
    for (fault, said) in [
        (Fault::DeafBody, "body 2: pushed, it moves from"),
        (Fault::LastForceAlone, "body 0: two halves of a force are not the whole"),
        (Fault::LastingForce, "body 0: a force lasts longer than a step"),
        (Fault::ForceOnNobody, "a body that does not exist changes what happens"),
    ] {
        let error = checked(Some(fault)).unwrap_err();
        assert!(error.promise == Promise::ForceActs && error.detail.contains(said), "{fault:?}: {error:?}");
    }
}

#[test]
fn every_broken_promise_of_rays_is_named() {
    let origins = [[0.05, 0.0, 0.5]];
    for fault in [Fault::InwardNormal, Fault::EndlessRay] {
        let checked = check_rays(&Broken::new(Some(fault)), &probe().bodies, &origins, 0.6);
        assert_eq!(promise(checked), Some(Promise::Ray), "{fault:?}");
    }
    let world = PointWorld::new(POINTS);
    assert_eq!(promise(check_rays(&world, &[], &[[0.1, 0.0, 0.1]], 1.0)), Some(Promise::Ray));
    assert_eq!(promise(check_rays(&world, &probe().bodies, &origins, 0.1)), Some(Promise::Ray));
}

/// A sensor or motor made of a number of channels and a function.
struct Made<F>(usize, F);

impl<F> Channels for Made<F> {
    fn channels(&self) -> usize {
        self.0
    }
}

impl<F: FnMut(&mut [f32])> Sensor<PointWorld> for Made<F> {
    fn read(&mut self, _: &PointWorld, out: &mut [f32]) {
        (self.1)(out);
    }
}

/// A number that separates the types of the two closures.
struct Driven<F>(usize, F);

impl<F> Channels for Driven<F> {
    fn channels(&self) -> usize {
        self.0
    }
}

impl<F: FnMut(&[f32], &mut PointWorld)> Motor<PointWorld> for Driven<F> {
    fn drive(&mut self, y: &[f32], world: &mut PointWorld) {
        (self.1)(y, world);
    }
}

#[test]
fn every_broken_promise_of_a_sensor_is_named() {
    let world = PointWorld::new(1);
    let check = |sensor: &mut dyn Sensor<PointWorld>| promise(check_sensor(sensor, &world));
    assert_eq!(check(&mut Made(2, |out: &mut [f32]| out.iter_mut().take(2).for_each(|x| *x = 1.0))), None);
    assert_eq!(check(&mut Made(2, |out: &mut [f32]| out.fill(1.0))), Some(Promise::Bounds));
    let half = |out: &mut [f32]| out.iter_mut().take(1).for_each(|x| *x = 1.0);
    assert_eq!(check(&mut Made(2, half)), Some(Promise::SensorFills));
    let infinite = |out: &mut [f32]| out.iter_mut().take(2).for_each(|x| *x = f32::INFINITY);
    assert_eq!(check(&mut Made(2, infinite)), Some(Promise::SensorFinite));
    let mut count = 0.0;
    let counting = |out: &mut [f32]| {
        count += 1.0;
        out.iter_mut().take(2).for_each(|x| *x = count);
    };
    assert_eq!(check(&mut Made(2, counting)), Some(Promise::Repeats));
    let late = |out: &mut [f32]| {
        let n = out.len().min(2);
        out[..n].iter_mut().rev().zip([1.0, 2.0]).for_each(|(o, x)| *o = x);
    };
    assert_eq!(check(&mut Made(2, late)), Some(Promise::ShortSlice));
}

#[test]
fn every_broken_promise_of_a_motor_is_named() {
    let make = || PointWorld::new(2);
    let check = |motor: &mut dyn Motor<PointWorld>| promise(check_motor(motor, make));
    let actuator = ActuatorId(0);
    assert_eq!(check(&mut (Muscles::new(actuator), TorqueMotor::new(ActuatorId(1), 5.0).unwrap())), None);
    let raw = |y: &[f32], w: &mut PointWorld| y.first().into_iter().for_each(|&y| w.command(actuator, [y, 0.0]));
    assert_eq!(check(&mut Driven(1, raw)), Some(Promise::MotorFinite));
    let eager = |_: &[f32], w: &mut PointWorld| w.command(actuator, [1.0, 0.0]);
    assert_eq!(check(&mut Driven(1, eager)), Some(Promise::ShortSlice));
    let greedy = |y: &[f32], w: &mut PointWorld| {
        if !y.is_empty() {
            w.command(actuator, [y.len() as f32, 0.0]);
        }
    };
    assert_eq!(check(&mut Driven(1, greedy)), Some(Promise::Bounds));
    let mut count = 0.0;
    let counting = |y: &[f32], w: &mut PointWorld| {
        if !y.is_empty() {
            count += 1.0;
            w.command(actuator, [count, 0.0]);
        }
    };
    assert_eq!(check(&mut Driven(1, counting)), Some(Promise::Repeats));
}
