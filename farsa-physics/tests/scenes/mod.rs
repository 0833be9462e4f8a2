//! Scenes that every world can play: a robot, a start, commands that follow a timetable, and what is watched.
#![allow(dead_code, reason = "every test uses a part of it")]

use farsa_body::actuators::{Law, Servo};
use farsa_body::ports::{Actuated, ActuatorId, Arrange, BodyId, Handles, JointId, Joints, Kinematics, World};
use farsa_body::robot::{Collider, Joint, MassProperties, Robot, Segment, Shape, Surface};
use farsa_body::robots::{ArmAndHand, Tabletop};
use farsa_body::{Pose, Twist};
use farsa_models::mjcf::{self, MjcfOptions};
use farsa_num::sin_cos;
use serde_json::{Value, json};

use crate::common::{CLOSED, POSES, WRIST, ghost, scene};

/// Control step [s].
pub(crate) const TIME_STEP: f64 = 0.01;
/// The step that MuJoCo's models are written for [s].
pub(crate) const MODEL_STEP: f64 = 0.0025;

/// A number that is watched.
#[derive(Clone, Copy)]
pub(crate) enum Watched {
    /// Position of a joint [rad or m].
    Joint(JointId),
    /// A coordinate of a body's place in the world [m].
    Place(BodyId, usize),
    /// A coordinate of a body's place in another body's frame [m].
    Within(BodyId, BodyId, usize),
}

/// A scene.
pub(crate) struct Scene {
    pub(crate) name: &'static str,
    /// The name of its model's file.
    pub(crate) model: &'static str,
    pub(crate) robot: Robot,
    /// Control steps.
    pub(crate) steps: usize,
    pub(crate) joints: Vec<(JointId, f32)>,
    pub(crate) bodies: Vec<(BodyId, Pose<f32>, Twist<f32>)>,
    /// Commands of the actuators from a control step on. Between two of these they are interpolated.
    pub(crate) commands: Vec<(usize, Vec<[f32; 2]>)>,
    pub(crate) watched: Vec<Watched>,
    /// The unit of the observed quantities.
    pub(crate) unit: &'static str,
    /// The observed quantities at a time [s] by a formula, which replaces MuJoCo's limit.
    pub(crate) formula: Option<fn(f64) -> Vec<f64>>,
}

/// Everything that a scene asks of a world.
pub(crate) trait Stage:
    World + Kinematics + Joints + Actuated + Arrange + Handles<Body = BodyId, Joint = JointId, Actuator = ActuatorId>
{
}

impl<W> Stage for W where
    W: World
        + Kinematics
        + Joints
        + Actuated
        + Arrange
        + Handles<Body = BodyId, Joint = JointId, Actuator = ActuatorId>
{
}

impl Scene {
    fn new(name: &'static str, model: &'static str, robot: Robot, seconds: f64) -> Self {
        let steps = (seconds / TIME_STEP).round() as usize;
        Self {
            name,
            model,
            robot,
            steps,
            joints: Vec::new(),
            bodies: Vec::new(),
            commands: Vec::new(),
            watched: Vec::new(),
            unit: "m",
            formula: None,
        }
    }

    /// The commands of a control step.
    pub(crate) fn commands_at(&self, step: usize) -> Vec<[f32; 2]> {
        let next = self.commands.iter().position(|(from, _)| *from > step);
        let Some(next) = next else { return self.commands.last().map_or_else(Vec::new, |(_, c)| c.clone()) };
        let ((from, a), (to, b)) = (&self.commands[next - 1], &self.commands[next]);
        let share = (step - from) as f32 / (to - from) as f32;
        a.iter().zip(b).map(|(a, b)| [0, 1].map(|k| a[k] + (b[k] - a[k]) * share)).collect()
    }

    /// Returns the observed quantities of a world.
    fn look(&self, world: &impl Stage) -> Vec<f64> {
        let look = |watched: &Watched| match *watched {
            Watched::Joint(joint) => world.position(joint),
            Watched::Place(body, axis) => world.pose(body).position[axis],
            Watched::Within(body, other, axis) => world.pose(other).transform_back(world.pose(body).position)[axis],
        };
        self.watched.iter().map(look).map(f64::from).collect()
    }

