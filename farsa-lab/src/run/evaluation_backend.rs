//! Who evaluates a generation: the threads and ranks of a run, or the workers of a page.

use crate::error::Error;
use crate::experiment::evaluator::{Evaluation, Evaluator, TaskInfo};
use crate::experiment::genotype::Genotype;
use crate::experiment::outcome::Outcome;

/// The evaluation of a number, or nothing if it is not needed any more.
pub(crate) type TaskOf<'t, 'g> = dyn Fn(usize) -> Option<Evaluation<'g>> + Sync + 't;
/// Who hears of every number that has ended.
pub(crate) type Heard<'t> = dyn Fn(usize, Option<&Outcome>) + Sync + 't;

/// Evaluates what a generation consists of.
pub(crate) trait EvaluationBackend {
    /// The experiment.
    fn evaluator(&self) -> &dyn Evaluator;

    /// The data of the task.
    fn info(&self) -> &TaskInfo;

    /// How genes stand for the experiment's parameters.
    fn genotype(&self) -> &Genotype;

    /// The outcomes of `count` evaluations, in their order.
    ///
    /// # Errors
    /// [`Unfinished`] where there are fewer: nothing then comes of the generation.
    fn evaluate(
        &mut self,
        count: usize,
        task: &TaskOf<'_, '_>,
        done: &Heard<'_>,
    ) -> Result<Vec<Option<Outcome>>, Unfinished>;

    /// Compares with others who evaluate the same, by its fingerprint.
    fn compare(&self, _generation: u32, _fingerprint: &dyn Fn() -> u64) {}
}

/// Why a round has no results.
#[derive(Debug)]
pub(crate) enum Unfinished {
    /// It was told to stop.
    Stopped,
    /// There is no thread, or no evaluator after a panic.
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

/// Evaluates until `next` has no more, in lanes if there are any.
pub(crate) fn round<'g>(
    evaluator: &mut dyn Evaluator,
    next: &mut dyn FnMut() -> Option<Evaluation<'g>>,
    end: &mut dyn FnMut(usize, Outcome),
) {
    if let Some(lanes) = evaluator.in_lanes() {
        return lanes.evaluate_all(next, end);
    }
    while let Some(evaluation) = next() {
        end(evaluation.number, evaluator.evaluate(evaluation, None));
    }
}
