//! A single articulated world.

use alloc::vec::Vec;

use farsa_body::ports::{
    Actuated, ActuatorId, Arrange, BodyId, Contacts, Handles, Hit, JointId, Joints, Kinematics, NearbySurface,
    PairContact, PairId, PlanarHit, Rays, Seen, Sight, Snapshot, Vision,
};
use farsa_body::{Pose, Twist};
use farsa_num::Real;

use crate::articulated::external::Wrenches;
use crate::articulated::link::Motion;
use crate::articulated::model::{Model, Pair};
use crate::articulated::ray;
use crate::articulated::sight;
use crate::articulated::solver::near_pairs;
use crate::articulated::spatial::{Matrix, Spatial, Vector, sub};
use crate::articulated::step::{Precision, Scratch};
use crate::articulated::tree::{forward_kinematics, inverse_dynamics, kinetic_energy, potential_energy};
use crate::articulated::view::{self, View, is_touching};
use crate::articulated::vision;

/// A single articulated world, which consists of a model and its state.
#[derive(Clone, Debug)]
pub struct World<R: Precision> {
    model: Model<R>,
    state: Vec<R>,
    scratch: Scratch<R>,
    forces: Wrenches<R>,
}

fn f32_of<R: Real>(x: [R; 3]) -> [f32; 3] {
    x.map(|x| x.to_f64() as f32)
}

impl<R: Precision> World<R> {
    /// Creates a world in the initial state of its description.
    pub fn new(model: Model<R>) -> Self {
        let state = model.initial.clone();
        let scratch = Scratch::new((), &model);
        let forces = Wrenches::new(&model);
        let mut world = Self { model, state, scratch, forces };
        world.finish_placement();
        world
    }

    /// Gets the model of this world.
    pub fn model(&self) -> &Model<R> {
        &self.model
    }

    /// Gets the current state, which has the length [`Model::state_len`]. It contains positions, velocities, commands
    /// and contacts.
    pub fn state(&self) -> &[R] {
        &self.state
    }

    /// Gives mutable access to the state. Note that you must call [`Arrange::finish_placement`] after changing it.
    pub fn state_mut(&mut self) -> &mut [R] {
        &mut self.state
    }

    /// Positions of joints and floating bodies [positions].
    pub fn positions(&self) -> &[R] {
        &self.state[..self.model.positions]
    }

    /// Velocities of joints and floating bodies [dofs].
    pub fn velocities(&self) -> &[R] {
        &self.state[self.model.positions..self.model.positions + self.model.dofs]
    }

    /// Checks whether all numbers of the state are finite. Use this to detect a simulation that has diverged.
    pub fn is_finite(&self) -> bool {
        self.state[..self.model.positions + self.model.dofs].iter().all(|x| x.to_f64().is_finite())
    }

    /// Computes the kinetic and the potential energy [J]. This includes armatures and the springs of joints, but not
    /// contacts and actuators.
    pub fn energy(&mut self) -> [f64; 2] {
        let v = &self.state[self.model.positions..];
        let work = &mut self.scratch.links;
        let kinetic = kinetic_energy((), &self.model.links, v, work);
        let weight = potential_energy((), &self.model.links, self.model.gravity, work);
        let joints = self.model.links.iter().filter(|link| link.motion != Motion::Floating);
        let stretched = joints.map(|link| {
            let stretch = (self.state[usize::from(link.q)] - link.rest).to_f64();
            0.5 * link.stiffness.to_f64() * stretch * stretch
        });
        [kinetic.to_f64(), weight.to_f64() + stretched.sum::<f64>()]
    }

    /// Computes the linear momentum of all moving bodies [N s]. Armatures are not included.
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

    /// Computes the joint efforts that hold the current positions at rest against gravity [dofs, N m or N]. This uses
    /// the recursive Newton-Euler algorithm.
    ///
    /// # Panics
    /// When there is not a place for each degree of freedom.
    pub fn gravity_efforts(&mut self, tau: &mut [R]) {
        let (model, state) = (&self.model, &self.state);
        let Scratch { links: work, qdd, .. } = &mut self.scratch;
        // At rest, and without accelerations. Each step writes them again.
        qdd.fill(R::from_f64(0.0));
        forward_kinematics((), &model.links, &state[..model.positions], qdd, work);
        inverse_dynamics((), &model.links, model.gravity, qdd, work, tau);
        self.finish_placement();
    }

    /// Number of pairs that were close enough in the last dynamics step for their surfaces to be compared.
    ///
    /// Before the first step it means nothing.
    pub fn near_pairs(&self) -> usize {
        near_pairs(&self.model, &self.scratch.placed)
    }

    /// Computes the pose of the frame of a body in full precision.
    pub fn pose_of(&self, body: BodyId) -> Pose<R> {
        view::pose(self, body)
    }

    /// Computes the velocity of the origin of a body and its angular velocity in full precision.
    pub fn velocity_of(&self, body: BodyId) -> Twist<R> {
        view::velocity(self, body)
    }
}

