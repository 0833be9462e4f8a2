//! A simple planar world that supports all ports of mobile robots. It is intended for tests of sensors and motors.

use alloc::vec::Vec;

use farsa_num::{Scalar, sin_cos};

use crate::ports::{
    Actuated, ActuatorId, BodyId, Handles, Hit, JointId, Joints, Kinematics, Lamp, NearbySurface, Planar, PlanarHit,
    Rays, Sight, Snapshot, World,
};
use crate::pose::{Pose, Twist};
use crate::robots::mobile::{MobileParts, MobileRobot};

/// A planar world with walls, discs, lamps, colored ground and robots. All queries iterate over all objects, so it can
/// serve as a reference for faster worlds.
///
/// Bodies are numbered in the order in which they are added. The wheels and the actuators of all robots are numbered in
/// the same way. For ray casts, all objects are infinitely high. Robots drive along exact arcs and do not collide with
/// anything. An attachment device switched on holds the nearest disc or robot within its reach. The ground is black by
/// default, and the time step is 50 ms. Identifiers that do not exist read as 0, and commands to them have no effect.
///
/// ```
/// use farsa_body::ports::{Actuated, Kinematics, World};
/// use farsa_body::robots::MobileRobot;
/// use farsa_body::testing::PlaneWorld;
///
/// let mut world = PlaneWorld::new();
/// world.add_wall([[1.0, -1.0], [1.0, 1.0]], [1.0; 3]);
/// let khepera = world.add_robot(&MobileRobot::khepera(), [0.0, 0.0], 0.0);
/// for wheel in khepera.motors {
///     world.command(wheel, [2.0, 0.0]);
/// }
/// world.step();
/// assert!((world.pose(khepera.body).position[0] - 2.0 * 0.015 * 0.05).abs() < 1e-6);
/// ```
#[derive(Clone, Debug, PartialEq, Default)]
pub struct PlaneWorld {
    walls: Vec<Wall>,
    bodies: Vec<Round>,
    robots: Vec<Driven>,
    areas: Vec<Painted>,
    actuators: Vec<Device>,
}

#[derive(Clone, Copy, Debug, PartialEq)]
struct Wall {
    ends: [[f32; 2]; 2],
    color: [f32; 3],
}

#[derive(Clone, Copy, Debug, PartialEq)]
struct Round {
    centre: [f32; 2],
    heading: f32,
    radius: f32,
    color: [f32; 3],
    /// Strength of a lamp.
    intensity: Option<f32>,
    /// Its place among the robots.
    robot: Option<usize>,
}

#[derive(Clone, Copy, Debug, PartialEq)]
struct Driven {
    body: usize,
    wheel_radius: f32,
    track: f32,
    max_wheel_speed: f32,
    wheels: [f32; 2],
    angles: [f32; 2],
    leds: Option<[f32; 3]>,
    signal: f32,
    reach: Option<f32>,
    holds: bool,
}

#[derive(Clone, Copy, Debug, PartialEq)]
struct Painted {
    centre: [f32; 2],
    radius: f32,
    color: [f32; 3],
}

/// The kind of a robot's actuator.
#[derive(Clone, Copy, Debug, PartialEq)]
enum Device {
    Wheel(usize, usize),
    Led(usize, usize),
    Signal(usize),
    Attachment(usize),
}

fn sub(a: [f32; 2], b: [f32; 2]) -> [f32; 2] {
    [a[0] - b[0], a[1] - b[1]]
}

fn dot(a: [f32; 2], b: [f32; 2]) -> f32 {
    a[0] * b[0] + a[1] * b[1]
}

fn length(v: [f32; 2]) -> f32 {
    Scalar::sqrt(dot(v, v))
}

/// The first surface on a line: the distance, the outward normal, the color and the body.
struct Met {
    distance: f32,
    normal: [f32; 2],
    color: [f32; 3],
    body: Option<BodyId>,
}

impl PlaneWorld {
    /// Duration of a control step (in seconds).
    pub const TIME_STEP: f32 = 0.05;

    /// Creates an empty world.
    pub fn new() -> Self {
        Self::default()
    }

    /// Adds a wall between two points (in meters).
    pub fn add_wall(&mut self, ends: [[f32; 2]; 2], color: [f32; 3]) {
        self.walls.push(Wall { ends, color });
    }

    /// Adds a disc or an upright cylinder with the given center and radius (in meters).
    pub fn add_disc(&mut self, centre: [f32; 2], radius: f32, color: [f32; 3]) -> BodyId {
        self.add(Round { centre, heading: 0.0, radius, color, intensity: None, robot: None })
    }

