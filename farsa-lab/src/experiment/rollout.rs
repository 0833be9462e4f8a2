//! An episode of a task.

use farsa_body::Recorder;

use crate::experiment::evaluator::{Evaluation, Learner, Task};
use crate::experiment::outcome::Outcome;

/// Episode of a task. It loads parameters before the start, and has an outcome after the end.
pub trait Rollout: Task {
    /// Loads the parameters. Returns false if they do not fit the task.
    fn load(&mut self, evaluation: &Evaluation<'_>) -> bool;

    /// Records the parameters before the first step: those of a network, for the page's picture of it.
    fn record_parameters(&self, recorder: &mut dyn Recorder) {
        let _ = recorder;
    }

    /// Builds the outcome of the episode that has ended.
    fn outcome(&self) -> Outcome;

    /// Gives access to the training for the strategy [`Learning`](crate::strategy::Learning), if there is any.
    fn learner(&mut self) -> Option<&mut dyn Learner> {
        None
    }
}
