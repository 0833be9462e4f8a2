//! A single world of a batch.

use alloc::vec::Vec;

use farsa_body::ports::{
    Actuated, ActuatorId, Arrange, BodyId, Contacts, Handles, Hit, JointId, Joints, Kinematics, NearbySurface,
    PairContact, PairId, PlanarHit, Rays, Seen, Sight, Snapshot, Vision,
};
use farsa_body::{Pose, Twist};

use crate::articulated::link::LinkData;
use crate::articulated::model::{Model, Pair};
use crate::articulated::ray;
use crate::articulated::sight;
use crate::articulated::spatial::{Matrix, Spatial, Vector};
use crate::articulated::step::{Precision, Scratch};
use crate::articulated::view::{self, View, is_touching};
use crate::articulated::vision;

/// Words that the ports read of a link: rotation, position, reference point, velocity.
pub(crate) const LINK_WORDS: usize = 21;

/// The words for the ports of all lanes: one word of every lane, then the next word of every lane.
#[derive(Clone, Debug)]
pub(crate) struct Words {
    pub(crate) lanes: usize,
    /// [`Model::state_len`] words.
    pub(crate) state: Vec<f32>,
    /// [`LINK_WORDS`] of each link.
    pub(crate) links: Vec<f32>,
    /// 1 for each pair that touches, else 0. A lane reads one word of a pair instead of one of each of its points.
    pub(crate) touching: Vec<f32>,
    /// True if more than commands was changed since the last step.
    pub(crate) arranged: bool,
    /// A world alone, to place the links of one lane.
    pub(crate) alone: (Vec<f32>, Scratch<f32>),
}

impl Words {
    pub(crate) fn new(model: &Model<f32>, lanes: usize) -> Self {
        let state = model.initial.iter().flat_map(|x| core::iter::repeat_n(*x, lanes)).collect();
        let links = alloc::vec![0.0; LINK_WORDS * model.links.len() * lanes];
        let alone = (model.initial.clone(), Scratch::new((), model));
        let touching = alloc::vec![0.0; model.pairs.len() * lanes];
        let mut words = Self { lanes, state, links, touching, arranged: true, alone };
        (0..lanes).for_each(|lane| words.place(model, lane));
        words
    }

    /// The state of one lane.
    pub(crate) fn load(&self, lane: usize, state: &mut [f32]) {
        copy(state, lane_of(&self.state, lane, self.lanes));
    }

    /// The state of one lane, and where its links are.
    pub(crate) fn store(&mut self, model: &Model<f32>, lane: usize, state: &[f32], links: &[LinkData<f32>]) {
        self.set_state(lane, state);
        store_links(&mut self.links, lane, self.lanes, links);
        store_touching(&mut self.touching, model, lane, self.lanes, state);
    }

    /// Replaces the state of one lane.
    fn set_state(&mut self, lane: usize, state: &[f32]) {
        for (to, x) in self.state.iter_mut().skip(lane).step_by(self.lanes).zip(state) {
            *to = *x;
        }
    }

    /// Where the links of one lane are, from its state.
    fn place(&mut self, model: &Model<f32>, lane: usize) {
        let (state, scratch) = &mut self.alone;
        copy(state, lane_of(&self.state, lane, self.lanes));
        f32::forward_kinematics(model, state, scratch);
        store_links(&mut self.links, lane, self.lanes, &scratch.links);
        store_touching(&mut self.touching, model, lane, self.lanes, state);
    }
}

/// Which pairs touch in one lane, from its state.
fn store_touching(words: &mut [f32], model: &Model<f32>, lane: usize, lanes: usize, state: &[f32]) {
    let to = words.iter_mut().skip(lane).step_by(lanes);
    for (to, pair) in to.zip(&model.pairs) {
        *to = f32::from(is_touching(model, pair, state));
    }
}

/// The words of one lane.
fn lane_of(words: &[f32], lane: usize, lanes: usize) -> impl Iterator<Item = &f32> {
    words.iter().skip(lane).step_by(lanes)
}

fn copy<'a>(to: &mut [f32], from: impl Iterator<Item = &'a f32>) {
    for (to, x) in to.iter_mut().zip(from) {
        *to = *x;
    }
}

fn store_links(words: &mut [f32], lane: usize, lanes: usize, links: &[LinkData<f32>]) {
    let to = words.iter_mut().skip(lane).step_by(lanes);
    for (to, x) in to.zip(links.iter().flat_map(link_words)) {
        *to = x;
    }
}