    /// Adds a lamp. It is a white disc that emits light.
    pub fn add_lamp(&mut self, centre: [f32; 2], radius: f32, intensity: f32) -> BodyId {
        self.add(Round { centre, heading: 0.0, radius, color: [1.0; 3], intensity: Some(intensity), robot: None })
    }

    /// Paints a circle on the ground. It covers circles that were painted before.
    pub fn add_area(&mut self, centre: [f32; 2], radius: f32, color: [f32; 3]) {
        self.areas.push(Painted { centre, radius, color });
    }

    /// Adds a robot at the given position (in meters) and heading (in radians).
    pub fn add_robot(&mut self, robot: &MobileRobot, at: [f32; 2], heading: f32) -> MobileParts {
        let (index, color) = (self.robots.len(), robot.color.map(|x| x as f32));
        let radius = robot.radius as f32;
        let body = self.add(Round { centre: at, heading, radius, color, intensity: None, robot: Some(index) });
        self.robots.push(Driven {
            body: body.index(),
            wheel_radius: robot.wheel_radius as f32,
            track: robot.track as f32,
            max_wheel_speed: robot.max_wheel_speed as f32,
            wheels: [0.0; 2],
            angles: [0.0; 2],
            leds: robot.leds.then_some([0.0; 3]),
            signal: 0.0,
            reach: robot.attachment.map(|reach| reach as f32),
            holds: false,
        });
        let parts = robot.parts(body, JointId(2 * index as u16), ActuatorId(self.actuators.len() as u16));
        self.actuators.extend([Device::Wheel(index, 0), Device::Wheel(index, 1)]);
        if robot.leds {
            self.actuators.extend([0, 1, 2].map(|led| Device::Led(index, led)));
        }
        self.actuators.extend(robot.signal.then_some(Device::Signal(index)));
        self.actuators.extend(robot.attachment.map(|_| Device::Attachment(index)));
        parts
    }

    /// Moves a body to the given position (in meters) and heading (in radians).
    pub fn place(&mut self, body: BodyId, at: [f32; 2], heading: f32) {
        if let Some(round) = self.bodies.get_mut(body.index()) {
            round.centre = at;
            round.heading = heading;
        }
    }

    fn add(&mut self, round: Round) -> BodyId {
        self.bodies.push(round);
        BodyId(self.bodies.len() as u16 - 1)
    }

    fn ids(&self) -> impl Iterator<Item = (BodyId, &Round)> {
        (0..).map(BodyId).zip(&self.bodies)
    }

    fn robot_of(&self, round: &Round) -> Option<&Driven> {
        round.robot.and_then(|index| self.robots.get(index))
    }

    /// The color that a body shows.
    fn color(&self, round: &Round) -> [f32; 3] {
        match self.robot_of(round).and_then(|robot| robot.leds) {
            Some(leds) if leds.iter().any(|&led| led > 0.0) => leds,
            _ => round.color,
        }
    }

    /// The first thing on a line, without one of the bodies.
    fn meet(&self, from: [f32; 2], direction: [f32; 2], range: f32, but: Option<BodyId>) -> Option<Met> {
        let mut nearest: Option<Met> = None;
        let mut meet = |met: Met| {
            let within = met.distance >= 0.0 && met.distance <= range;
            if within && nearest.as_ref().is_none_or(|n| met.distance < n.distance) {
                nearest = Some(met);
            }
        };
        for wall in &self.walls {
            let ([a, b], [x, y]) = (wall.ends, direction);
            let (along, to) = (sub(b, a), sub(a, from));
            let cross = x * along[1] - y * along[0];
            let distance = (to[0] * along[1] - to[1] * along[0]) / cross;
            let share = (to[0] * y - to[1] * x) / cross;
            if cross != 0.0 && (0.0..=1.0).contains(&share) {
                let across = [along[1], -along[0]].map(|x| x / length(along));
                let normal = if dot(across, direction) > 0.0 { across.map(|x| -x) } else { across };
                meet(Met { distance, normal, color: wall.color, body: None });
            }
        }
        for (body, round) in self.ids() {
            let to = sub(round.centre, from);
            let along = dot(to, direction);
            let beside = sub(to, direction.map(|x| x * along));
            let depth = round.radius * round.radius - dot(beside, beside);
            if but != Some(body) && depth >= 0.0 && length(to) >= round.radius {
                let distance = along - Scalar::sqrt(depth);
                let normal = [0, 1].map(|i| (distance * direction[i] - to[i]) / round.radius);
                meet(Met { distance, normal, color: self.color(round), body: Some(body) });
            }
        }
        nearest
    }

