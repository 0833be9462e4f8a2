//! A single planar world.

use alloc::vec;
use alloc::vec::Vec;

use farsa_body::ports::{
    Actuated, ActuatorId, Arrange, BodyId, Contacts, Handles, Hit, JointId, Joints, Kinematics, Lamp, NearbySurface,
    PairContact, PairId, Planar, PlanarHit, Rays, Sight, Snapshot,
};
use farsa_body::robots::MobileParts;
use farsa_body::{Pose, Twist};

use crate::arena::crowd::Crowd;
use crate::arena::description::Arena;
use crate::arena::error::ArenaError;
use crate::arena::infrared::ring_among;
use crate::arena::model::Model;
use crate::arena::step::{WORK_WORDS, step};
use crate::arena::view::{self as view, View};

/// A single planar world. It is kinematic, so wheels do exactly what is commanded.
///
/// - *Motion*: along an arc about the instantaneous center of rotation, exactly. Wheel commands are clamped to the
///   robot's greatest wheel speed, and NaN stops a wheel. LEDs and signals are visible from the next step on. Wheels
///   turn even if the motion is undone. Their positions wrap around at +-16 turns.
/// - *Collisions*: [`CollisionRule`](crate::arena::CollisionRule). A robot that was set back is reported at rest.
/// - *Contacts*: pair `r` is robot `r` and the body of its deepest overlap in the last step, before that was undone or
///   pushed apart, with a nominal normal force of 1 N. `None` is a wall, or nothing where it does not touch.
/// - *Attachment*: while its command is above 0.5, a device attaches to the nearest robot straight ahead within reach
///   of its hull, and keeps it. Attached robots move as one rigid body, by the least-squares fit to the velocities of
///   their wheels, and are returned together. Each chassis turns by its own wheels.
/// - *Arranging*: a body keeps its place and heading of a pose, nothing else. It is at rest, and no longer held. A
///   robot that is put into something stays there until it is put in other places.
///
/// If you use a handle that does not exist, it reads as zero, and commands to it have no effect. Since a world is
/// `Sync`, you can read the sensors of many robots in threads.
#[derive(Clone, Debug)]
pub struct World {
    model: Model,
    words: Vec<f32>,
    work: Vec<f32>,
    crowd: Crowd,
}

impl World {
    /// Creates a world in the initial state of its description.
    ///
    /// # Errors
    /// The first thing that is wrong with the description.
    pub fn new(arena: &Arena) -> Result<Self, ArenaError> {
        let model = Model::new(arena)?;
        let words = model.initial.clone();
        let work = vec![0.0; WORK_WORDS * model.robots.len()];
        let mut crowd = Crowd::new(&model, arena.size);
        crowd.fill(&words);
        Ok(Self { model, words, work, crowd })
    }

    /// Number of robots in the world.
    pub fn robots(&self) -> usize {
        self.model.robots.len()
    }

    /// Gets the numbers of the parts of a robot. If there is no such robot, the parts of the last one are returned.
    pub fn parts(&self, robot: usize) -> MobileParts {
        self.model.parts(robot)
    }

    /// Readings of a robot's ring of infrared sensors by
    /// [`InfraredModel`](farsa_body::sensors::infrared::InfraredModel). `out` [sensors].
    ///
    /// Reads the same values as a sensor through [`Sight::query_near`](farsa_body::ports::Sight::query_near), but faster, and in lanes, too: `Batch::infrared`. A
    /// shorter slice gets the first sensors.
    pub fn infrared(&self, robot: usize, out: &mut [f32]) {
        let robot = robot.min(self.robots() - 1);
        ring_among(&self.model, &self.words, robot, out, |[x, y], reach, tell| {
            view::in_order(self, [x - reach, y - reach], [x + reach, y + reach], tell);
        });
    }

    /// The state, to be changed. [`Arrange::finish_placement`] must follow.
    #[cfg(all(feature = "lanes", not(test)))]
    pub(crate) fn words_mut(&mut self) -> &mut [f32] {
        &mut self.words
    }

    #[cfg(all(feature = "lanes", not(test)))]
    pub(crate) fn words(&self) -> &[f32] {
        &self.words
    }
}

