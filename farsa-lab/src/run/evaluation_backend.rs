//! Interface to what evaluates a generation: the threads and ranks of a run, or the workers of a page.

use crate::error::Error;
use crate::experiment::evaluator::{Evaluation, Evaluator, TaskInfo};
use crate::experiment::genotype::Genotype;
use crate::experiment::outcome::Outcome;

/// A function that returns the evaluation of a number, or `None` if it is not needed.
pub(crate) type TaskOf<'t, 'g> = dyn Fn(usize) -> Option<Evaluation<'g>> + Sync + 't;
/// A function that is called after each evaluation.
pub(crate) type Heard<'t> = dyn Fn(usize, Option<&Outcome>) + Sync + 't;

/// A backend that runs the evaluations of a generation.
pub(crate) trait EvaluationBackend {
    /// Gets the experiment.
    fn evaluator(&self) -> &dyn Evaluator;

    /// Gets the data of the task.
    fn info(&self) -> &TaskInfo;

    /// Gets the genotype of the experiment's parameters.
    fn genotype(&self) -> &Genotype;

    /// Runs `count` evaluations and returns the outcomes in order.
    ///
    /// # Errors
    /// [`Unfinished`] if some are missing. The generation is then discarded.
    fn evaluate(
        &mut self,
        count: usize,
        task: &TaskOf<'_, '_>,
        done: &Heard<'_>,
    ) -> Result<Vec<Option<Outcome>>, Unfinished>;

    /// Compares the fingerprint of a generation with those of other ranks.
    fn compare(&self, _generation: u32, _fingerprint: &dyn Fn() -> u64) {}
}

/// Reason for a round without results.
#[derive(Debug)]
pub(crate) enum Unfinished {
    /// A stop was requested.
    Stopped,
    /// A thread could not start, or an evaluator could not be prepared after a panic.
    Error(Error),
}

impl From<Error> for Unfinished {
    fn from(error: Error) -> Self {
        Self::Error(error)
    }
}

impl From<Unfinished> for Error {
    fn from(reason: Unfinished) -> Self {
        match reason {
            Unfinished::Stopped => Self::Other("stopped".into()),
            Unfinished::Error(error) => error,
        }
    }
}

/// Runs evaluations until `next` returns none, in lanes if there are any.
pub(crate) fn round<'g>(
    evaluator: &mut dyn Evaluator,
    next: &mut dyn FnMut() -> Option<Evaluation<'g>>,
    end: &mut dyn FnMut(usize, Outcome),
) {
    if let Some(lanes) = evaluator.in_lanes() {
        return lanes.run_in_lanes(next, end);
    }
    while let Some(evaluation) = next() {
        end(evaluation.number, evaluator.evaluate(evaluation, None));
    }
}