    /// Plays the scene. The observed quantities after every control step.
    pub(crate) fn play(&self, world: &mut impl Stage) -> Vec<Vec<f64>> {
        world.clear();
        for (joint, q) in &self.joints {
            world.place_joint(*joint, *q, 0.0);
        }
        for (body, pose, twist) in &self.bodies {
            world.place_body(*body, *pose, *twist);
        }
        world.finish_placement();
        let mut rows = Vec::new();
        for step in 0..self.steps {
            for (i, command) in self.commands_at(step).into_iter().enumerate() {
                world.command(ActuatorId(i as u16), command);
            }
            world.step();
            rows.push(self.look(world));
        }
        rows
    }

    /// The robot as MuJoCo's model.
    pub(crate) fn mjcf(&self) -> String {
        mjcf::write(&self.robot, &MjcfOptions { time_step: MODEL_STEP, ..MjcfOptions::default() }).unwrap()
    }

    /// The timetable by the model's names.
    pub(crate) fn timetable(&self) -> Value {
        let robot = &self.robot;
        let joint = |joint: JointId| robot.segments[joint.index()].joint.name.as_str();
        let body = |body: BodyId| robot.segments[body.index()].name.as_str();
        let law = |law: &Law<f64>| match law {
            Law::MusclePair(m) => json!({"muscle-pair": {
                "tension": m.tension, "moment_arm": m.moment_arm, "lower": m.lower, "upper": m.upper,
                "shortest": m.shortest, "rest_length": m.rest_length, "longest": m.longest, "shape": m.shape,
                "passive_scale": m.passive_scale, "viscosity": m.viscosity,
            }}),
            Law::Servo(s) => json!({"servo": {"stiffness": s.stiffness, "damping": s.damping, "limit": s.limit}}),
            other => panic!("{other:?} is in no scene"),
        };
        let actuators =
            robot.actuators.iter().map(|a| json!({"name": a.name, "joint": joint(a.joint), "law": law(&a.law)}));
        let bodies = self.bodies.iter().map(|(at, pose, twist)| {
            json!({"name": body(*at), "position": pose.position, "rotation": pose.rotation, "linear": twist.linear,
                "angular": twist.angular})
        });
        let watched = self.watched.iter().map(|watched| match *watched {
            Watched::Joint(at) => json!({"joint": joint(at)}),
            Watched::Place(at, axis) => json!({"body": body(at), "axis": axis}),
            Watched::Within(at, other, axis) => json!({"body": body(at), "within": body(other), "axis": axis}),
        });
        json!({
            "name": self.name, "model": self.model, "time_step": TIME_STEP, "steps": self.steps,
            "joints": self.joints.iter().map(|(at, q)| json!([joint(*at), q])).collect::<Vec<_>>(),
            "bodies": bodies.collect::<Vec<_>>(),
            "actuators": actuators.collect::<Vec<_>>(),
            "commands": self.commands,
            "watched": watched.collect::<Vec<_>>(),
        })
    }
}

const ENDLESS: [f64; 2] = [f64::NEG_INFINITY, f64::INFINITY];
const GRAVITY: f64 = 9.81;
const RADIUS: f64 = 0.025;
const MASS: f64 = 0.05;

fn surface(friction: f64) -> Surface {
    Surface { friction, rolling_friction: 0.0, stiffness: 1e5, damping: 300.0 }
}