impl View for World {
    fn model(&self) -> &Model {
        &self.model
    }
    #[inline(always)]
    fn word(&self, index: usize) -> f32 {
        self.words[index]
    }
    #[inline(always)]
    fn set_word(&mut self, index: usize, x: f32) {
        self.words[index] = x;
    }
    #[inline(always)]
    fn visit(&self, low: [f32; 2], high: [f32; 2], tell: impl FnMut(usize)) {
        self.crowd.visit(&self.model, low, high, tell);
    }
    fn gridded(&self) -> bool {
        self.crowd.grid.is_some()
    }
}

impl farsa_body::ports::World for World {
    fn step(&mut self) {
        if self.crowd.grid.is_some() || view::holds(self) {
            self.crowd.step(&self.model, &mut self.words, &mut self.work);
        } else {
            step::<f32>((), &self.model, &mut self.words, &mut self.work);
        }
    }
    fn time_step(&self) -> f32 {
        self.model.time_step
    }
}

/// The ports of a world and of a lane, from their words.
macro_rules! ports {
    ($world:ty) => {
        impl Handles for $world {
            type Body = BodyId;
            type Joint = JointId;
            type Actuator = ActuatorId;
        }

        impl Kinematics for $world {
            fn pose(&self, body: BodyId) -> Pose {
                view::pose(self, body)
            }
            fn velocity(&self, body: BodyId) -> Twist {
                view::velocity(self, body)
            }
        }

        impl Joints for $world {
            #[inline]
            fn position(&self, joint: JointId) -> f32 {
                view::joint_position(self, joint)
            }
            #[inline]
            fn speed(&self, joint: JointId) -> f32 {
                view::joint_speed(self, joint)
            }
        }

        impl Actuated for $world {
            #[inline]
            fn command(&mut self, actuator: ActuatorId, value: [f32; 2]) {
                view::command(self, actuator, value[0]);
            }
        }

        impl Rays for $world {
            fn cast(&self, origin: [f32; 3], direction: [f32; 3], range: f32) -> Option<Hit<BodyId>> {
                view::cast(self, origin, direction, range)
            }
        }

        impl Contacts for $world {
            fn pairs(&self) -> usize {
                self.model().robots.len()
            }
            fn pair_bodies(&self, pair: PairId) -> [Option<BodyId>; 2] {
                view::pair_bodies(self, pair)
            }
            fn pair_contact(&self, pair: PairId) -> PairContact {
                view::pair_contact(self, pair)
            }
            #[inline]
            fn touches(&self, pair: PairId) -> bool {
                view::touches(self, pair)
            }
        }

        impl Sight for $world {
            fn query_near(&self, from: [f32; 2], range: f32, tell: &mut dyn FnMut(NearbySurface<BodyId>)) {
                view::query_near(self, from, range, tell);
            }
            fn cast_planar(
                &self,
                from: [f32; 2],
                direction: [f32; 2],
                range: f32,
                but: Option<BodyId>,
            ) -> Option<PlanarHit<BodyId>> {
                view::cast_planar(self, from, direction, range, but)
            }
        }

        impl Planar for $world {
            fn ground(&self, at: [f32; 2]) -> [f32; 3] {
                view::ground(self, at)
            }
            fn lamps(&self, tell: &mut dyn FnMut(Lamp<BodyId>)) {
                view::lamps(self, tell);
            }
            fn attached(&self, robot: BodyId) -> Option<BodyId> {
                view::attached(self, robot)
            }
        }

        impl Snapshot for $world {
            fn snapshot_len(&self) -> usize {
                self.model().len()
            }
            fn save(&self, out: &mut [f32]) {
                for (i, o) in out.iter_mut().take(self.snapshot_len()).enumerate() {
                    *o = self.word(i);
                }
            }
            fn restore(&mut self, from: &[f32]) {
                for (i, x) in from.iter().take(self.snapshot_len()).enumerate() {
                    self.set_word(i, *x);
                }
                self.finish_placement();
            }
        }
    };
}

#[cfg(all(feature = "lanes", not(test)))]
pub(crate) use ports;

ports!(World);

impl Arrange for World {
    fn clear(&mut self) {
        view::clear(self);
        self.finish_placement();
    }
    fn place_joint(&mut self, joint: JointId, position: f32, speed: f32) {
        view::place_joint(self, joint, position, speed);
    }
    fn place_body(&mut self, body: BodyId, pose: Pose, _: Twist) {
        view::place_body(self, body, pose);
    }
    fn finish_placement(&mut self) {
        self.crowd.fill(&self.words);
    }
}