impl<R: Precision> View<R> for World<R> {
    fn model(&self) -> &Model<R> {
        &self.model
    }
    #[inline]
    fn word(&self, index: usize) -> R {
        self.state[index]
    }
    #[inline]
    fn touching(&self, _index: usize, pair: &Pair<R>) -> bool {
        is_touching(&self.model, pair, &self.state)
    }
    fn set_word(&mut self, index: usize, x: R) {
        self.state[index] = x;
    }
    fn link_frame(&self, link: usize) -> (Matrix<R>, Vector<R>) {
        let w = &self.scratch.links[link];
        (w.rotation, w.position)
    }
    fn link_position(&self, link: usize) -> Vector<R> {
        self.scratch.links[link].position
    }
    fn motion(&self, link: usize) -> (Spatial<R>, Vector<R>) {
        let w = &self.scratch.links[link];
        (w.velocity, w.reference)
    }
}

impl<R: Precision> Handles for World<R> {
    type Body = BodyId;
    type Joint = JointId;
    type Actuator = ActuatorId;
}

impl<R: Precision> farsa_body::ports::World for World<R> {
    fn step(&mut self) {
        let Self { model, state, scratch, forces } = self;
        R::step(model, state, scratch, forces);
    }
    fn time_step(&self) -> f32 {
        self.model.time_step.to_f64() as f32
    }
}

impl<R: Precision> Kinematics for World<R> {
    fn pose(&self, body: BodyId) -> Pose {
        self.pose_of(body).cast()
    }
    fn origin(&self, body: BodyId) -> [f32; 3] {
        f32_of(view::origin(self, body))
    }
    fn velocity(&self, body: BodyId) -> Twist {
        let v = self.velocity_of(body);
        Twist { linear: f32_of(v.linear), angular: f32_of(v.angular) }
    }
}

impl<R: Precision> Joints for World<R> {
    fn position(&self, joint: JointId) -> f32 {
        view::joint_position(self, joint)
    }
    fn speed(&self, joint: JointId) -> f32 {
        view::joint_speed(self, joint)
    }
}

impl<R: Precision> Actuated for World<R> {
    #[inline]
    fn command(&mut self, actuator: ActuatorId, value: [f32; 2]) {
        view::command(self, actuator.index(), value);
    }
}

impl<R: Precision> farsa_body::ports::ExternalForces for World<R> {
    fn apply_force(&mut self, body: BodyId, point: [f32; 3], force: [f32; 3]) {
        let Some(link) = self.model.link_of(body) else { return };
        let [point, force] = [point, force].map(|a| a.map(|x| R::from_f64(f64::from(x))));
        self.forces.add(link, self.scratch.links[link].centre, point, force);
    }
}

impl<R: Precision> Contacts for World<R> {
    fn pairs(&self) -> usize {
        self.model.pairs.len()
    }
    fn pair_bodies(&self, pair: PairId) -> [Option<BodyId>; 2] {
        self.model.pair_bodies.get(pair.index()).copied().unwrap_or([None; 2])
    }
    fn pair_contact(&self, pair: PairId) -> PairContact {
        view::pair_contact(self, pair)
    }
    #[inline]
    fn touches(&self, pair: PairId) -> bool {
        view::touches(self, pair)
    }
}

impl<R: Precision> Rays for World<R> {
    fn cast(&self, origin: [f32; 3], direction: [f32; 3], range: f32) -> Option<Hit<BodyId>> {
        ray::cast(self, origin, direction, range)
    }
}

impl<R: Precision> Sight for World<R> {
    fn query_near(&self, from: [f32; 2], range: f32, tell: &mut dyn FnMut(NearbySurface<BodyId>)) {
        sight::query_near(self, from, range, tell);
    }
    fn cast_planar(
        &self,
        from: [f32; 2],
        direction: [f32; 2],
        range: f32,
        but: Option<BodyId>,
    ) -> Option<PlanarHit<BodyId>> {
        sight::cast_planar(self, from, direction, range, but)
    }
}

impl<R: Precision> Vision for World<R> {
    fn look(
        &self,
        from: [f32; 3],
        directions: &[[f32; 3]],
        range: f32,
        but: Option<BodyId>,
        seen: &mut [Option<Seen<BodyId>>],
    ) {
        vision::look(self, from, directions, range, but, seen);
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
            *x = R::from_f64(f64::from(*f));
        }
        self.forces.clear();
        self.finish_placement();
    }
}

impl<R: Precision> Arrange for World<R> {
    fn clear(&mut self) {
        self.state.copy_from_slice(&self.model.initial);
        self.forces.clear();
        self.finish_placement();
    }

    fn place_joint(&mut self, joint: JointId, position: f32, speed: f32) {
        view::place_joint(self, joint, position, speed);
    }
    fn place_body(&mut self, body: BodyId, pose: Pose, twist: Twist) {
        view::place_body(self, body, pose, twist);
    }
    fn finish_placement(&mut self) {
        R::forward_kinematics(&self.model, &self.state, &mut self.scratch);
    }
}