/// Builds rods in a row, hinged about the y axis, released level.
fn pendulum(name: &'static str, model: &'static str, rods: usize) -> Scene {
    let mut robot = Robot::new(model);
    let rod = MassProperties::capsule(0.2, 0.01, 0.12).placed(&Pose::at([0.0, 0.0, -0.13]));
    let mut above = None;
    for i in 0..rods {
        let at = if i == 0 { [0.0, 0.0, 1.0] } else { [0.0, 0.0, -0.26] };
        let hinge = Joint::revolute(&format!("hinge{i}"), [0.0, 1.0, 0.0], Pose::at(at), ENDLESS).with_damping(1e-3);
        above = Some(robot.add_segment(Segment::new(&format!("rod{i}"), above, hinge, rod)));
    }
    let hinges: Vec<_> = (0..rods as u16).map(JointId).collect();
    let joints = hinges.iter().map(|joint| (*joint, if joint.0 == 0 { 1.2 } else { 0.3 })).collect();
    let watched = hinges.iter().copied().map(Watched::Joint).collect();
    Scene { joints, watched, unit: "rad", ..Scene::new(name, model, robot, 1.0) }
}

/// The arm at its first start, nothing touches. Muscles under one command, the hand's servos this far to their ends.
fn arm(name: &'static str, joints: core::ops::Range<u16>, muscles: [f32; 2], closed: f32) -> Scene {
    let robot = ghost(&scene());
    let start = POSES[0].into_iter().enumerate();
    let start = start.map(|(i, degrees)| (JointId(i as u16), degrees.to_radians() as f32)).collect();
    let mut commands = vec![muscles; 7];
    commands.resize(robot.actuators.len(), [0.0; 2]);
    for s in ArmAndHand::default().servo_groups().iter().flatten() {
        commands[s.servo.index()][0] = s.from + (s.to - s.from) * closed;
    }
    let commands = vec![(0, commands)];
    let watched = joints.map(JointId).map(Watched::Joint).collect();
    Scene { joints: start, commands, watched, unit: "rad", ..Scene::new(name, "arm", robot, 1.0) }
}

/// Something of 50 g and a ground, tilted about y.
fn thing(name: &'static str, shape: Shape, friction: f64, degrees: f64) -> Scene {
    let mut robot = Robot::new(name);
    let solid = MassProperties::from_shape(&shape, MASS);
    let start = Joint::floating(Pose::at([0.0, 0.0, 1.0]));
    let body = robot.add_segment(Segment::new("thing", None, start, solid));
    let (sin, cos) = sin_cos(degrees.to_radians() / 2.0);
    let tilt = Pose { position: [0.0; 3], rotation: [0.0, sin, 0.0, cos] };
    let pair = [
        Collider::new("thing", Some(body), shape, Pose::identity()),
        Collider::new("ground", None, Shape::Plane, tilt),
    ];
    let pair = pair.map(|collider| robot.add_collider(collider));
    robot.add_pair(pair, surface(friction));
    Scene::new(name, name, robot, 1.0)
}

fn ball(name: &'static str, height: f64, speed: f32, friction: f64, watched: Vec<Watched>) -> Scene {
    let thrown = Twist { linear: [speed, 0.0, 0.0], angular: [0.0; 3] };
    let at = Pose::at([0.0, 0.0, (RADIUS + height) as f32]);
    let bodies = vec![(BodyId(0), at, thrown)];
    Scene { bodies, watched, ..thing(name, Shape::Sphere { radius: RADIUS }, friction, 0.0) }
}

/// A ball thrown along the ground slides with mu g until it rolls with 5/7 of its speed.
fn rolls(time: f64) -> Vec<f64> {
    let (slowing, slides) = (0.3 * GRAVITY, 2.0 / (7.0 * 0.3 * GRAVITY));
    let t = time.min(slides);
    vec![t - 0.5 * slowing * t * t + 5.0 / 7.0 * (time - t)]
}

/// A box slides down with g (sin - mu cos).
fn slides(time: f64) -> Vec<f64> {
    let (sin, cos) = sin_cos(29.0_f64.to_radians());
    let way = 0.5 * GRAVITY * (sin - 0.5 * cos) * time * time;
    vec![sin * RADIUS / 2.0 + cos * way, cos * RADIUS / 2.0 - sin * way]
}

