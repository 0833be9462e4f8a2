//! `--test` of `farsa run` and `farsa sweep`: tests of the champions of finished runs.

use std::path::Path;
use std::sync::atomic::Ordering;

use crate::command::arguments::shared::WorkerArgs;
use crate::command::interrupt::stop_on_signals;
use crate::command::invocation::Invocation;
use crate::error::{Error, FileFault};
use crate::evaluation::findings::Findings;
use crate::evaluation::test;
use crate::run::summary::{ChampionTest, Summary};

/// Seed of the tests, the default one of `farsa test`.
const SEED: u64 = 1;

impl Invocation<'_, '_> {
    /// Tests the champions of some runs, unless they have the same test already.
    ///
    /// A run whose test another process is writing has no result here.
    ///
    /// # Errors
    /// [`Error::Interrupted`] between two tests, and the errors of tests.
    pub(super) fn test_champions<'s>(
        &self,
        runs: impl Iterator<Item = &'s mut Summary>,
        trials: Option<u32>,
        workers: &WorkerArgs,
    ) -> Result<(), Error> {
        let Some(trials) = trials else { return Ok(()) };
        for run in runs {
            if stop_on_signals().load(Ordering::Relaxed) {
                let resume = format!("{} test {}", self.program, run.directory);
                return Err(Error::Interrupted { resume });
            }
            run.test = match self.champion_test(Path::new(&run.directory), trials as usize, workers) {
                Err(Error::File { fault: FileFault::Occupied, .. }) => None,
                found => {
                    let Findings { trials, broken_down, rate, fitness, .. } = found?;
                    let finite = |x: f64| Some(x).filter(|x| x.is_finite());
                    Some(ChampionTest { trials, broken_down, success: finite(rate), fitness: finite(fitness) })
                }
            };
        }
        Ok(())
    }

    fn champion_test(&self, path: &Path, trials: usize, workers: &WorkerArgs) -> Result<Findings, Error> {
        let (directory, plan) = self.existing(path)?;
        if let Some(findings) = test::repeated(&plan, &directory, trials, SEED)? {
            return Ok(findings);
        }
        let (threads, lanes) = (workers.threads(), workers.lanes());
        Ok(test::test(&plan, &directory, None, trials, SEED, threads, lanes, self.quiet)?.findings)
    }
}
