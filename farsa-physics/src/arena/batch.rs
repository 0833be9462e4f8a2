//! Many planar worlds of one arena that are stepped together in SIMD lanes.

use alloc::boxed::Box;
use alloc::vec;
use alloc::vec::Vec;
use core::fmt;
use farsa_num::Instructions;

use farsa_body::ports::{
    Actuated, ActuatorId, Arrange, BodyId, Contacts, Handles, Hit, JointId, Joints, Kinematics, Lamp, NearbySurface,
    PairContact, PairId, Planar, PlanarHit, Rays, Sight, Snapshot, World as _,
};
use farsa_body::robots::MobileParts;
use farsa_body::{Pose, Twist};

use crate::arena::description::Arena;
use crate::arena::error::ArenaError;
use crate::arena::infrared::ring;
use crate::arena::lockstep::{self as lockstep, Lockstep};
use crate::arena::model::Model;
use crate::arena::step::WORK_WORDS;
use crate::arena::view::{self as view, View};
use crate::arena::world::{World, ports};
use crate::articulated::lockstep::LANES;

/// Many worlds of one arena, one in each lane of SIMD vectors. All of them start in the initial state of the
/// description.
///
/// Each world has exactly the same bits as a [`World`] with the same arrangement and commands, regardless of its
/// neighbors. Since a batch examines every body and has no grid, it is best for arenas with a few robots. While an
/// attachment device holds or its command is on in any lane, lanes are stepped one by one.
///
/// ```
/// use farsa_body::ports::{Actuated, Kinematics};
/// use farsa_body::robots::MobileRobot;
/// use farsa_num::Instructions;
/// use farsa_physics::arena::{Arena, Batch};
///
/// let mut arena = Arena::walled(0.4, 0.4);
/// arena.add_robot(MobileRobot::khepera(), [0.1, 0.2], 0.0);
/// let mut batch = Batch::new(&arena, 8, Instructions::baseline())?;
/// let parts = batch.parts(0);
/// for i in 0..8 {
///     parts.motors.map(|motor| batch.lane(i).command(motor, [i as f32, 0.0]));
/// }
/// batch.step();
/// assert_eq!(batch.lane(0).pose(parts.body).position[0], 0.1);
/// assert!(batch.lane(5).pose(parts.body).position[0] > 0.103);
/// # Ok::<(), farsa_physics::arena::ArenaError>(())
/// ```
pub struct Batch {
    /// A world alone, for what lanes do one by one.
    alone: World,
    lanes: usize,
    /// One word of every lane, then the next word of every lane.
    words: Vec<f32>,
    work: Vec<f32>,
    /// None where there are no vectors: lanes are then stepped one by one.
    lockstep: Option<Box<dyn Lockstep>>,
    /// The readings of one lane, where there are no vectors.
    ring: Vec<f32>,
}

impl Batch {
    /// Creates a batch of 8 or 16 worlds that are stepped with the given instructions. See
    /// [`crate::articulated::Batch::new`] for the choice of instructions.
    ///
    /// # Errors
    /// The fault of the description, or [`ArenaError::Lanes`] for another number of worlds.
    pub fn new(arena: &Arena, lanes: usize, instructions: Instructions) -> Result<Self, ArenaError> {
        if !LANES.contains(&lanes) {
            let nearest = LANES.into_iter().min_by_key(|count| count.abs_diff(lanes)).unwrap_or(LANES[0]);
            return Err(ArenaError::Lanes { lanes, nearest });
        }
        let alone = World::new(arena)?;
        let model = alone.model();
        let words = model.initial.iter().flat_map(|x| core::iter::repeat_n(*x, lanes)).collect();
        let work = vec![0.0; WORK_WORDS * model.robots.len() * lanes];
        let sensors = (0..model.robots.len()).map(|robot| model.kind(robot).infrared.len()).max();
        let ring = vec![0.0; sensors.unwrap_or(0)];
        Ok(Self { lanes, words, work, lockstep: lockstep::lockstep(lanes, instructions), ring, alone })
    }

    /// An iterator over the instruction sets of this machine that a batch can use, from the narrowest to the widest.
    pub fn instructions() -> impl Iterator<Item = Instructions> {
        crate::articulated::lockstep::instructions()
    }

    /// Number of worlds in the batch.
    pub fn lanes(&self) -> usize {
        self.lanes
    }

    /// Gets the numbers of the parts of a robot. If there is no such robot, the parts of the last one are returned.
    pub fn parts(&self, robot: usize) -> MobileParts {
        self.alone.parts(robot)
    }

