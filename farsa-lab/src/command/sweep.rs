//! `farsa sweep`: the command.

use std::collections::BTreeMap;
use std::fmt::Write as _;
use std::path::Path;

use serde::Serialize;

use crate::archive::{self, Archive};
use crate::command::arguments::sweep::SweepArgs;
use crate::command::champion_test::Tests;
use crate::command::interrupt::stop_on_signals;
use crate::command::invocation::Invocation;
use crate::error::Error;
use crate::escaped::OneLine;
use crate::json::pretty;
use crate::report::write;
use crate::run::plan::Plan;
use crate::run::summary::Summary;
use crate::store::own_output::refuse_other;
use crate::sweep::Study;
use crate::sweep::work::{Found, Sweep};

/// Results of a sweep, with its archive.
#[derive(Serialize)]
struct Results {
    #[serde(flatten)]
    found: Found,
    #[serde(skip_serializing_if = "Option::is_none")]
    archive: Option<Archived>,
    #[serde(skip_serializing_if = "Option::is_none")]
    report: Option<write::Summary>,
}

/// Written archive.
#[derive(Serialize)]
struct Archived {
    file: String,
    runs: usize,
    bytes: u64,
}

impl<'e> Invocation<'e, '_> {
    /// Makes or lists the runs of all points of a sweep, tests them, and reports and archives the finished ones.
    pub(super) fn sweep(&self, args: &SweepArgs) -> Result<(), Error> {
        let file = match Study::read(&args.file, args.quick)? {
            Study::Sweep(file) => file,
            Study::Checks(checks) => return self.checks(&checks, args),
        };
        let (root, which) = (args.root(), args.which());
        let sweep = Sweep::new(&file, self.laboratory, &root)?;
        if let Some(path) = &args.archive {
            let names = sweep.directories(which)?;
            let names: Vec<String> = names.iter().map(|name| below(name, &root)).collect();
            Archive::replaceable(path, names.iter().map(String::as_str))?;
        }
        args.pages().try_for_each(refuse_other)?;
        let ready = |plan: &Plan<'e>| args.workers.check(plan);
        let found = if args.list {
            sweep.list(which, &ready)?
        } else {
            let pool = |plan: &Plan<'e>| args.workers.pool(plan);
            let tests = Tests { trials: args.test.or(file.test_trials), sampling: file.sampling };
            let test = |run: &mut Summary| self.test_run(run, tests, &args.workers);
            let by = (self.program, self.quiet);
            let mut found = sweep.work(which, &ready, &pool, &test, stop_on_signals, by)?;
            // Runs that were finished before, perhaps without tests.
            self.test_champions(found.summaries(), tests, &args.workers)?;
            found
        };
        let archive = args.archive.as_deref().map(|path| self.archive(&found, &root, path)).transpose()?;
        let report = args.pages().next().map(|_| self.report_runs(&found, args)).transpose()?;
        let mut text = found.text();
        if let Some(Archived { file, runs, bytes }) = &archive {
            // Writing into a string cannot fail.
            let _ = writeln!(text, "{}: {runs} runs in {bytes} bytes", OneLine(file));
        }
        text.extend(report.iter().map(write::Summary::text));
        let results = Results { found, archive, report };
        self.summary(args.json, &text, &|| pretty(&results))
    }

    /// Reports the finished runs, as `farsa report` does.
    fn report_runs(&self, found: &Found, args: &SweepArgs) -> Result<write::Summary, Error> {
        let runs = found.directories().map(|path| self.existing(path)).collect::<Result<Vec<_>, _>>()?;
        if runs.is_empty() {
            return Err(Error::Usage("there is no report, because no run is finished".into()));
        }
        write::report(runs, args.html.as_deref(), args.md.as_deref(), None, self.program)
    }

    /// Archives the finished runs.
    fn archive(&self, found: &Found, root: &Path, path: &Path) -> Result<Archived, Error> {
        let mut runs = BTreeMap::new();
        for directory in found.directories() {
            let (opened, plan) = self.existing(directory)?;
            if let Some(files) = archive::pack(&plan, &opened)? {
                runs.insert(below(directory, root), files);
            }
        }
        if runs.is_empty() {
            return Err(Error::Usage(format!("{}: no run is finished", path.display())));
        }
        let runs = Archive { runs };
        let bytes = runs.write(path)?;
        Ok(Archived { file: path.display().to_string(), runs: runs.runs.len(), bytes })
    }
}

/// Returns the part of a path below a folder, with slashes.
fn below(path: &Path, root: &Path) -> String {
    let parts = path.strip_prefix(root).unwrap_or(path).iter().map(|part| part.to_string_lossy());
    parts.collect::<Vec<_>>().join("/")
}
