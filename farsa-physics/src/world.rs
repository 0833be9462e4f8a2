//! One articulated world that answers the ports.

use alloc::vec;
use alloc::vec::Vec;

use farsa_body::{
    Actuated, ActuatorId, Arrange, BodyId, Contacts, Handles, JointId, Joints, Kinematics, PairContact, PairId, Pose,
    Snapshot, Twist,
};
use farsa_num::Real;

use crate::model::{Model, POINT_WORDS};
use crate::spatial::{Matrix, add, cross, product, rotate, sub};
use crate::step::{Precision, Scratch, parts};
use crate::tree::{LinkWork, Motion, WORLD};

/// One articulated world: a model and its state.
#[derive(Clone, Debug)]
pub struct World<R: Precision> {
    model: Model<R>,
    state: Vec<R>,
    scratch: Scratch<R>,
}

/// The unit quaternion [x, y, z, w] of a rotation, w >= 0 where it is not close to 0.
fn quaternion<R: Real>(m: &Matrix<R>) -> [R; 4] {
    let one = R::of(1.0);
    let half = R::of(0.5);
    let trace = m[0][0] + m[1][1] + m[2][2];
    if trace > R::of(0.0) {
        let s = (trace + one).sqrt();
        let k = half / s;
        return [(m[2][1] - m[1][2]) * k, (m[0][2] - m[2][0]) * k, (m[1][0] - m[0][1]) * k, s * half];
    }
    let i = if m[0][0] >= m[1][1] && m[0][0] >= m[2][2] {
        0
    } else if m[1][1] >= m[2][2] {
        1
    } else {
        2
    };
    let (j, k) = ((i + 1) % 3, (i + 2) % 3);
    let s = (m[i][i] - m[j][j] - m[k][k] + one).sqrt();
    let t = half / s;
    let mut q = [R::of(0.0); 4];
    q[i] = s * half;
    q[j] = (m[j][i] + m[i][j]) * t;
    q[k] = (m[k][i] + m[i][k]) * t;
    q[3] = (m[k][j] - m[j][k]) * t;
    q
}

fn f32_of<R: Real>(x: [R; 3]) -> [f32; 3] {
    x.map(|x| x.to_f64() as f32)
}

impl<R: Precision> World<R> {
    /// A world at its description's start.
    pub fn new(model: Model<R>) -> Self {
        let state = model.initial.clone();
        let scratch = Scratch::new((), &model);
        let mut world = Self { model, state, scratch };
        world.arranged();
        world
    }

    /// The constant part.
    pub fn model(&self) -> &Model<R> {
        &self.model
    }

    pub(crate) fn links(&self) -> &[LinkWork<R>] {
        &self.scratch.links
    }

    /// Positions, velocities, commands and contacts [`Model::state_len`].
    pub fn state(&self) -> &[R] {
        &self.state
    }

    /// The same, to be changed; [`Arrange::arranged`] must follow.
    pub fn state_mut(&mut self) -> &mut [R] {
        &mut self.state
    }

    /// Joint and floating positions [positions].
    pub fn positions(&self) -> &[R] {
        &self.state[..self.model.positions]
    }

    /// Joint and floating velocities [dofs].
    pub fn velocities(&self) -> &[R] {
        &self.state[self.model.positions..self.model.positions + self.model.dofs]
    }

    /// Whether every word of the state is finite.
    pub fn is_finite(&self) -> bool {
        self.state[..self.model.positions + self.model.dofs].iter().all(|x| x.to_f64().is_finite())
    }

    /// Kinetic and potential energy [J], armatures included, contacts and actuators not.
    pub fn energy(&mut self) -> [f64; 2] {
        let v = &self.state[self.model.positions..];
        let work = &mut self.scratch.links;
        let kinetic = crate::tree::kinetic_energy((), &self.model.links, v, work);
        let potential = crate::tree::potential_energy((), &self.model.links, self.model.gravity, work);
        [kinetic.to_f64(), potential.to_f64()]
    }

