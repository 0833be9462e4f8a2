//! `farsa replay --protocol`: a trial of each of some cases of a protocol, step by step.

use std::fmt::Write as _;
use std::io::{self, Write};
use std::path::Path;

use farsa_view::Table;
use serde::Serialize;

use crate::error::Error;
use crate::evaluation::memory_budget::MemoryUse;
use crate::evaluation::protocols::selected_cases::{CaseSelection, CaseTrials};
use crate::evaluation::replayed::{self, InWords, Replayed, run_in_words};
use crate::evaluation::test::Subject;
use crate::evaluation::trials::{came_to, facts, fitness, success, why_failed};
use crate::experiment::outcome::Outcome;
use crate::figures::significant::scored;
use crate::run::plan::Plan;
use crate::store::directory::Directory;

/// Cases of one run.
#[derive(Debug, Serialize)]
pub(crate) struct CasesSummary {
    directory: String,
    experiment: String,
    condition: String,
    protocol: String,
    generation: u32,
    individual: u32,
    trial: u32,
    seed: u64,
    cases: Vec<ReplayedCase>,
    #[serde(skip)]
    caption: String,
}

#[derive(Debug, Serialize)]
struct ReplayedCase {
    row: String,
    column: String,
    held_out: bool,
    steps: u32,
    /// Fitness of the trial. Null in JSON if it failed.
    fitness: f64,
    /// `None` for a task without a criterion of success.
    success: Option<bool>,
    /// Why it failed, if it did.
    #[serde(skip_serializing_if = "Option::is_none")]
    failure: Option<String>,
    #[serde(skip)]
    name: String,
}

impl CasesSummary {
    fn new(plan: &Plan<'_>, directory: &Directory, trials: &CaseTrials, outcomes: &[Outcome]) -> Self {
        let cases = trials.cases.iter().zip(outcomes).map(|(number, outcome)| {
            let case = trials.case(*number);
            ReplayedCase {
                name: case.name(),
                row: case.row,
                column: case.column,
                held_out: case.held_out,
                steps: outcome.steps,
                fitness: fitness(trials.evaluator(), std::slice::from_ref(outcome)),
                success: success(trials.evaluator(), outcome),
                failure: why_failed(trials.evaluator(), outcome),
            }
        });
        let Subject { generation, individual, .. } = trials.subject();
        Self {
            directory: directory.path().display().to_string(),
            experiment: plan.experiment.name().into(),
            condition: plan.condition.clone(),
            protocol: trials.protocol().name.clone(),
            generation: *generation,
            individual: *individual,
            trial: trials.trial,
            seed: trials.seed,
            cases: cases.collect(),
            caption: trials.caption(),
        }
    }
}

impl InWords for CasesSummary {
    /// A line for the champion, and one for each case.
    fn text(&self) -> String {
        let mut text = self.caption.clone();
        for ReplayedCase { name, steps, fitness, success, failure, .. } in &self.cases {
            let came = success.map_or("", |success| if success { "success, " } else { "no success, " });
            // Writing into a string cannot fail.
            let _ = match failure {
                None => write!(text, "\n{name}: {came}{steps} steps, {}", scored(*fitness)),
                Some(why) => write!(text, "\n{name}: broken down after {steps} steps: {why}"),
            };
        }
        text
    }
}

/// Writes the trial of one case as CSV, one line per step. `out` opens the output after the case was found.
///
/// # Errors
/// As for [`CaseTrials::find`] and [`CaseTrials::run`], [`Error::Usage`] for more than one case, [`Error::Io`].
pub(crate) fn replay<W: Write>(
    plan: &Plan<'_>,
    directory: &Directory,
    choice: CaseSelection<'_>,
    out: impl FnOnce() -> Result<W, Error>,
) -> Result<Replayed<CasesSummary>, Error> {
    let mut trials = CaseTrials::find(plan, directory, choice)?;
    let &[case] = trials.cases.as_slice() else {
        let (name, count) = (&trials.protocol().name, trials.cases.len());
        let why = format!("{count} cases of protocol `{name}`: steps are written of one, which --case names");
        return Err(Error::Usage(why));
    };
    let failed = |source: io::Error| Error::Io { doing: "write", path: "the replay".into(), source };
    let mut table = Table::new(out()?, &trials.schema()).map_err(failed)?;
    table.begin(trials.trial);
    let outcome = trials.run(case, &mut table);
    // The steps before a panic are worth having.
    table.finish().map_err(failed)?;
    Ok(Replayed::new(CasesSummary::new(plan, directory, &trials, &[outcome?]), None))
}

/// Writes the trials, and those of the same cases in another run, as a page for a browser.
///
/// # Errors
/// As for [`CaseTrials::find`] and [`CaseTrials::run`], [`Error::Io`].
pub(crate) fn page(
    plan: &Plan<'_>,
    directory: &Directory,
    choice: CaseSelection<'_>,
    compare: Option<(&Plan<'_>, &Directory)>,
    path: &Path,
) -> Result<Replayed<CasesSummary>, Error> {
    let what = format!(", {}", choice.protocol);
    replayed::page((plan, directory), compare, &what, path, |page, plan, directory| {
        let mut trials = CaseTrials::find(plan, directory, choice)?;
        let (mut outcomes, mut kept) = (Vec::new(), MemoryUse::new(plan.limits));
        for case in trials.cases.clone() {
            let mut recording = kept.recording(trials.schema());
            let outcome = trials.run(case, &mut recording)?;
            kept.add(&recording)?;
            let (case, came) = (trials.case(case).name(), came_to(trials.evaluator(), &outcome));
            let name = format!("{case}: {came}; {}, {}", run_in_words(plan), trials.caption());
            page.add(&name, facts(trials.evaluator(), &outcome), recording);
            outcomes.push(outcome);
        }
        Ok(CasesSummary::new(plan, directory, &trials, &outcomes))
    })
}
