//! A simple world that supports most ports. It is intended for tests of sensors and motors.

use alloc::{vec, vec::Vec};

use farsa_num::{Scalar, sin_cos};

use crate::ports::{
    Actuated, ActuatorId, Arrange, BodyId, Contacts, ExternalForces, Handles, Hit, JointId, Joints, Kinematics,
    PairContact, PairId, Rays, Seen, Snapshot, Vision, World,
};
use crate::pose::{Pose, Twist};

/// A world with points of 1 kg that move on vertical screws above a floor. Its dynamics consist of a few explicit
/// equations.
///
/// Point i is attached to joint i. The joint position is the height q (in meters). The point is body i at the position
/// (0.1 i, 0, q) and rotates about the vertical axis by 10 rad per meter. Actuator i pushes it upwards with a force of
/// `command[0] - command[1]` (in newtons). Below the height 0, the floor pushes back. Its contact is pair i, in which
/// the point is the first body. Rays hit the floor and green spheres of 2 cm around the points. The time step is 10 ms,
/// and there are no floating bodies. Identifiers that do not exist read as 0, and commands to them have no effect.
#[derive(Clone, Debug, PartialEq)]
pub struct PointWorld {
    points: Vec<Point>,
}

#[derive(Clone, Copy, Debug, PartialEq, Default)]
struct Point {
    height: f32,
    speed: f32,
    command: [f32; 2],
    /// External force in the next step [N].
    outside: f32,
}

/// Words of a snapshot for each point.
const WORDS: usize = 4;

impl PointWorld {
    /// Duration of a control step (in seconds).
    pub const TIME_STEP: f32 = 0.01;
    /// Rotation of a point per unit of height (in rad/m).
    pub const TURN: f32 = 10.0;
    /// The distance between two screws, in meters.
    const SPACING: f32 = 0.1;
    /// Radius of the spheres hit by rays in meters.
    pub const RADIUS: f32 = 0.02;
    /// Color of the spheres. The floor has no color.
    pub const COLOR: [f32; 3] = [0.0, 1.0, 0.0];
    /// Acceleration downwards [m/s2].
    const GRAVITY: f32 = 9.81;
    /// Friction of the screws [N s/m].
    const FRICTION: f32 = 0.5;
    /// Stiffness [N/m] and damping [N s/m] of the floor.
    const FLOOR: [f32; 2] = [2000.0, 20.0];

    /// Creates a new world with the given number of points, all at rest on the floor.
    pub fn new(points: usize) -> Self {
        Self { points: vec![Point::default(); points] }
    }

    /// Returns the current command of an actuator, or 0 if the actuator does not exist.
    pub fn commanded(&self, actuator: ActuatorId) -> [f32; 2] {
        self.point(actuator.index()).command
    }

    fn point(&self, index: usize) -> Point {
        self.points.get(index).copied().unwrap_or_default()
    }
}

impl Point {
    /// The floor's push upwards [N].
    fn push(&self) -> f32 {
        let [stiffness, damping] = PointWorld::FLOOR;
        let push = -stiffness * self.height - damping * self.speed;
        if self.height < 0.0 { Scalar::max(push, 0.0) } else { 0.0 }
    }
}

impl Handles for PointWorld {
    type Body = BodyId;
    type Joint = JointId;
    type Actuator = ActuatorId;
}

impl World for PointWorld {
    fn step(&mut self) {
        for point in &mut self.points {
            let drive = point.command[0] - point.command[1] - Self::FRICTION * point.speed + point.outside;
            point.speed += Self::TIME_STEP * (drive + point.push() - Self::GRAVITY);
            point.height += Self::TIME_STEP * point.speed;
            point.outside = 0.0;
        }
    }
    fn time_step(&self) -> f32 {
        Self::TIME_STEP
    }
}

impl Joints for PointWorld {
    fn position(&self, joint: JointId) -> f32 {
        self.point(joint.index()).height
    }
    fn speed(&self, joint: JointId) -> f32 {
        self.point(joint.index()).speed
    }
}

impl Kinematics for PointWorld {
    fn pose(&self, body: BodyId) -> Pose {
        let height = self.point(body.index()).height;
        let (s, c) = sin_cos(0.5 * Self::TURN * height);
        Pose { position: [Self::SPACING * f32::from(body.0), 0.0, height], rotation: [0.0, 0.0, s, c] }
    }
    fn velocity(&self, body: BodyId) -> Twist {
        let speed = self.point(body.index()).speed;
        Twist { linear: [0.0, 0.0, speed], angular: [0.0, 0.0, Self::TURN * speed] }
    }
}

