//! Shared parts of several tests: the scene of the main experiment, its starts, random commands, the words of a state.
#![allow(dead_code, reason = "every test uses a part of it")]

use farsa_body::actuators::Law;
use farsa_body::motors::ServoRange;
use farsa_body::ports::{Actuated, ActuatorId, Arrange, Contacts, Handles, JointId, PairId};
use farsa_body::robot::{Joint, Robot, Shape, Surface};
use farsa_body::robots::{ArmAndHand, Tabletop};
use farsa_body::{Pose, Twist};
use farsa_num::{Domain, Stream};
use farsa_physics::articulated::{Model, Options, Precision, World};

/// J1 to J4 at the four starts [deg].
pub(crate) const POSES: [[f64; 4]; 4] = [
    [-73.0, -30.0, -40.0, -56.0],
    [-73.0, -30.0, -40.0, -113.0],
    [-6.0, 30.0, -10.0, -56.0],
    [-73.0, -30.0, 45.0, -113.0],
];
/// The sphere at the four starts [m].
pub(crate) const SPHERES: [[f64; 2]; 4] = [[0.10, -0.18], [0.18, -0.26], [0.26, -0.18], [0.18, -0.10]];

/// Number of outputs of the experiment: 14 muscles, 9 groups of servos.
pub(crate) const OUTPUTS: usize = 23;

pub(crate) fn scene() -> Robot {
    Tabletop::default().scene(&ArmAndHand::default()).unwrap()
}

pub(crate) fn model<R: Precision>(robot: &Robot, options: Options) -> Model<R> {
    Model::new(robot, &options).unwrap()
}

/// A control step of one dynamics step [s].
pub(crate) fn one_step(h: f64) -> Options {
    Options { time_step: h, substeps: 1, ..Options::default() }
}

/// A world of this dynamics step [s] under this gravity, downwards [m/s2].
pub(crate) fn world(robot: &Robot, h: f64, gravity: f64) -> World<f64> {
    World::new(model(robot, Options { gravity: [0.0, 0.0, -gravity], ..one_step(h) }))
}

/// A copy of the robot in which nothing touches.
pub(crate) fn ghost(robot: &Robot) -> Robot {
    Robot { pairs: Vec::new(), ..robot.clone() }
}

/// Number of pairs that touch.
pub(crate) fn touching<R: Precision>(world: &World<R>) -> usize {
    (0..world.pairs()).filter(|p| world.pair_contact(PairId(*p as u16)).points > 0).count()
}

/// A random start of trial `k`, as the experiment draws it.
pub(crate) fn start<R: Precision>(robot: &Robot, world: &mut World<R>, stream: &mut Stream, k: usize) {
    world.clear();
    for j in 0..27 {
        let [low, high] = robot.segments[j].joint.range;
        let pose = if j < 4 { POSES[k % 4][j].to_radians() } else { 0.0 };
        let q = (pose + 1.0_f64.to_radians() * f64::from(stream.range(-1.0, 1.0))).clamp(low, high);
        world.place_joint(JointId(j as u16), q as f32, 0.0);
    }
    let at = SPHERES[k % 4].map(|x| (x + 0.015 * f64::from(stream.range(-1.0, 1.0))) as f32);
    world.place_body(Tabletop::SPHERE, Pose::at([at[0], at[1], 0.025]), Twist::default());
    world.finish_placement();
}

pub(crate) fn stream(seed: u64, trial: u32) -> Stream {
    Stream::new(seed, Domain::Motor, trial, 0, 0)
}

/// The commands of the 27 actuators for outputs in [0, 1].
pub(crate) fn commands(groups: &[Vec<ServoRange>; 9], y: &[f32; OUTPUTS]) -> [[f32; 2]; 27] {
    let mut c = [[0.0; 2]; 27];
    for i in 0..7 {
        c[i] = [y[2 * i], y[2 * i + 1]];
    }
    for (group, y) in groups.iter().zip(&y[14..]) {
        for s in group {
            c[s.servo.index()] = [s.from + (s.to - s.from) * y, 0.0];
        }
    }
    c
}

pub(crate) fn drive<W>(world: &mut W, commands: &[[f32; 2]; 27])
where
    W: Actuated + Handles<Actuator = ActuatorId>,
{
    for (i, c) in commands.iter().enumerate() {
        world.command(ActuatorId(i as u16), *c);
    }
}

/// Random outputs in one of several manners: uniform every step, uniform held, extreme every step, extreme held.
#[derive(Clone)]
pub(crate) struct Babble {
    stream: Stream,
    hold: usize,
    extreme: bool,
    left: usize,
    pub(crate) y: [f32; OUTPUTS],
}

impl Babble {
    /// Number of manners.
    pub(crate) const MANNERS: u32 = 6;

    pub(crate) fn new(seed: u64, episode: u32) -> Self {
        let hold = [1, 1, 20, 20, 60, 200][(episode % Self::MANNERS) as usize];
        Self { stream: stream(seed, episode), hold, extreme: episode % 2 == 1, left: 0, y: [0.0; OUTPUTS] }
    }

    pub(crate) fn next(&mut self) -> &[f32; OUTPUTS] {
        if self.left == 0 {
            self.left = self.hold;
            for y in &mut self.y {
                let x = self.stream.uniform();
                *y = if self.extreme { if x < 0.5 { 0.0 } else { 1.0 } } else { x };
            }
        }
        self.left -= 1;
        &self.y
    }
}

