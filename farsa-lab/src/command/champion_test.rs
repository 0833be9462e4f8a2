//! `--test` of `farsa run` and `farsa sweep`: tests of finished runs.

use std::path::Path;

use crate::command::arguments::shared::WorkerArgs;
use crate::command::interrupt::stop_on_signals;
use crate::command::invocation::Invocation;
use crate::error::{Error, FileFault};
use crate::evaluation::findings::Findings;
use crate::evaluation::generations::{self, Sampling};
use crate::evaluation::test::{self, TEST_SEED};
use crate::run::evaluation_backend::Unfinished;
use crate::run::summary::{ChampionTest, Summary};
use crate::shell::again;

/// Tests of each finished run.
#[derive(Clone, Copy, Default)]
pub(super) struct Tests {
    /// Trials of the test of the champion.
    pub(super) trials: Option<u32>,
    /// Tests of the best of every n-th generation.
    pub(super) sampling: Option<Sampling>,
}

impl Tests {
    pub(super) fn of_champions(trials: Option<u32>) -> Self {
        Self { trials, ..Self::default() }
    }
}

impl Invocation<'_, '_> {
    /// Tests some runs, unless they have the same tests already.
    ///
    /// # Errors
    /// [`Error::Interrupted`] with the command line of this process, and the errors of tests.
    pub(super) fn test_champions<'s>(
        &self,
        mut runs: impl Iterator<Item = &'s mut Summary>,
        tests: Tests,
        workers: &WorkerArgs,
    ) -> Result<(), Error> {
        runs.try_for_each(|run| self.test_run(run, tests, workers))
    }

    /// Tests a run, unless it has the same tests already. A run whose test another process is writing has no result here.
    ///
    /// # Errors
    /// As [`test_champions`](Self::test_champions).
    pub(super) fn test_run(&self, run: &mut Summary, tests: Tests, workers: &WorkerArgs) -> Result<(), Error> {
        if let Some(trials) = tests.trials {
            let findings = self.unless_occupied(self.champion_test(&run.directory, trials as usize, workers))?;
            run.test = findings.map(|Findings { trials, successes, broken_down, rate, fitness, .. }| {
                let [success, fitness] = [rate, fitness].map(|x| Some(x).filter(|x| x.is_finite()));
                ChampionTest { trials, broken_down, success, has_criterion: successes.is_some(), fitness }
            });
        }
        if let Some(sampling) = tests.sampling {
            let (directory, plan) = self.existing(&run.directory)?;
            let by = (workers.threads(), workers.lanes());
            let tested = generations::test(stop_on_signals(), &plan, &directory, sampling, by, self.quiet);
            self.unless_occupied(tested)?;
        }
        Ok(())
    }

    /// Returns `None` for a test that another process is writing.
    fn unless_occupied<T>(&self, tested: Result<T, Unfinished>) -> Result<Option<T>, Error> {
        match tested {
            Err(Unfinished::Error(Error::File { fault: FileFault::Occupied, .. })) => Ok(None),
            Err(Unfinished::Stopped) => Err(Error::Interrupted { resume: again(self.program) }),
            tested => Ok(Some(tested?)),
        }
    }

    fn champion_test(&self, path: &Path, trials: usize, workers: &WorkerArgs) -> Result<Findings, Unfinished> {
        let (directory, plan) = self.existing(path)?;
        if let Some(findings) = test::repeated(&plan, &directory, trials, TEST_SEED)? {
            return Ok(findings);
        }
        let (threads, lanes) = (workers.threads(), workers.lanes());
        let stop = stop_on_signals();
        Ok(test::test_until(stop, &plan, &directory, None, trials, TEST_SEED, threads, lanes, self.quiet)?.findings)
    }
}