    /// The speeds that a robot's wheels give it: ahead [m/s] and turning [rad/s].
    fn drive(robot: &Driven) -> [f32; 2] {
        let [left, right] = robot.wheels.map(|wheel| wheel * robot.wheel_radius);
        [0.5 * (left + right), (right - left) / robot.track]
    }

    fn wheel(&self, joint: JointId) -> Option<(&Driven, usize)> {
        self.robots.get(joint.index() / 2).map(|robot| (robot, joint.index() % 2))
    }
}

impl Handles for PlaneWorld {
    type Body = BodyId;
    type Joint = JointId;
    type Actuator = ActuatorId;
}

impl World for PlaneWorld {
    fn step(&mut self) {
        for robot in &mut self.robots {
            let (Some(round), [speed, turn]) = (self.bodies.get_mut(robot.body), Self::drive(robot)) else { continue };
            let before = sin_cos(round.heading);
            let turned = turn * Self::TIME_STEP;
            let way = speed * Self::TIME_STEP;
            round.heading += turned;
            let after = sin_cos(round.heading);
            let step = if turned.abs() > 1e-3 {
                [(after.0 - before.0) / turned, (before.1 - after.1) / turned]
            } else {
                [0.5 * (before.1 + after.1), 0.5 * (before.0 + after.0)]
            };
            round.centre = [round.centre[0] + way * step[0], round.centre[1] + way * step[1]];
            for (angle, wheel) in robot.angles.iter_mut().zip(robot.wheels) {
                *angle += wheel * Self::TIME_STEP;
            }
        }
    }
    fn time_step(&self) -> f32 {
        Self::TIME_STEP
    }
}

impl Kinematics for PlaneWorld {
    fn pose(&self, body: BodyId) -> Pose {
        let Some(round) = self.bodies.get(body.index()) else { return Pose::identity() };
        let (s, c) = sin_cos(0.5 * round.heading);
        Pose { position: [round.centre[0], round.centre[1], 0.0], rotation: [0.0, 0.0, s, c] }
    }
    fn velocity(&self, body: BodyId) -> Twist {
        let Some(round) = self.bodies.get(body.index()) else { return Twist::default() };
        let [speed, turn] = self.robot_of(round).map_or([0.0; 2], Self::drive);
        let (s, c) = sin_cos(round.heading);
        Twist { linear: [speed * c, speed * s, 0.0], angular: [0.0, 0.0, turn] }
    }
}

impl Joints for PlaneWorld {
    fn position(&self, joint: JointId) -> f32 {
        self.wheel(joint).map_or(0.0, |(robot, side)| robot.angles[side])
    }
    fn speed(&self, joint: JointId) -> f32 {
        self.wheel(joint).map_or(0.0, |(robot, side)| robot.wheels[side])
    }
}

impl Actuated for PlaneWorld {
    fn command(&mut self, actuator: ActuatorId, value: [f32; 2]) {
        let Some(&device) = self.actuators.get(actuator.index()) else { return };
        let (Device::Wheel(index, _) | Device::Led(index, _) | Device::Signal(index) | Device::Attachment(index)) =
            device;
        let Some(robot) = self.robots.get_mut(index) else { return };
        match device {
            Device::Wheel(_, side) => {
                robot.wheels[side] = Scalar::clamp(value[0], -robot.max_wheel_speed, robot.max_wheel_speed);
            }
            Device::Led(_, led) => robot.leds.iter_mut().for_each(|leds| leds[led] = Scalar::clamp(value[0], 0.0, 1.0)),
            Device::Signal(_) => robot.signal = Scalar::clamp(value[0], 0.0, 1.0),
            Device::Attachment(_) => robot.holds = value[0] > 0.5,
        }
    }
}

impl Rays for PlaneWorld {
    fn cast(&self, origin: [f32; 3], direction: [f32; 3], range: f32) -> Option<Hit<BodyId>> {
        let [x, y, _] = direction;
        let flat = length([x, y]);
        // A vertical ray hits nothing.
        if flat < 1e-6 {
            return None;
        }
        let met = self.meet([origin[0], origin[1]], [x / flat, y / flat], 2.0 * range, None)?;
        let distance = met.distance / flat;
        let [nx, ny] = met.normal;
        (distance <= range).then_some(Hit { distance, normal: [nx, ny, 0.0], body: met.body })
    }
}