/// Contact points of a pair, as the model numbers them.
pub(crate) fn points_of(robot: &Robot, pair: usize) -> usize {
    use Shape::{Box, Capsule, Cylinder, Plane, Sphere};
    let [a, b] = robot.pairs[pair].colliders.map(|c| robot.colliders[c].shape);
    match (a, b) {
        (Sphere { .. }, _) | (_, Sphere { .. }) | (Capsule { .. }, Capsule { .. }) => 1,
        (Capsule { .. }, Plane) | (Plane, Capsule { .. }) => 2,
        (Capsule { .. }, Box { .. } | Cylinder { .. }) | (Box { .. } | Cylinder { .. }, Capsule { .. }) => 3,
        (Box { .. }, Plane) | (Plane, Box { .. }) => 8,
        (Box { .. }, Box { .. }) => 13,
        (Cylinder { .. }, Plane) | (Plane, Cylinder { .. }) => 4,
        (Cylinder { .. }, _) | (_, Cylinder { .. }) | (Plane, Plane) => 0,
    }
}

/// Half the thickness of a collider's body [m].
pub(crate) fn half_thickness(shape: Shape) -> f64 {
    match shape {
        Shape::Sphere { radius } | Shape::Capsule { radius, .. } => radius,
        Shape::Box { half } => half[0].min(half[1]).min(half[2]),
        Shape::Cylinder { radius, half_length } => radius.min(half_length),
        Shape::Plane => f64::INFINITY,
    }
}

/// Where the contact points' words begin in a state.
pub(crate) fn first_point<R: Precision>(robot: &Robot, model: &Model<R>) -> usize {
    model.positions() + model.dofs() + 2 * robot.actuators.len()
}

/// The carrier of the palm of [`hand_and_sphere`].
#[derive(Clone, Copy, PartialEq)]
pub(crate) enum Wrist {
    /// Nothing moves it.
    Fixed,
    /// Three prismatic joints, along X, Y and Z. Their slides weigh next to nothing.
    Sliding,
    /// The arm, without muscles.
    Limp,
}

/// The hand of the experiment at posture 0 (palm down, 0.2 m above the ground) and the sphere, no table. Every joint of
/// the hand has an actuator of this law.
pub(crate) fn hand_and_sphere(wrist: Wrist, surface: Surface, law: Option<Law<f64>>) -> Robot {
    let arm = ArmAndHand { surface, ..ArmAndHand::default() };
    let table = Tabletop { hand_on_sphere: surface, ..Tabletop::default() };
    let mut robot = table.scene(&arm).unwrap();
    let still = robot.collider("table").unwrap();
    robot.pairs.retain(|p| !p.colliders.contains(&still));
    robot.actuators.drain(..7);
    if let Some(law) = law {
        robot.actuators.iter_mut().for_each(|a| a.law = law);
    } else {
        robot.actuators.clear();
    }
    let endless = [f64::NEG_INFINITY, f64::INFINITY];
    for (i, segment) in robot.segments[..7].iter_mut().enumerate() {
        match wrist {
            Wrist::Limp => continue,
            Wrist::Sliding if i < 3 => {
                let mut axis = [0.0; 3];
                axis[i] = 1.0;
                let at = segment.joint.placement;
                segment.joint = Joint::prismatic(&format!("slide{i}"), axis, at, endless);
            }
            _ => segment.joint = Joint::fixed(segment.joint.placement),
        }
        if wrist == Wrist::Sliding && i < 6 {
            segment.mass = 1e-6;
            segment.inertia = [1e-12, 1e-12, 1e-12, 0.0, 0.0, 0.0];
        }
    }
    robot
}

/// Where the palm's frame is at posture 0 [m].
pub(crate) const WRIST: [f64; 3] = [-0.025 + 0.152 + 0.137, -0.108, 0.21];

/// Places the sphere this far below the palm, where the fingers close around it [m].
pub(crate) fn put_in_the_palm<R: Precision>(world: &mut World<R>, gap: f64) {
    let at = [WRIST[0] + 0.0625 + 0.015, WRIST[1], WRIST[2] - 0.010 - 0.025 - gap];
    world.place_body(Tabletop::SPHERE, Pose::at(at.map(|x| x as f32)), Twist::default());
}

/// The groups of servos closed around the sphere, as in the scripted grasp.
pub(crate) const CLOSED: [f32; 9] = [0.85, 0.35, 0.35, 0.65, 0.70, 0.65, 0.70, 0.0, 0.675];

/// Commands of the hand's twenty servos for the nine groups' outputs.
pub(crate) fn close<R: Precision>(world: &mut World<R>, y: &[f32; 9]) {
    for (group, y) in ArmAndHand::default().servo_groups().iter().zip(y) {
        for s in group {
            world.command(ActuatorId(s.servo.0 - 7), [s.from + (s.to - s.from) * y, 0.0]);
        }
    }
}

/// Places the hand's joints where its servos would bring them for the nine groups' outputs.
pub(crate) fn pose_hand<R: Precision>(world: &mut World<R>, y: &[f32; 9]) {
    for (group, y) in ArmAndHand::default().servo_groups().iter().zip(y) {
        for s in group {
            world.place_joint(JointId(s.servo.0), s.from + (s.to - s.from) * y, 0.0);
        }
    }
}