impl Actuated for PointWorld {
    fn command(&mut self, actuator: ActuatorId, value: [f32; 2]) {
        if let Some(point) = self.points.get_mut(actuator.index()) {
            point.command = value;
        }
    }
}

impl ExternalForces for PointWorld {
    fn apply_force(&mut self, body: BodyId, _: [f32; 3], force: [f32; 3]) {
        if let Some(point) = self.points.get_mut(body.index()) {
            point.outside += force[2];
        }
    }
}

impl Contacts for PointWorld {
    fn pairs(&self) -> usize {
        self.points.len()
    }
    fn pair_bodies(&self, pair: PairId) -> [Option<BodyId>; 2] {
        [(pair.index() < self.points.len()).then_some(BodyId(pair.0)), None]
    }
    fn pair_contact(&self, pair: PairId) -> PairContact {
        let Some(point) = self.points.get(pair.index()) else { return PairContact::default() };
        let push = point.push();
        if push > 0.0 {
            let position = self.pose(BodyId(pair.0)).position;
            PairContact {
                points: 1,
                force: [0.0, 0.0, push],
                normal_force: push,
                point: position,
                depth: -point.height,
            }
        } else {
            PairContact { depth: -point.height, ..PairContact::default() }
        }
    }
}

impl Rays for PointWorld {
    fn cast(&self, origin: [f32; 3], direction: [f32; 3], range: f32) -> Option<Hit<BodyId>> {
        self.first(origin, direction, range, None)
    }
}

impl PointWorld {
    /// The first surface on a ray, except that of `but`.
    fn first(&self, origin: [f32; 3], direction: [f32; 3], range: f32, but: Option<BodyId>) -> Option<Hit<BodyId>> {
        let mut nearest: Option<Hit<BodyId>> = None;
        let mut meet = |hit: Hit<BodyId>| {
            if hit.distance <= nearest.map_or(range, |n| n.distance) {
                nearest = Some(hit);
            }
        };
        if origin[2] >= 0.0 && direction[2] < 0.0 {
            meet(Hit { distance: -origin[2] / direction[2], normal: [0.0, 0.0, 1.0], body: None });
        }
        for body in (0..self.points.len()).map(|i| BodyId(i as u16)).filter(|body| Some(*body) != but) {
            let centre = self.pose(body).position;
            let way = [origin[0] - centre[0], origin[1] - centre[1], origin[2] - centre[2]];
            let dot = |a: [f32; 3], b: [f32; 3]| a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
            let along = -dot(way, direction);
            let beside = [0, 1, 2].map(|i| way[i] + along * direction[i]);
            let depth = Self::RADIUS * Self::RADIUS - dot(beside, beside);
            if depth >= 0.0 {
                let distance = along - Scalar::sqrt(depth);
                if distance >= 0.0 {
                    let normal = [0, 1, 2].map(|i| (way[i] + distance * direction[i]) / Self::RADIUS);
                    meet(Hit { distance, normal, body: Some(body) });
                }
            }
        }
        nearest
    }
}

impl Vision for PointWorld {
    fn look(
        &self,
        from: [f32; 3],
        directions: &[[f32; 3]],
        range: f32,
        but: Option<BodyId>,
        seen: &mut [Option<Seen<BodyId>>],
    ) {
        for (seen, direction) in seen.iter_mut().zip(directions) {
            *seen = self.first(from, *direction, range, but).map(|hit| Seen {
                distance: hit.distance,
                body: hit.body,
                color: hit.body.map(|_| Self::COLOR),
            });
        }
    }
}

impl Arrange for PointWorld {
    fn clear(&mut self) {
        self.points.fill(Point::default());
    }
    fn place_joint(&mut self, joint: JointId, position: f32, speed: f32) {
        if let Some(point) = self.points.get_mut(joint.index()) {
            point.height = position;
            point.speed = speed;
        }
    }
    fn place_body(&mut self, _: BodyId, _: Pose, _: Twist) {}
    fn finish_placement(&mut self) {}
}

impl Snapshot for PointWorld {
    fn snapshot_len(&self) -> usize {
        WORDS * self.points.len()
    }
    fn save(&self, out: &mut [f32]) {
        for (words, point) in out.chunks_exact_mut(WORDS).zip(&self.points) {
            words.copy_from_slice(&[point.height, point.speed, point.command[0], point.command[1]]);
        }
    }
    fn restore(&mut self, from: &[f32]) {
        for (words, point) in from.chunks_exact(WORDS).zip(&mut self.points) {
            if let &[height, speed, agonist, antagonist] = words {
                *point = Point { height, speed, command: [agonist, antagonist], outside: 0.0 };
            }
        }
    }
}
