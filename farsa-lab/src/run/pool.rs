//! Lives on several threads, with results that no thread can be told from.

use std::cell::RefCell;
use std::sync::atomic::{AtomicBool, AtomicUsize, Ordering};
use std::thread;

use crate::error::Error;
use crate::experiment::definition::{Outcome, Setup, Task};
use crate::experiment::lanes::{Lanes, Wanted};
use crate::run::plan::Plan;

/// An experiment made ready for every thread.
pub(crate) struct Pool {
    /// At least one.
    setups: Vec<Box<dyn Setup>>,
    lanes: Lanes,
}

/// Why a round has no results.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Unfinished {
    /// It was told to stop.
    Stopped,
    /// A life panicked.
    Panicked,
}

impl Pool {
    /// A pool of at least one thread.
    ///
    /// # Errors
    /// [`Error::Usage`] for more lanes or other instructions than the machine or the experiment have.
    pub(crate) fn new(plan: &Plan<'_>, threads: usize, wanted: Wanted) -> Result<Self, Error> {
        let asked = wanted.on_this_machine()?;
        let mut setups = (0..threads.max(1)).map(|_| plan.setup()).collect::<Result<Vec<_>, _>>()?;
        let mut lanes = asked;
        for setup in &mut setups {
            lanes = setup.use_lanes(asked)?;
        }
        if wanted.count.is_some_and(|count| count != lanes.count()) {
            let (name, only) = (plan.experiment.name(), lanes.count());
            return Err(Error::Usage(format!("--lanes {}: {name} has {only} only", asked.count())));
        }
        Ok(Self { setups, lanes })
    }

    /// Number of threads.
    pub(crate) fn threads(&self) -> usize {
        self.setups.len()
    }

    /// What every thread lives its lives in.
    pub(crate) fn lanes(&self) -> Lanes {
        self.lanes
    }

    /// The experiment as the first thread has it.
    pub(crate) fn setup(&self) -> &dyn Setup {
        self.setups[0].as_ref()
    }

    /// The same, to take a lesson.
    pub(crate) fn setup_mut(&mut self) -> &mut dyn Setup {
        self.setups[0].as_mut()
    }

    /// Lives `count` tasks, each on the thread that is free first, and returns what came of them in their order.
    ///
    /// `task` makes the task of a number, or says that it need not be lived any more; `done` hears of every number.
    pub(crate) fn live<'g>(
        &mut self,
        count: usize,
        stop: &AtomicBool,
        task: impl Fn(usize) -> Option<Task<'g>> + Sync,
        done: impl Fn(usize, Option<&Outcome>) + Sync,
    ) -> Result<Vec<Option<Outcome>>, Unfinished> {
        let drawn = AtomicUsize::new(0);
        let busy = |setup: &mut dyn Setup| {
            // Two closures of one life write here in turn.
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
            setup.live_many(&mut next, &mut |number, outcome| put(number, Some(outcome)));
            results.into_inner()
        };
        let busy = &busy;
        let mut results: Vec<(usize, Option<Outcome>)> = thread::scope(|scope| {
            let threads: Vec<_> =
                self.setups.iter_mut().map(|setup| scope.spawn(move || busy(setup.as_mut()))).collect();
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
    use crate::experiment::definition::{Description, Tape};
    use crate::experiment::life::Job;
    use farsa_view::Stage;

    /// Earns its individual's number and panics from the fifth on, if asked to by a gene.
    struct Nothing;

    impl Setup for Nothing {
        fn genes(&self) -> usize {
            1
        }
        fn stage(&self) -> Stage {
            Stage::default()
        }
        fn description(&self) -> Description {
            Description::default()
        }
        fn live(&mut self, genes: &[u16], job: Job, _: &mut Tape<'_>) -> Outcome {
            assert!(genes[0] == 0 || job.individual < 5);
            Outcome { steps: job.individual, ..Outcome::default() }
        }
    }

    fn pool(threads: usize) -> Pool {
        Pool { setups: (0..threads).map(|_| Box::new(Nothing) as Box<dyn Setup>).collect(), lanes: Lanes::one() }
    }

    fn task(number: usize, genes: &[u16]) -> Task<'_> {
        Task { number, genes, opponents: &[], job: Job { individual: number as u32, ..Job::default() } }
    }

    #[test]
    fn results_stand_in_the_order_of_the_work() {
        for threads in 1..4 {
            let heard = AtomicUsize::new(0);
            let some = |number| (number % 7 != 3).then(|| task(number, &[0]));
            let done = |_, _: Option<&Outcome>| {
                heard.fetch_add(1, Ordering::Relaxed);
            };
            let Ok(results) = pool(threads).live(50, &AtomicBool::new(false), some, done) else { panic!() };
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
        let stopped = pool(2).live(50, &stop, |number| Some(task(number, &[0])), done);
        assert!(matches!(stopped, Err(Unfinished::Stopped)));
        let panicked = pool(2).live(9, &AtomicBool::new(false), |number| Some(task(number, &[1])), |_, _| {});
        assert!(matches!(panicked, Err(Unfinished::Panicked)));
    }
}
