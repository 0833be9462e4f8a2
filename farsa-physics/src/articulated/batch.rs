//! Many articulated worlds of one model that are stepped together in SIMD lanes.

use alloc::boxed::Box;
use core::fmt;
use farsa_num::Instructions;

use crate::articulated::lane::{Lane, Words};
use crate::articulated::lockstep::{self, LANES, Lockstep};
use crate::articulated::model::{Model, ModelError};

/// Many worlds of one model, one in each lane of SIMD vectors. All of them start in the initial state of the
/// description.
///
/// Each world has exactly the same bits as a [`World`](crate::articulated::World) that is arranged, commanded and
/// stepped in the same way. This does not depend on its neighbors.
///
/// ```
/// use farsa_body::Pose;
/// use farsa_body::ports::{Arrange, JointId, Joints};
/// use farsa_body::robot::{Joint, MassProperties, Robot, Segment};
/// use farsa_num::Instructions;
/// use farsa_physics::articulated::{Batch, Model, Options};
///
/// let mut pendulum = Robot::new("pendulum");
/// let joint = Joint::revolute("pivot", [0.0, 1.0, 0.0], Pose::identity(), [-4.0, 4.0]);
/// let rod = MassProperties { centre: [0.0, 0.0, -0.5], ..MassProperties::sphere(1.0, 0.1) };
/// pendulum.add_segment(Segment::new("rod", None, joint, rod));
/// let mut batch = Batch::new(Model::new(&pendulum, &Options::default())?, 8, Instructions::baseline())?;
/// for i in 0..8 {
///     let mut lane = batch.lane(i);
///     lane.place_joint(JointId(0), 0.1 * i as f32, 0.0);
///     lane.finish_placement();
/// }
/// batch.step();
/// assert_eq!(batch.lane(0).position(JointId(0)), 0.0);
/// assert!(batch.lane(5).position(JointId(0)) < 0.5);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
pub struct Batch {
    model: Model<f32>,
    words: Words,
    lockstep: Box<dyn Lockstep>,
}

impl Batch {
    /// Creates `lanes` worlds that are stepped with the given instructions. Their number must be one of [`LANES`].
    ///
    /// If the instructions are not in [`Batch::instructions`], the best ones below them are used. You can use
    /// [`Instructions::Fallback`] on every machine, which steps one world after the other.
    ///
    /// # Errors
    /// Returns [`ModelError::Lanes`] for another number of worlds.
    pub fn new(model: Model<f32>, lanes: usize, instructions: Instructions) -> Result<Self, ModelError> {
        if !LANES.contains(&lanes) {
            let nearest = LANES.into_iter().min_by_key(|count| count.abs_diff(lanes)).unwrap_or(LANES[0]);
            return Err(ModelError::Lanes { lanes, nearest });
        }
        let words = Words::new(&model, lanes);
        let lockstep = lockstep::lockstep(&model, lanes, instructions);
        Ok(Self { model, words, lockstep })
    }

    /// An iterator over the instruction sets of this machine that a batch can use, from the narrowest to the widest.
    ///
    /// On x86-64 SSE2, AVX2 and AVX-512, as far as [`Instructions::available`] has them.
    pub fn instructions() -> impl Iterator<Item = Instructions> {
        lockstep::instructions()
    }

    /// Number of worlds in the batch.
    pub fn lanes(&self) -> usize {
        self.words.lanes
    }

    /// Gets the model that all worlds share.
    pub fn model(&self) -> &Model<f32> {
        &self.model
    }

    /// Gets one of the worlds. If the index is out of range, this is the last world. Note that relying on this is a
    /// mistake.
    #[inline]
    pub fn lane(&mut self, index: usize) -> Lane<'_> {
        debug_assert!(index < self.words.lanes, "lane {index} of {}", self.words.lanes);
        Lane { index: index.min(self.words.lanes - 1), model: &self.model, words: &mut self.words }
    }

    /// Advances every world by one control step.
    pub fn step(&mut self) {
        self.lockstep.step(&self.model, &mut self.words);
    }
}

impl Clone for Batch {
    fn clone(&self) -> Self {
        // The memory of the steps is in the words, so that a reload restores it.
        let words = Words { arranged: true, ..self.words.clone() };
        Self { model: self.model.clone(), words, lockstep: self.lockstep.boxed_clone() }
    }
}

impl fmt::Debug for Batch {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_struct("Batch").field("model", &self.model).field("words", &self.words).finish_non_exhaustive()
    }
}
