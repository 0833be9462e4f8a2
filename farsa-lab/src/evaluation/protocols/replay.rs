//! `farsa replay --protocol`: a trial of each of some cases of a protocol, step by step.

use std::fmt::Write as _;
use std::io::{self, Write};
use std::path::Path;

use farsa_view::{Page, Recording, Table};
use serde::Serialize;

use crate::error::Error;
use crate::evaluation::protocols::chosen::{CaseTrials, Choice};
use crate::evaluation::replay::{came_to, facts, fitness};
use crate::evaluation::test::Subject;
use crate::experiment::outcome::Outcome;
use crate::figures::significant::significant;
use crate::run::plan::Plan;
use crate::store::directory::Directory;
use crate::store::replace::create_results;

/// What a replay of a protocol's cases came to.
#[derive(Debug, Serialize)]
pub(crate) struct ReplayedCases {
    #[serde(flatten)]
    replay: CasesSummary,
    /// The same cases in another run, if there is one.
    compared: Option<CasesSummary>,
    /// Where the recordings went, as the caller knows; none for the standard output.
    pub(crate) file: Option<String>,
    /// The same in words.
    pub(crate) summary: String,
}

/// The cases of one run.
#[derive(Debug, Serialize)]
struct CasesSummary {
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
    /// Of the trial; no number in JSON if it failed.
    fitness: f64,
    success: bool,
    /// Why it failed, if it did.
    #[serde(skip_serializing_if = "Option::is_none")]
    failure: Option<String>,
    #[serde(skip)]
    name: String,
}

impl CasesSummary {
    fn new(plan: &Plan<'_>, directory: &Directory, trials: &CaseTrials, outcomes: &[Outcome]) -> Self {
        let terms = trials.evaluator().terms();
        let cases = trials.cases.iter().zip(outcomes).map(|(number, outcome)| {
            let case = trials.case(*number);
            ReplayedCase {
                name: case.name(),
                row: case.row,
                column: case.column,
                held_out: case.held_out,
                steps: outcome.steps,
                fitness: fitness(trials.evaluator(), std::slice::from_ref(outcome)),
                success: outcome.success,
                failure: outcome.why_failed(&terms),
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

    /// A line for the champion, and one for each case.
    fn text(&self) -> String {
        let mut text = self.caption.clone();
        for ReplayedCase { name, steps, fitness, success, failure, .. } in &self.cases {
            let came = if *success { "success" } else { "no success" };
            // Writing into a string cannot fail.
            let _ = write!(text, "\n{name}: {came}, {steps} steps, fitness {}", significant(*fitness));
            if let Some(why) = failure {
                let _ = write!(text, ", failed: {why}");
            }
        }
        text
    }
}

impl ReplayedCases {
    fn new(replay: CasesSummary, compared: Option<CasesSummary>) -> Self {
        let texts: Vec<String> = [&replay].into_iter().chain(&compared).map(CasesSummary::text).collect();
        Self { replay, compared, file: None, summary: texts.join("\n") }
    }
}

/// Writes the trial of one case as CSV, a line per step.
///
/// # Errors
/// Those of [`CaseTrials::find`] and [`CaseTrials::run`], [`Error::Usage`] for more cases than one, [`Error::Io`].
pub(crate) fn replay(
    plan: &Plan<'_>,
    directory: &Directory,
    choice: Choice<'_>,
    out: impl FnOnce() -> Result<Box<dyn Write>, Error>,
) -> Result<ReplayedCases, Error> {
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
    Ok(ReplayedCases::new(CasesSummary::new(plan, directory, &trials, &[outcome?]), None))
}

/// Writes the trials, and those of the same cases in another run, as a page for a browser.
///
/// # Errors
/// Those of [`CaseTrials::find`] and [`CaseTrials::run`], [`Error::Io`].
pub(crate) fn page(
    plan: &Plan<'_>,
    directory: &Directory,
    choice: Choice<'_>,
    compare: Option<(&Plan<'_>, &Directory)>,
    path: &Path,
) -> Result<ReplayedCases, Error> {
    let title = compare.map_or_else(|| plan.name(), |(other, _)| format!("{} and {}", plan.name(), other.name()));
    let mut page = Page::new(&format!("{title}, {}", choice.protocol));
    let add = |page: &mut Page, plan: &Plan<'_>, directory: &Directory| -> Result<CasesSummary, Error> {
        let mut trials = CaseTrials::find(plan, directory, choice)?;
        let mut outcomes = Vec::new();
        for case in trials.cases.clone() {
            let mut recording = Recording::new(trials.schema());
            let outcome = trials.run(case, &mut recording)?;
            let run = [plan.condition.as_str(), "seed"].into_iter().find(|word| !word.is_empty()).unwrap_or_default();
            let (case, came) = (trials.case(case).name(), came_to(trials.evaluator(), &outcome));
            let name = format!("{case}: {came}; {run} {}, {}", plan.seed, trials.caption());
            page.add(&name, facts(trials.evaluator(), &outcome), recording);
            outcomes.push(outcome);
        }
        Ok(CasesSummary::new(plan, directory, &trials, &outcomes))
    };
    let replay = add(&mut page, plan, directory)?;
    let second = page.episodes();
    let compared = compare.map(|(plan, directory)| add(&mut page, plan, directory)).transpose()?;
    if compared.is_some() {
        page.open_beside(second);
    }
    let html = page.html();
    create_results(&[(path.to_owned(), html)])?;
    Ok(ReplayedCases::new(replay, compared))
}