impl Sight for PlaneWorld {
    fn query_near(&self, from: [f32; 2], range: f32, tell: &mut dyn FnMut(NearbySurface<BodyId>)) {
        for wall in &self.walls {
            let [a, b] = wall.ends;
            let along = sub(b, a);
            let share = Scalar::clamp(dot(sub(from, a), along) / dot(along, along), 0.0, 1.0);
            let point = [a[0] + share * along[0], a[1] + share * along[1]];
            let distance = length(sub(point, from));
            if distance <= range {
                tell(NearbySurface { body: None, point, distance, radius: 0.0, color: wall.color, signal: None });
            }
        }
        for (body, round) in self.ids() {
            let to = sub(round.centre, from);
            let apart = length(to);
            let distance = apart - round.radius;
            if distance <= range {
                let towards = if apart > 0.0 { to.map(|x| x / apart) } else { [1.0, 0.0] };
                let point = [0, 1].map(|i| from[i] + distance * towards[i]);
                let signal = self.robot_of(round).map(|robot| robot.signal);
                let (radius, color) = (round.radius, self.color(round));
                tell(NearbySurface { body: Some(body), point, distance, radius, color, signal });
            }
        }
    }
    fn cast_planar(
        &self,
        from: [f32; 2],
        direction: [f32; 2],
        range: f32,
        but: Option<BodyId>,
    ) -> Option<PlanarHit<BodyId>> {
        let met = self.meet(from, direction, range, but)?;
        Some(PlanarHit { distance: met.distance, body: met.body, color: met.color })
    }
}

impl Planar for PlaneWorld {
    fn ground(&self, at: [f32; 2]) -> [f32; 3] {
        let painted = |area: &&Painted| length(sub(at, area.centre)) <= area.radius;
        self.areas.iter().rev().find(painted).map_or([0.0; 3], |area| area.color)
    }
    fn lamps(&self, tell: &mut dyn FnMut(Lamp<BodyId>)) {
        for (body, round) in self.ids() {
            if let Some(intensity) = round.intensity {
                tell(Lamp { body, position: round.centre, intensity });
            }
        }
    }
    fn attached(&self, robot: BodyId) -> Option<BodyId> {
        let pose = self.bodies.get(robot.index())?;
        let driven = self.robot_of(pose)?;
        let reach = driven.reach.filter(|_| driven.holds)?;
        let gap = |round: &Round| length(sub(round.centre, pose.centre)) - round.radius - pose.radius;
        let others = self.ids().filter(|&(body, round)| body != robot && gap(round) <= reach);
        others.min_by(|a, b| gap(a.1).total_cmp(&gap(b.1))).map(|(body, _)| body)
    }
}

/// Words of a snapshot for a body, and further words for a robot.
const WORDS: [usize; 2] = [3, 9];

impl Snapshot for PlaneWorld {
    fn snapshot_len(&self) -> usize {
        WORDS[0] * self.bodies.len() + WORDS[1] * self.robots.len()
    }
    fn save(&self, out: &mut [f32]) {
        let bodies = self.bodies.iter().flat_map(|b| [b.centre[0], b.centre[1], b.heading]);
        let robots = self.robots.iter().flat_map(|r| {
            let ([w, v], [a, b], [red, green, blue]) = (r.wheels, r.angles, r.leds.unwrap_or_default());
            [w, v, a, b, red, green, blue, r.signal, f32::from(u8::from(r.holds))]
        });
        out.iter_mut().zip(bodies.chain(robots)).for_each(|(o, word)| *o = word);
    }
    fn restore(&mut self, from: &[f32]) {
        let (bodies, robots) = from.split_at((WORDS[0] * self.bodies.len()).min(from.len()));
        for (round, words) in self.bodies.iter_mut().zip(bodies.chunks_exact(WORDS[0])) {
            round.centre = [words[0], words[1]];
            round.heading = words[2];
        }
        for (robot, words) in self.robots.iter_mut().zip(robots.chunks_exact(WORDS[1])) {
            robot.wheels = [words[0], words[1]];
            robot.angles = [words[2], words[3]];
            robot.leds.iter_mut().for_each(|leds| *leds = [words[4], words[5], words[6]]);
            robot.signal = words[7];
            robot.holds = words[8] > 0.5;
        }
    }
}