    /// Linear momentum of all moving bodies [N s], armatures not counted.
    pub fn momentum(&self) -> [f64; 3] {
        let mut sum = [0.0; 3];
        for (link, w) in self.model.links.iter().zip(&self.scratch.links) {
            let v = w.velocity.at(sub(w.centre, w.reference));
            for k in 0..3 {
                sum[k] += link.mass.to_f64() * v[k].to_f64();
            }
        }
        sum
    }

    /// Joint efforts that hold the present positions at rest against gravity: recursive Newton-Euler [dofs; N m or N].
    pub fn gravity_efforts(&mut self, tau: &mut [R]) {
        let zeros = vec![R::of(0.0); self.model.dofs];
        let (model, state) = (&self.model, &self.state);
        let work = &mut self.scratch.links;
        crate::tree::place((), &model.links, &state[..model.positions], &zeros, work);
        crate::tree::inverse_dynamics((), &model.links, model.gravity, &zeros, work, tau);
        self.arranged();
    }

    /// Pose of a body's frame in full precision.
    pub fn pose_of(&self, body: BodyId) -> Pose<R> {
        let Some(mount) = self.model.mounts.get(body.index()) else { return Pose::identity() };
        if mount.link == WORLD {
            return Pose { position: mount.position, rotation: quaternion(&mount.rotation) };
        }
        let w = &self.scratch.links[usize::from(mount.link)];
        Pose {
            position: add(w.position, rotate(&w.rotation, mount.position)),
            rotation: quaternion(&product(&w.rotation, &mount.rotation)),
        }
    }

    /// Whether a pair's points tell of the second collider instead of the first, and the points' words.
    fn points(&self, pair: PairId) -> Option<(bool, &[R])> {
        let pair = self.model.pairs.get(pair.index())?;
        let first = self.model.first_point() + POINT_WORDS * pair.point;
        Some((pair.flipped, self.state.get(first..first + POINT_WORDS * pair.points)?))
    }

    /// Velocity of a body's origin and its angular velocity in full precision.
    pub fn velocity_of(&self, body: BodyId) -> Twist<R> {
        let Some(mount) = self.model.mounts.get(body.index()) else { return Twist::default() };
        if mount.link == WORLD {
            return Twist::default();
        }
        let w = &self.scratch.links[usize::from(mount.link)];
        let origin = add(w.position, rotate(&w.rotation, mount.position));
        Twist { linear: w.velocity.at(sub(origin, w.reference)), angular: w.velocity.angular }
    }
}

impl<R: Precision> Handles for World<R> {
    type Body = BodyId;
    type Joint = JointId;
    type Actuator = ActuatorId;
}

impl<R: Precision> farsa_body::World for World<R> {
    fn step(&mut self) {
        R::step(&self.model, &mut self.state, &mut self.scratch);
    }
    fn time_step(&self) -> f32 {
        self.model.time_step.to_f64() as f32
    }
}

impl<R: Precision> Kinematics for World<R> {
    fn pose(&self, body: BodyId) -> Pose {
        self.pose_of(body).cast()
    }
    fn velocity(&self, body: BodyId) -> Twist {
        let v = self.velocity_of(body);
        Twist { linear: f32_of(v.linear), angular: f32_of(v.angular) }
    }
}

impl<R: Precision> Joints for World<R> {
    fn position(&self, joint: JointId) -> f32 {
        self.model.joint_index(joint).map_or(0.0, |(q, _)| self.state[q].to_f64() as f32)
    }
    fn speed(&self, joint: JointId) -> f32 {
        self.model.joint_index(joint).map_or(0.0, |(_, v)| self.state[self.model.positions + v].to_f64() as f32)
    }
}

impl<R: Precision> Actuated for World<R> {
    fn command(&mut self, actuator: ActuatorId, value: [f32; 2]) {
        let parts = parts(&self.model, &mut self.state);
        let at = 2 * actuator.index();
        if let Some(words) = parts.commands.get_mut(at..at + 2) {
            words[0] = R::of(f64::from(value[0]));
            words[1] = R::of(f64::from(value[1]));
        }
    }
}

