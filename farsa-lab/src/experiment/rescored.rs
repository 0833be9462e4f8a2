//! An experiment that there is, under another fitness.

use farsa_body::Recorder;

use crate::error::Error;
use crate::experiment::behavior::Behavior;
use crate::experiment::evaluator::{Bodies, Evaluation, Evaluator, Exports, InLanes, Learner, Task, TaskInfo};
use crate::experiment::lanes::Lanes;
use crate::experiment::outcome::{Combination, Outcome, mean_of_trials};

/// An evaluator that replaces the terms of all outcomes.
///
/// Everything else is taken from the inner evaluator, for example parameters, populations, lanes and exports. Fitness
/// is the sum of the terms, averaged over all trials.
pub struct Rescored {
    inner: Box<dyn Evaluator>,
    names: Vec<String>,
    score: Score,
}

/// Terms of an outcome.
type Score = Box<dyn Fn(&Outcome) -> Vec<f64> + Send>;

impl Rescored {
    /// Creates an evaluator with a different fitness. You need to pass the names of its terms, and a closure that
    /// computes the terms of an outcome.
    pub fn new<N: Into<String>>(
        inner: Box<dyn Evaluator>,
        names: impl IntoIterator<Item = N>,
        score: impl Fn(&Outcome) -> Vec<f64> + Send + 'static,
    ) -> Self {
        Self { inner, names: names.into_iter().map(Into::into).collect(), score: Box::new(score) }
    }
}

/// Replaces the terms of an outcome. A failed outcome stays failed.
fn rescore(score: &Score, outcome: Outcome) -> Outcome {
    if outcome.is_finite() { Outcome { terms: score(&outcome), ..outcome } } else { outcome }
}

impl Task for Rescored {
    fn info(&self) -> TaskInfo {
        TaskInfo { terms: self.names.clone(), combination: Some(Combination::Mean), ..self.inner.info() }
    }
    fn fitness(&self, trials: &[Outcome]) -> f64 {
        mean_of_trials(trials)
    }
    fn behavior(&self) -> Option<&dyn Behavior> {
        self.inner.behavior()
    }
    fn exports(&self) -> Option<&dyn Exports> {
        self.inner.exports()
    }
    fn bodies(&self) -> Option<&dyn Bodies> {
        self.inner.bodies()
    }
}

impl Evaluator for Rescored {
    fn evaluate(&mut self, evaluation: Evaluation<'_>, recorder: Option<&mut dyn Recorder>) -> Outcome {
        rescore(&self.score, self.inner.evaluate(evaluation, recorder))
    }

    fn record_start(&mut self, evaluation: Evaluation<'_>, recorder: &mut dyn Recorder) -> bool {
        self.inner.record_start(evaluation, recorder)
    }

    fn displaces(&self) -> bool {
        self.inner.displaces()
    }

    fn pushes(&self) -> bool {
        self.inner.pushes()
    }

    fn in_lanes(&mut self) -> Option<&mut dyn InLanes> {
        if self.inner.in_lanes().is_some() { Some(self) } else { None }
    }

    fn learner(&mut self) -> Option<&mut dyn Learner> {
        self.inner.learner()
    }
}

impl InLanes for Rescored {
    fn use_lanes(&mut self, lanes: Lanes) -> Result<(), Error> {
        self.inner.in_lanes().map_or(Ok(()), |inner| inner.use_lanes(lanes))
    }

    fn run_in_lanes<'p>(
        &mut self,
        next: &mut dyn FnMut() -> Option<Evaluation<'p>>,
        done: &mut dyn FnMut(usize, Outcome),
    ) {
        let Self { inner, score, .. } = self;
        if let Some(inner) = inner.in_lanes() {
            inner.run_in_lanes(next, &mut |number, outcome| done(number, rescore(score, outcome)));
        }
    }
}