/// A box on a slope steeper than its friction.
fn slide() -> Scene {
    let half = [RADIUS, RADIUS, RADIUS / 2.0];
    let scene = thing("slide", Shape::Box { half }, 0.5, 29.0);
    let rotation = scene.robot.colliders[1].placement.rotation;
    let slope = Pose { position: [0.0; 3], rotation };
    let pose = Pose { position: slope.rotate([0.0, 0.0, half[2]]), rotation };
    let watched = vec![Watched::Place(BodyId(0), 0), Watched::Place(BodyId(0), 2)];
    Scene { bodies: vec![(BodyId(0), pose.cast(), Twist::default())], watched, formula: Some(slides), ..scene }
}

fn servo(stiffness: f64, damping: f64, limit: f64) -> Law<f64> {
    Law::Servo(Servo { stiffness, damping, limit })
}

/// A knob on a slide pushes a box along the ground, in a second by 10 cm.
fn push() -> Scene {
    let half = [0.03, 0.03, 0.02];
    let mut scene = thing("push", Shape::Box { half }, 0.5, 0.0);
    let robot = &mut scene.robot;
    let knob = Shape::Sphere { radius: 0.01 };
    let rail = Joint::prismatic("rail", [1.0, 0.0, 0.0], Pose::at([-0.045, 0.0, 0.015]), ENDLESS);
    let solid = MassProperties::from_shape(&knob, 0.1);
    let body = robot.add_segment(Segment::new("knob", None, rail, solid));
    let knob = robot.add_collider(Collider::new("knob", Some(body), knob, Pose::identity()));
    robot.add_pair([knob, 0], surface(0.3));
    robot.add_actuator("rail", JointId(body.0), servo(500.0, 20.0, 10.0));
    let bodies = vec![(BodyId(0), Pose::at([0.0, 0.0, half[2] as f32]), Twist::default())];
    let commands = vec![(0, vec![[0.0; 2]]), (100, vec![[0.1, 0.0]])];
    let watched = vec![Watched::Joint(JointId(body.0)), Watched::Place(BodyId(0), 0), Watched::Place(BodyId(0), 1)];
    Scene { bodies, commands, watched, steps: 150, ..scene }
}

/// Two plates hold a ball between them with 4 N each.
fn pinch() -> Scene {
    let mut robot = Robot::new("pinch");
    let half = [0.005, 0.02, 0.02];
    let plate = Shape::Box { half };
    let start = Joint::floating(Pose::at([0.0, 0.0, 0.5]));
    let ball = robot.add_segment(Segment::new("ball", None, start, MassProperties::sphere(MASS, RADIUS)));
    let skin =
        robot.add_collider(Collider::new("ball", Some(ball), Shape::Sphere { radius: RADIUS }, Pose::identity()));
    let mut commands = Vec::new();
    for (name, side) in [("left", -1.0), ("right", 1.0)] {
        let rail = Joint::prismatic(name, [-side, 0.0, 0.0], Pose::at([side * (RADIUS + half[0]), 0.0, 0.5]), ENDLESS);
        let body = robot.add_segment(Segment::new(name, None, rail, MassProperties::from_shape(&plate, 0.1)));
        let collider = robot.add_collider(Collider::new(name, Some(body), plate, Pose::identity()));
        robot.add_pair([skin, collider], surface(1.0));
        robot.add_actuator(name, JointId(body.0), servo(2000.0, 40.0, 10.0));
        commands.push([0.002, 0.0]);
    }
    let bodies = vec![(ball, Pose::at([0.0, 0.0, 0.5]), Twist::default())];
    let watched = vec![Watched::Place(ball, 0), Watched::Place(ball, 2)];
    Scene { bodies, commands: vec![(0, commands)], watched, ..Scene::new("pinch", "pinch", robot, 2.0) }
}

