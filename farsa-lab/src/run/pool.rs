//! Trials on several threads, with results that no thread can be told from.

use std::cell::RefCell;
use std::sync::atomic::{AtomicBool, AtomicUsize, Ordering};
use std::thread;

use crate::error::Error;
use crate::experiment::evaluator::{Evaluation, Evaluator};
use crate::experiment::genotype::Genotype;
use crate::experiment::lanes::{Lanes, Wanted};
use crate::experiment::outcome::Outcome;
use crate::run::plan::Plan;

/// An experiment made ready for every thread.
pub(crate) struct Pool {
    /// At least one.
    evaluators: Vec<Box<dyn Evaluator>>,
    genotype: Genotype,
    lanes: Lanes,
}

/// Why a round has no results.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Unfinished {
    /// It was told to stop.
    Stopped,
    /// A trial panicked.
    Panicked,
}

impl Pool {
    /// A pool of at least one thread.
    ///
    /// # Errors
    /// [`Error::Usage`] for more lanes or other instructions than the machine or the experiment have.
    pub(crate) fn new(plan: &Plan<'_>, threads: usize, wanted: Wanted) -> Result<Self, Error> {
        let asked = wanted.on_this_machine()?;
        let mut evaluators = (0..threads.max(1)).map(|_| plan.evaluator()).collect::<Result<Vec<_>, _>>()?;
        let mut lanes = asked;
        for evaluator in &mut evaluators {
            match evaluator.in_lanes() {
                Some(in_lanes) => in_lanes.use_lanes(asked)?,
                None => lanes = Lanes::one(),
            }
        }
        let genotype = plan.genotype(evaluators[0].as_ref());
        if wanted.count.is_some_and(|count| count != lanes.count()) {
            let (name, only) = (plan.experiment.name(), lanes.count());
            return Err(Error::Usage(format!("--lanes {}: {name} has {only} only", asked.count())));
        }
        Ok(Self { evaluators, genotype, lanes })
    }

    /// Number of threads.
    pub(crate) fn threads(&self) -> usize {
        self.evaluators.len()
    }

    /// What every thread evaluates with.
    pub(crate) fn lanes(&self) -> Lanes {
        self.lanes
    }

    /// How genes stand for the experiment's parameters.
    pub(crate) fn genotype(&self) -> &Genotype {
        &self.genotype
    }

    /// The experiment as the first thread has it.
    pub(crate) fn evaluator(&self) -> &dyn Evaluator {
        self.evaluators[0].as_ref()
    }

    /// Runs `count` evaluations, each on the thread that is free first, and returns the outcomes in their order.
    ///
    /// `task` makes the evaluation of a number, or says that it is not needed any more; `done` hears of every number.
    pub(crate) fn evaluate<'g>(
        &mut self,
        count: usize,
        stop: &AtomicBool,
        task: impl Fn(usize) -> Option<Evaluation<'g>> + Sync,
        done: impl Fn(usize, Option<&Outcome>) + Sync,
    ) -> Result<Vec<Option<Outcome>>, Unfinished> {
        let drawn = AtomicUsize::new(0);
        let busy = |evaluator: &mut dyn Evaluator| {
            // Two closures of one evaluator write here in turn.
            let results = RefCell::new(Vec::new());
            let put = |number: usize, outcome: Option<Outcome>| {
                done(number, outcome.as_ref());
                results.borrow_mut().push((number, outcome));
            };
            let mut next = || {
                while !stop.load(Ordering::Relaxed) {
                    let number = drawn.fetch_add(1, Ordering::Relaxed);
                    if number >= count {
                        break;
                    }
                    match task(number) {
                        None => put(number, None),
                        task => return task,
                    }
                }
                None
            };
            match evaluator.in_lanes() {
                Some(lanes) => lanes.evaluate_all(&mut next, &mut |number, outcome| put(number, Some(outcome))),
                None => {
                    while let Some(evaluation) = next() {
                        put(evaluation.number, Some(evaluator.evaluate(evaluation, None)));
                    }
                }
            }
            results.into_inner()
        };
        let busy = &busy;
        let mut results: Vec<(usize, Option<Outcome>)> = thread::scope(|scope| {
            let threads: Vec<_> =
                self.evaluators.iter_mut().map(|evaluator| scope.spawn(move || busy(evaluator.as_mut()))).collect();
            let joined: Vec<_> = threads.into_iter().map(thread::ScopedJoinHandle::join).collect();
            joined.into_iter().collect::<Result<Vec<_>, _>>()
        })
        .map_err(|_| Unfinished::Panicked)?
        .into_iter()
        .flatten()
        .collect();
        if results.len() < count {
            return Err(Unfinished::Stopped);
        }
        results.sort_unstable_by_key(|(number, _)| *number);
        Ok(results.into_iter().map(|(_, result)| result).collect())
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::experiment::episode::EpisodeId;
    use crate::experiment::evaluator::{Parameter, Task};
    use crate::experiment::outcome::Description;
    use farsa_body::Recorder;
    use farsa_view::Schema;

    /// Earns its individual's number and panics from the fifth on, if asked to by its parameter.
    struct Nothing;

    impl Task for Nothing {
        fn parameters(&self) -> Vec<Parameter> {
            vec![Parameter::new("panic", [0.0, 1.0])]
        }
        fn schema(&self) -> Schema {
            Schema::default()
        }
        fn description(&self) -> Description {
            Description::default()
        }
    }

    impl Evaluator for Nothing {
        fn evaluate(&mut self, evaluation: Evaluation<'_>, _: Option<&mut dyn Recorder>) -> Outcome {
            assert!(evaluation.parameters[0] == 0.0 || evaluation.id.individual < 5);
            Outcome { steps: evaluation.id.individual, ..Outcome::default() }
        }
    }

    fn pool(threads: usize) -> Pool {
        let evaluators = (0..threads).map(|_| Box::new(Nothing) as Box<dyn Evaluator>).collect();
        Pool { evaluators, genotype: Genotype::new(&Nothing.parameters(), 1), lanes: Lanes::one() }
    }

    fn task(number: usize, parameters: &[f32]) -> Evaluation<'_> {
        let id = EpisodeId { individual: number as u32, ..EpisodeId::default() };
        Evaluation { number, parameters, opponents: &[], id }
    }

    #[test]
    fn results_stand_in_the_order_of_the_work() {
        for threads in 1..4 {
            let heard = AtomicUsize::new(0);
            let some = |number| (number % 7 != 3).then(|| task(number, &[0.0]));
            let done = |_, _: Option<&Outcome>| {
                heard.fetch_add(1, Ordering::Relaxed);
            };
            let Ok(results) = pool(threads).evaluate(50, &AtomicBool::new(false), some, done) else { panic!() };
            assert_eq!(heard.into_inner(), 50);
            for (number, result) in results.iter().enumerate() {
                assert_eq!(result.as_ref().map(|outcome| outcome.steps), (number % 7 != 3).then_some(number as u32));
            }
        }
    }

    #[test]
    fn a_stop_or_a_panic_leaves_no_results() {
        let stop = AtomicBool::new(false);
        let done = |number, _: Option<&Outcome>| {
            stop.fetch_or(number == 7, Ordering::Relaxed);
        };
        let stopped = pool(2).evaluate(50, &stop, |number| Some(task(number, &[0.0])), done);
        assert!(matches!(stopped, Err(Unfinished::Stopped)));
        let panicked = pool(2).evaluate(9, &AtomicBool::new(false), |number| Some(task(number, &[1.0])), |_, _| {});
        assert!(matches!(panicked, Err(Unfinished::Panicked)));
    }
}