fn link_words(w: &LinkData<f32>) -> [f32; LINK_WORDS] {
    let [[a, b, c], [d, e, f], [g, h, i]] = w.rotation;
    let [[x, y, z], [u, v, n], [k, l, m], [o, p, q]] = [w.position, w.reference, w.velocity.angular, w.velocity.linear];
    [a, b, c, d, e, f, g, h, i, x, y, z, u, v, n, k, l, m, o, p, q]
}

/// A single world of a [`Batch`](crate::articulated::Batch). It has the same ports as a
/// [`World`](crate::articulated::World), except that it cannot be stepped alone.
///
/// Changes to it affect no other lane.
#[derive(Debug)]
pub struct Lane<'a> {
    pub(crate) model: &'a Model<f32>,
    pub(crate) words: &'a mut Words,
    pub(crate) index: usize,
}

impl Lane<'_> {
    /// Gets the model that all worlds of the batch share.
    pub fn model(&self) -> &Model<f32> {
        self.model
    }

    fn link<const N: usize>(&self, link: usize, first: usize) -> [f32; N] {
        let at = (LINK_WORDS * link + first) * self.words.lanes + self.index;
        core::array::from_fn(|k| self.words.links[at + k * self.words.lanes])
    }

    fn link_matrix(&self, link: usize) -> Matrix<f32> {
        let [a, b, c, d, e, f, g, h, i] = self.link(link, 0);
        [[a, b, c], [d, e, f], [g, h, i]]
    }
}

impl View<f32> for Lane<'_> {
    fn model(&self) -> &Model<f32> {
        self.model
    }
    #[inline]
    fn word(&self, index: usize) -> f32 {
        self.words.state[index * self.words.lanes + self.index]
    }
    #[inline]
    fn touching(&self, index: usize, _pair: &Pair<f32>) -> bool {
        self.words.touching[index * self.words.lanes + self.index] > 0.0
    }
    #[inline]
    fn set_word(&mut self, index: usize, x: f32) {
        self.words.state[index * self.words.lanes + self.index] = x;
    }
    fn link_frame(&self, link: usize) -> (Matrix<f32>, Vector<f32>) {
        (self.link_matrix(link), self.link(link, 9))
    }
    #[inline]
    fn link_position(&self, link: usize) -> Vector<f32> {
        self.link(link, 9)
    }
    fn motion(&self, link: usize) -> (Spatial<f32>, Vector<f32>) {
        (Spatial { angular: self.link(link, 15), linear: self.link(link, 18) }, self.link(link, 12))
    }
}

impl Handles for Lane<'_> {
    type Body = BodyId;
    type Joint = JointId;
    type Actuator = ActuatorId;
}

impl Kinematics for Lane<'_> {
    fn pose(&self, body: BodyId) -> Pose {
        view::pose(self, body)
    }
    fn origin(&self, body: BodyId) -> [f32; 3] {
        view::origin(self, body)
    }
    fn velocity(&self, body: BodyId) -> Twist {
        view::velocity(self, body)
    }
}

impl Joints for Lane<'_> {
    #[inline]
    fn position(&self, joint: JointId) -> f32 {
        view::joint_position(self, joint)
    }
    #[inline]
    fn speed(&self, joint: JointId) -> f32 {
        view::joint_speed(self, joint)
    }
}

impl Actuated for Lane<'_> {
    #[inline]
    fn command(&mut self, actuator: ActuatorId, value: [f32; 2]) {
        view::command(self, actuator.index(), value);
    }
}

impl Contacts for Lane<'_> {
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

impl Rays for Lane<'_> {
    fn cast(&self, origin: [f32; 3], direction: [f32; 3], range: f32) -> Option<Hit<BodyId>> {
        ray::cast(self, origin, direction, range)
    }
}

impl Sight for Lane<'_> {
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

impl Vision for Lane<'_> {
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

impl Snapshot for Lane<'_> {
    fn snapshot_len(&self) -> usize {
        self.model.state_len()
    }
    fn save(&self, out: &mut [f32]) {
        for (i, o) in out.iter_mut().take(self.snapshot_len()).enumerate() {
            *o = self.word(i);
        }
    }
    fn restore(&mut self, from: &[f32]) {
        self.words.set_state(self.index, from);
        self.finish_placement();
    }
}

impl Arrange for Lane<'_> {
    fn clear(&mut self) {
        self.words.set_state(self.index, &self.model.initial);
        self.finish_placement();
    }
    fn place_joint(&mut self, joint: JointId, position: f32, speed: f32) {
        view::place_joint(self, joint, position, speed);
        self.words.arranged = true;
    }
    fn place_body(&mut self, body: BodyId, pose: Pose, twist: Twist) {
        view::place_body(self, body, pose, twist);
        self.words.arranged = true;
    }
    fn finish_placement(&mut self) {
        self.words.place(self.model, self.index);
        self.words.arranged = true;
    }
}