impl<R: Precision> Contacts for World<R> {
    fn pairs(&self) -> usize {
        self.model.pairs.len()
    }

    fn pair_bodies(&self, pair: PairId) -> [Option<BodyId>; 2] {
        self.model.pair_bodies.get(pair.index()).copied().unwrap_or([None; 2])
    }

    fn touches(&self, pair: PairId) -> bool {
        let Some(pair) = self.model.pairs.get(pair.index()) else { return false };
        let first = self.model.first_point() + POINT_WORDS * pair.point;
        let impulse = |point: usize| self.state.get(first + 3 + POINT_WORDS * point);
        (0..pair.points).any(|point| impulse(point).is_some_and(|impulse| *impulse > R::of(0.0)))
    }

    fn pair_contact(&self, pair: PairId) -> PairContact {
        let Some((flipped, points)) = self.points(pair) else { return PairContact::default() };
        let mut contact = PairContact { depth: f32::NEG_INFINITY, ..PairContact::default() };
        let (mut force, mut normal, mut moment) = ([0.0; 3], 0.0, [0.0; 3]);
        let per_second = 1.0 / self.model.h.to_f64();
        for words in points.chunks_exact(POINT_WORDS) {
            let w = |k: usize| words[k].to_f64();
            contact.depth = contact.depth.max(-w(7) as f32);
            if w(3) > 0.0 {
                contact.points += 1;
                let f = w(3) * per_second;
                normal += f;
                for k in 0..3 {
                    force[k] += w(k) * per_second;
                    moment[k] += w(4 + k) * f;
                }
            }
        }
        if contact.points > 0 {
            let sign = if flipped { -1.0 } else { 1.0 };
            contact.force = force.map(|x| (sign * x) as f32);
            contact.normal_force = normal as f32;
            contact.point = moment.map(|x| (x / normal) as f32);
        }
        contact
    }
}

impl<R: Precision> Snapshot for World<R> {
    fn snapshot_len(&self) -> usize {
        self.state.len()
    }
    fn save(&self, out: &mut [f32]) {
        for (o, x) in out.iter_mut().zip(&self.state) {
            *o = x.to_f64() as f32;
        }
    }
    fn restore(&mut self, from: &[f32]) {
        for (x, f) in self.state.iter_mut().zip(from) {
            *x = R::of(f64::from(*f));
        }
        self.arranged();
    }
}

impl<R: Precision> Arrange for World<R> {
    fn clear(&mut self) {
        self.state.copy_from_slice(&self.model.initial);
        self.arranged();
    }

    fn place_joint(&mut self, joint: JointId, position: f32, speed: f32) {
        if let Some((q, v)) = self.model.joint_index(joint) {
            self.state[q] = R::of(f64::from(position));
            self.state[self.model.positions + v] = R::of(f64::from(speed));
        }
    }

    fn place_body(&mut self, body: BodyId, pose: Pose, twist: Twist) {
        let Some(link) = self.model.link_of(body) else { return };
        let link = &self.model.links[link];
        if link.motion != Motion::Floating || self.model.joints[body.index()] != farsa_body::JointKind::Floating {
            return;
        }
        let (q, v) = (usize::from(link.q), self.model.positions + usize::from(link.dof));
        let pose: Pose<R> = pose.cast();
        let [angular, linear] = [twist.angular, twist.linear].map(|a| a.map(|x| R::of(f64::from(x))));
        let rotation = pose.rotation;
        let length = (rotation[0] * rotation[0]
            + rotation[1] * rotation[1]
            + rotation[2] * rotation[2]
            + rotation[3] * rotation[3])
            .sqrt();
        let centre = add(linear, cross(angular, pose.rotate(link.centre)));
        for k in 0..3 {
            self.state[q + k] = pose.position[k];
            self.state[v + k] = angular[k];
            self.state[v + 3 + k] = centre[k];
        }
        for k in 0..4 {
            self.state[q + 3 + k] = rotation[k] / length;
        }
    }

    fn arranged(&mut self) {
        R::place(&self.model, &self.state, &mut self.scratch);
    }
}