    /// Gets one of the worlds. If the index is out of range, this is the last world. Note that relying on this is a
    /// mistake.
    #[inline]
    pub fn lane(&mut self, index: usize) -> Lane<'_> {
        debug_assert!(index < self.lanes, "lane {index} of {}", self.lanes);
        Lane { model: self.alone.model(), words: &mut self.words, lanes: self.lanes, index: index.min(self.lanes - 1) }
    }

    /// Sets the command of an actuator in every world [lanes].
    pub fn command(&mut self, actuator: ActuatorId, values: &[f32]) {
        let model = self.alone.model();
        debug_assert_eq!(values.len(), self.lanes, "a command for each lane");
        if actuator.index() < model.actuators {
            let first = (model.first_command() + actuator.index()) * self.lanes;
            for (word, x) in self.words[first..first + self.lanes].iter_mut().zip(values) {
                *word = *x;
            }
        }
    }

    /// Readings of a robot's ring of analytic infrared sensors in every world: [sensors x lanes], as
    /// [`World::infrared`] gives them in each. A shorter slice gets the first sensors.
    pub fn infrared(&mut self, robot: usize, out: &mut [f32]) {
        let robot = robot.min(self.alone.model().robots.len() - 1);
        if let Some(lockstep) = &self.lockstep {
            lockstep.infrared(self.alone.model(), &self.words, robot, out);
            return;
        }
        let sensors = self.alone.model().kind(robot).infrared.len().min(out.len() / self.lanes);
        for lane in 0..self.lanes {
            self.load(lane);
            let readings = &mut self.ring[..sensors];
            ring::<f32>((), self.alone.model(), self.alone.words(), robot, readings);
            out.iter_mut().skip(lane).step_by(self.lanes).zip(readings).for_each(|(to, x)| *to = *x);
        }
    }

    /// Advances every world by one control step.
    pub fn step(&mut self) {
        let attached = self.alone.model().attachments && (0..self.lanes).any(|lane| view::holds(&self.lane(lane)));
        match &self.lockstep {
            Some(lockstep) if !attached => lockstep.step(self.alone.model(), &mut self.words, &mut self.work),
            _ => self.step_one_by_one(),
        }
    }

    fn step_one_by_one(&mut self) {
        for lane in 0..self.lanes {
            self.load(lane);
            self.alone.finish_placement();
            self.alone.step();
            let words = self.words.iter_mut().skip(lane).step_by(self.lanes);
            words.zip(self.alone.words()).for_each(|(to, x)| *to = *x);
        }
    }

    /// Brings the words of one lane into the world alone.
    fn load(&mut self, lane: usize) {
        let words = self.words.iter().skip(lane).step_by(self.lanes);
        self.alone.words_mut().iter_mut().zip(words).for_each(|(x, from)| *x = *from);
    }
}

impl Clone for Batch {
    fn clone(&self) -> Self {
        Self {
            alone: self.alone.clone(),
            lanes: self.lanes,
            words: self.words.clone(),
            work: self.work.clone(),
            lockstep: self.lockstep.as_ref().map(|one| one.boxed_clone()),
            ring: self.ring.clone(),
        }
    }
}

impl fmt::Debug for Batch {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_struct("Batch").field("lanes", &self.lanes).field("words", &self.words).finish_non_exhaustive()
    }
}

/// A single world of a [`Batch`]. It has the same ports as a [`World`], except that it cannot be stepped alone.
///
/// Changes to it affect no other lane.
#[derive(Debug)]
pub struct Lane<'a> {
    model: &'a Model,
    words: &'a mut [f32],
    lanes: usize,
    index: usize,
}

impl Lane<'_> {
    /// Gets the numbers of the parts of a robot. If there is no such robot, the parts of the last one are returned.
    pub fn parts(&self, robot: usize) -> MobileParts {
        self.model.parts(robot)
    }
}

impl View for Lane<'_> {
    fn model(&self) -> &Model {
        self.model
    }
    #[inline(always)]
    fn word(&self, index: usize) -> f32 {
        self.words[index * self.lanes + self.index]
    }
    #[inline(always)]
    fn set_word(&mut self, index: usize, x: f32) {
        self.words[index * self.lanes + self.index] = x;
    }
    #[inline]
    fn visit(&self, _: [f32; 2], _: [f32; 2], tell: impl FnMut(usize)) {
        (0..self.model.round_bodies()).for_each(tell);
    }
    fn gridded(&self) -> bool {
        false
    }
}

ports!(Lane<'_>);

impl Arrange for Lane<'_> {
    fn clear(&mut self) {
        view::clear(self);
    }
    fn place_joint(&mut self, joint: JointId, position: f32, speed: f32) {
        view::place_joint(self, joint, position, speed);
    }
    fn place_body(&mut self, body: BodyId, pose: Pose, _: Twist) {
        view::place_body(self, body, pose);
    }
    fn finish_placement(&mut self) {}
}
