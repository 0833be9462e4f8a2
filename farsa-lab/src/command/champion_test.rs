//! `--test` of `farsa run` and `farsa sweep`: tests of the champions of finished runs.

use std::path::Path;

use crate::command::arguments::shared::WorkerArgs;
use crate::command::interrupt::stop_on_signals;
use crate::command::invocation::Invocation;
use crate::error::{Error, FileFault};
use crate::evaluation::findings::Findings;
use crate::evaluation::test;
use crate::run::evaluation_backend::Unfinished;
use crate::run::summary::{ChampionTest, Summary};
use crate::shell::again;

/// Seed of the tests, the default one of `farsa test`.
const SEED: u64 = 1;

impl Invocation<'_, '_> {
    /// Tests the champions of some runs, unless they have the same test already.
    ///
    /// A run whose test another process is writing has no result here.
    ///
    /// # Errors
    /// [`Error::Interrupted`] with the command line of this process, and the errors of tests.
    pub(super) fn test_champions<'s>(
        &self,
        runs: impl Iterator<Item = &'s mut Summary>,
        trials: Option<u32>,
        workers: &WorkerArgs,
    ) -> Result<(), Error> {
        let Some(trials) = trials else { return Ok(()) };
        for run in runs {
            run.test = match self.champion_test(&run.directory, trials as usize, workers) {
                Err(Unfinished::Error(Error::File { fault: FileFault::Occupied, .. })) => None,
                Err(Unfinished::Stopped) => return Err(Error::Interrupted { resume: again(self.program) }),
                findings => {
                    let Findings { trials, successes, broken_down, rate, fitness, .. } = findings?;
                    let [success, fitness] = [rate, fitness].map(|x| Some(x).filter(|x| x.is_finite()));
                    let has_criterion = successes.is_some();
                    Some(ChampionTest { trials, broken_down, success, has_criterion, fitness })
                }
            };
        }
        Ok(())
    }

    fn champion_test(&self, path: &Path, trials: usize, workers: &WorkerArgs) -> Result<Findings, Unfinished> {
        let (directory, plan) = self.existing(path)?;
        if let Some(findings) = test::repeated(&plan, &directory, trials, SEED)? {
            return Ok(findings);
        }
        let (threads, lanes) = (workers.threads(), workers.lanes());
        let stop = stop_on_signals();
        Ok(test::test_until(stop, &plan, &directory, None, trials, SEED, threads, lanes, self.quiet)?.findings)
    }
}
