//! `farsa sweep` with a file of checks.

use std::path::PathBuf;

use crate::command::arguments::sweep::SweepArgs;
use crate::command::champion_test::Tests;
use crate::command::interrupt::stop_on_signals;
use crate::command::invocation::Invocation;
use crate::error::Error;
use crate::json::pretty;
use crate::run::plan::Plan;
use crate::run::summary::Summary;
use crate::store::own_output::{refuse_other, write_outputs};
use crate::sweep::check_table::CheckResults;
use crate::sweep::work::{Selection, Sweep};
use crate::sweep::{Check, Estimate};

impl<'e> Invocation<'e, '_> {
    /// Makes or lists the runs of all checks, tests them, and compares them with the published figures.
    ///
    /// # Errors
    /// All checks are read and planned before the first run starts. Later an error fails its check only. [`Error::Other`] names
    /// the failed and differing checks.
    pub(super) fn checks(&self, checks: &[Check], args: &SweepArgs) -> Result<(), Error> {
        if let Some(option) = args.refused_by_checks() {
            return Err(Error::Usage(format!("{option}: {} has [[checks]]", args.file.display())));
        }
        args.pages().try_for_each(refuse_other)?;
        let which = args.which();
        let checks = match which.point {
            None => checks,
            Some(number) => checks
                .get(number..=number)
                .ok_or_else(|| Error::Usage(format!("--point {}: there are {}", number + 1, checks.len())))?,
        };
        let root = args.root();
        let roots: Vec<PathBuf> = checks.iter().map(|check| root.join(&check.name)).collect();
        let sweeps = checks.iter().zip(&roots).map(|(check, root)| Sweep::new(&check.sweep, self.laboratory, root));
        let sweeps = sweeps.collect::<Result<Vec<_>, _>>()?;
        let which = Selection { point: None, ..which };
        for (check, sweep) in checks.iter().zip(&sweeps) {
            let ready = |plan: &Plan<'e>| {
                args.workers.check(plan).and_then(|()| check.measure.check(&plan.evaluator()?.info()))
            };
            sweep.ready(which, &ready)?;
        }
        let mut results = CheckResults::default();
        for (check, sweep) in checks.iter().zip(&sweeps) {
            let worked = if args.list { Ok(()) } else { self.work_on(check, sweep, which, args) };
            match worked.and_then(|()| self.measured(check, sweep)) {
                Err(error @ (Error::Interrupted { .. } | Error::Rank { .. })) => return Err(error),
                found => results.add(check, found.map_err(|error| error.to_string())),
            }
        }
        if let Some(path) = &args.md {
            write_outputs(&[(path.clone(), results.markdown())])?;
        }
        self.summary(args.json, &results.text(), &|| pretty(&results))?;
        results.faults().map_or(Ok(()), |faults| Err(Error::Other(faults)))
    }

    /// Evolves and tests the runs of a check.
    fn work_on(&self, check: &Check, sweep: &Sweep<'_, 'e>, which: Selection, args: &SweepArgs) -> Result<(), Error> {
        let pool = |plan: &Plan<'e>| args.workers.pool(plan);
        let tests = Tests::of_champions(check.sweep.test_trials);
        let test = |run: &mut Summary| self.test_run(run, tests, &args.workers);
        let by = (self.program, self.quiet);
        let mut found = sweep.work(which, &|_| Ok(()), &pool, &test, stop_on_signals, by)?;
        self.test_champions(found.summaries(), tests, &args.workers)
    }

    /// Computes the measure of a check from its finished runs, and counts them.
    fn measured(&self, check: &Check, sweep: &Sweep<'_, 'e>) -> Result<(Option<Estimate>, usize), Error> {
        let mut samples = Vec::new();
        for path in sweep.list(Selection::default(), &|_| Ok(()))?.directories() {
            let (directory, plan) = self.existing(path)?;
            samples.extend(check.measure.sample(&plan, &directory, check.sweep.test_trials)?);
        }
        Ok((check.measure.estimate(&samples), samples.len()))
    }
}
