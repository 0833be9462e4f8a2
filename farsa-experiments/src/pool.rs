//! Lives on several threads, with results that no thread can be told from.

use std::sync::atomic::{AtomicBool, AtomicUsize, Ordering};
use std::thread;

use crate::error::Error;
use crate::experiment::Setup;
use crate::plan::Plan;

/// An experiment made ready for every thread.
pub(crate) struct Pool {
    setups: Vec<Box<dyn Setup>>,
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
    pub(crate) fn new(plan: &Plan<'_>, threads: usize) -> Result<Self, Error> {
        let setups = (0..threads.max(1)).map(|_| plan.setup()).collect::<Result<_, _>>()?;
        Ok(Self { setups })
    }

    /// Genes of a genome.
    pub(crate) fn genes(&self) -> usize {
        self.setups.first().map_or(0, |setup| setup.genes())
    }

    /// Does `count` pieces of work, each on the thread that is free first, and returns the results in their order.
    pub(crate) fn map<T: Send>(
        &mut self,
        count: usize,
        stop: &AtomicBool,
        work: impl Fn(&mut dyn Setup, usize) -> T + Sync,
    ) -> Result<Vec<T>, Unfinished> {
        let next = AtomicUsize::new(0);
        let busy = |setup: &mut dyn Setup| {
            let mut done = Vec::new();
            while !stop.load(Ordering::Relaxed) {
                let index = next.fetch_add(1, Ordering::Relaxed);
                if index >= count {
                    break;
                }
                done.push((index, work(setup, index)));
            }
            done
        };
        let busy = &busy;
        let mut results: Vec<(usize, T)> = thread::scope(|scope| {
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
        results.sort_unstable_by_key(|(index, _)| *index);
        Ok(results.into_iter().map(|(_, result)| result).collect())
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::experiment::{Description, Outcome, Tape};
    use crate::life::Job;
    use crate::stage::Stage;

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
        fn live(&mut self, _: &[u16], _: Job, _: &mut Tape<'_>) -> Outcome {
            Outcome::failed()
        }
    }

    fn pool(threads: usize) -> Pool {
        Pool { setups: (0..threads).map(|_| Box::new(Nothing) as Box<dyn Setup>).collect() }
    }

    #[test]
    fn results_stand_in_the_order_of_the_work() {
        for threads in 1..4 {
            let results = pool(threads).map(50, &AtomicBool::new(false), |_, index| index * index);
            let Ok(results) = results else { panic!() };
            assert_eq!(results, (0..50).map(|index| index * index).collect::<Vec<_>>());
        }
    }

    #[test]
    fn a_stop_or_a_panic_leaves_no_results() {
        let stop = AtomicBool::new(false);
        let stopped = pool(2).map(50, &stop, |_, index| stop.fetch_or(index == 7, Ordering::Relaxed));
        assert!(matches!(stopped, Err(Unfinished::Stopped)));
        let panicked = pool(2).map(9, &AtomicBool::new(false), |_, index| assert!(index < 5));
        assert!(matches!(panicked, Err(Unfinished::Panicked)));
    }
}