/// Builds the experiment's hand on one joint instead of the arm, which a servo moves, with the sphere and the table.
fn hand(name: &'static str, wrist: &Joint, law: Law<f64>) -> Robot {
    let mut robot = Tabletop::default().scene(&ArmAndHand::default()).unwrap();
    name.clone_into(&mut robot.name);
    robot.actuators.drain(..6);
    robot.actuators[0].law = law;
    for segment in &mut robot.segments[..6] {
        segment.joint = Joint::fixed(segment.joint.placement);
    }
    let palm = &mut robot.segments[6];
    palm.joint = Joint { placement: palm.joint.placement, name: palm.joint.name.clone(), ..wrist.clone() };
    robot
}

/// The commands of the wrist and the hand's servos, the fingers closed to this share of the scripted grasp.
fn hand_commands(wrist: f32, closed: f32) -> Vec<[f32; 2]> {
    let mut commands = vec![[0.0; 2]; 21];
    commands[0][0] = wrist;
    for (group, y) in ArmAndHand::default().servo_groups().iter().zip(CLOSED) {
        for s in group {
            commands[s.servo.index() - 6][0] = s.from + (s.to - s.from) * y * closed;
        }
    }
    commands
}

/// The sphere in the palm's frame.
fn in_the_palm() -> Vec<Watched> {
    [0, 1, 2].map(|axis| Watched::Within(Tabletop::SPHERE, ArmAndHand::PALM, axis)).to_vec()
}

/// The sphere lies in the palm. The hand closes, turns over and holds it.
fn power_grasp() -> Scene {
    let axis = Joint::revolute("", [1.0, 0.0, 0.0], Pose::identity(), ENDLESS).with_armature(0.01);
    let robot = hand("power grasp", &axis, servo(50.0, 2.0, 50.0));
    let turned = core::f32::consts::PI;
    let at = [WRIST[0] + 0.0775, WRIST[1], WRIST[2] + 0.035].map(|x| x as f32);
    let commands = vec![
        (0, hand_commands(turned, 0.0)),
        (60, hand_commands(turned, 1.0)),
        (80, hand_commands(turned, 1.0)),
        (180, hand_commands(0.0, 1.0)),
    ];
    Scene {
        joints: vec![(JointId(6), turned)],
        bodies: vec![(Tabletop::SPHERE, Pose::at(at), Twist::default())],
        commands,
        watched: in_the_palm(),
        ..Scene::new("power grasp", "power_grasp", robot, 3.0)
    }
}

/// The hand over the sphere on the table closes, rises by 10 cm and holds.
fn lift() -> Scene {
    let axis = Joint::prismatic("", [0.0, 0.0, 1.0], Pose::identity(), ENDLESS);
    let robot = hand("lift", &axis, servo(2000.0, 100.0, 100.0));
    let down = (0.0605 - WRIST[2]) as f32;
    let at = [WRIST[0] + 0.0775, WRIST[1], 0.025].map(|x| x as f32);
    let commands =
        vec![(0, hand_commands(down, 1.0)), (80, hand_commands(down, 1.0)), (180, hand_commands(down + 0.1, 1.0))];
    let mut watched = in_the_palm();
    watched.push(Watched::Place(Tabletop::SPHERE, 2));
    Scene {
        joints: vec![(JointId(6), down)],
        bodies: vec![(Tabletop::SPHERE, Pose::at(at), Twist::default())],
        commands,
        watched,
        ..Scene::new("lift", "lift", robot, 3.0)
    }
}

/// All scenes.
pub(crate) fn scenes() -> Vec<Scene> {
    let along = vec![Watched::Place(BodyId(0), 0)];
    vec![
        pendulum("pendulum", "pendulum", 1),
        pendulum("double pendulum", "double_pendulum", 2),
        arm("arm swing", 0..7, [0.0; 2], 0.0),
        arm("servo step", 7..27, [0.0; 2], 0.6),
        arm("unequal activations", 0..7, [0.3, 0.1], 0.0),
        ball("drop", 0.1, 0.0, 0.5, vec![Watched::Place(BodyId(0), 2)]),
        Scene { formula: Some(rolls), ..ball("roll", 0.0, 1.0, 0.3, along) },
        slide(),
        push(),
        pinch(),
        power_grasp(),
        lift(),
    ]
}
