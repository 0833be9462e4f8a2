//! `farsa test --protocol` and `--lesion`: the command.

use std::fmt::Write as _;
use std::sync::atomic::AtomicBool;

use serde::Serialize;

use crate::error::Error;
use crate::evaluation::protocols::case_summary::{self, CaseSummary};
use crate::evaluation::protocols::files::{self, ProtocolRecord};
use crate::evaluation::protocols::states::States;
use crate::evaluation::protocols::table::ProtocolTable;
use crate::evaluation::replay::parts;
use crate::evaluation::test::{Subject, TRIALS, TrialCondition, Trials, failure, run_trials, whose};
use crate::evaluation::test_table::Columns;
use crate::experiment::intervention::Intervention;
use crate::experiment::lanes::LaneRequest;
use crate::experiment::protocol::{CaseId, Protocol};
use crate::run::plan::Plan;
use crate::run::pool::Pool;
use crate::run::progress::Progress;
use crate::store::directory::Directory;
use crate::store::lock::Lock;

/// Result of a test by a protocol.
#[derive(Debug, Serialize)]
pub(crate) struct ProtocolRun {
    directory: String,
    #[serde(serialize_with = "name")]
    protocol: Protocol,
    generation: u32,
    individual: u32,
    /// Champions of all populations, if there are several.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    individuals: Vec<u32>,
    seed: u64,
    /// Trials per case.
    trials: usize,
    cases: Vec<CaseSummary>,
    /// That the champion may behave otherwise than in its run.
    warning: Option<String>,
    /// Why the first of the trials that failed did, if any did.
    #[serde(skip_serializing_if = "Option::is_none")]
    failure: Option<String>,
}

fn name<S: serde::Serializer>(protocol: &Protocol, serializer: S) -> Result<S::Ok, S::Error> {
    serializer.serialize_str(&protocol.name)
}

impl ProtocolRun {
    /// A table for reading.
    pub(crate) fn text(&self) -> String {
        let Self { protocol, generation, individual, individuals, seed, trials, .. } = self;
        let whose = whose(*generation, *individual, individuals);
        // Writing into a string cannot fail.
        let mut text = String::new();
        let _ = writeln!(text, "{}: {}", protocol.name, protocol.summary);
        let _ = writeln!(text, "{whose}, {trials} trials a case, test seed {seed}\n");
        text.push_str(&case_summary::text(protocol, &self.cases));
        if let Some(warning) = &self.warning {
            let _ = writeln!(text, "warning: {warning}");
        }
        if let Some(failure) = &self.failure {
            let _ = writeln!(text, "{failure}");
        }
        text
    }
}

/// Options of a test.
#[derive(Debug, Clone, Copy)]
pub(crate) struct TestOptions {
    /// Trials per case. By default those of the protocol.
    pub(crate) trials: Option<usize>,
    pub(crate) seed: u64,
    pub(crate) threads: usize,
    pub(crate) lanes: LaneRequest,
    pub(crate) quiet: bool,
}

/// Runs fresh trials of the champion in every case of a protocol. Writes `protocols/NAME.csv` with its record, and
/// `protocols/NAME.states.csv` if the protocol records states.
///
/// Trial i of each case is trial i of [`test`](crate::evaluation::test::test), so that cases differ in nothing else.
///
/// # Errors
/// As for [`Protocol::find`], [`Subject::read`] and [`States::record`], [`Error::Usage`] for more than 10^8 trials,
/// [`Error::Io`].
pub(crate) fn test(
    plan: &Plan<'_>,
    directory: &Directory,
    name: &str,
    effort: TestOptions,
) -> Result<ProtocolRun, Error> {
    let mut pool = Pool::new(plan, effort.threads, effort.lanes)?;
    let (number, protocol) = protocol(plan, &pool, name)?;
    let trials = trials_of(plan, &protocol, effort)?;
    let subject = Subject::read(plan, directory, &pool)?;
    // An occupied directory is reported before the computation.
    files::make_folder(directory)?;
    drop(Lock::of_tests(directory.path())?);
    let asked = cases(number, None, protocol.cases.len());
    let (found, table) = run(plan, &mut pool, directory, &subject, (protocol, asked), effort)?;
    let (protocol, seed) = (&found.protocol, effort.seed);
    let states = if protocol.states.is_empty() {
        None
    } else {
        Some(States::record(plan, subject.tested(), [number, trials], protocol, seed)?)
    };
    let Subject { generation, individual, .. } = subject;
    let record = |table_crc| {
        let protocol = protocol.name.clone();
        ProtocolRecord { protocol, generation, individual, trials, seed, table_crc }
    };
    files::write(directory, &protocol.name, (&table, &found.cases), record)?;
    if let Some(states) = &states {
        states.write(directory, &protocol.name, record)?;
    }
    Ok(found)
}

/// Runs the same trials with the intact champion and with each list of changes. With a protocol, runs every case with
/// one list of changes. Writes no file.
///
/// # Errors
/// As for [`Protocol::find`], [`Subject::read`], [`parts`] and [`Anatomy::intervention`](crate::advanced::Anatomy::intervention),
/// [`Error::Usage`] for several lists with a protocol, and more than 10^8 trials.
pub(crate) fn lesions(
    plan: &Plan<'_>,
    directory: &Directory,
    name: Option<&str>,
    lists: &[String],
    effort: TestOptions,
) -> Result<ProtocolRun, Error> {
    let mut pool = Pool::new(plan, effort.threads, effort.lanes)?;
    let anatomy = parts(pool.evaluator(), plan)?;
    let changes = lists.iter().map(|list| anatomy.intervention(list)).collect::<Result<Vec<_>, _>>()?;
    let (protocol, asked) = match (name, changes.as_slice()) {
        (Some(name), [change]) => {
            let (number, found) = protocol(plan, &pool, name)?;
            let cases = cases(number, Some(change), found.cases.len());
            (Protocol { summary: format!("{}; with {}", found.summary, lists[0]), ..found }, cases)
        }
        (Some(name), _) => {
            let why = format!("--lesion: {} lists where protocol `{name}` takes one", changes.len());
            return Err(Error::Usage(why));
        }
        (None, changes) => {
            let names = std::iter::once("intact").chain(lists.iter().map(String::as_str));
            let protocol = Protocol::from_list("lesion", "with these parts of the controller changed", names);
            let with = |change| TrialCondition { case: None, intervention: Some(change) };
            let asked = std::iter::once(TrialCondition::default()).chain(changes.iter().map(with)).collect();
            (protocol.with_trials(TRIALS as u32), asked)
        }
    };
    let subject = Subject::read(plan, directory, &pool)?;
    Ok(run(plan, &mut pool, directory, &subject, (protocol, asked), effort)?.0)
}

/// Gets the experiment's protocol of this name, with its number.
fn protocol(plan: &Plan<'_>, pool: &Pool<'_>, name: &str) -> Result<(usize, Protocol), Error> {
    let mut protocols = pool.info().protocols.clone();
    let number = Protocol::find(&protocols, name, plan.experiment.name())?;
    Ok((number, protocols.swap_remove(number)))
}

/// All cases of a protocol of this number, with a change.
fn cases(protocol: usize, intervention: Option<&Intervention>, count: usize) -> Vec<TrialCondition<'_>> {
    (0..count).map(|case| TrialCondition { case: Some(CaseId { protocol, case }), intervention }).collect()
}

/// Trials of each case.
fn trials_of(plan: &Plan<'_>, protocol: &Protocol, effort: TestOptions) -> Result<usize, Error> {
    let (trials, count) = (effort.trials.unwrap_or(protocol.trials as usize), protocol.cases.len());
    if trials.checked_mul(count).is_none_or(|all| all > plan.limits.trials) {
        let limit = plan.limits.trials;
        let why = format!("{trials} trials of each of {count} cases are more than {limit} trials");
        return Err(Error::Usage(why));
    }
    Ok(trials)
}

/// Runs fresh trials of each of a protocol's cases, in which this is asked.
fn run(
    plan: &Plan<'_>,
    pool: &mut Pool<'_>,
    directory: &Directory,
    subject: &Subject,
    (protocol, asked): (Protocol, Vec<TrialCondition<'_>>),
    effort: TestOptions,
) -> Result<(ProtocolRun, ProtocolTable), Error> {
    let (trials, seed) = (trials_of(plan, &protocol, effort)?, effort.seed);
    let progress = Progress::of_trials(trials * asked.len(), effort.quiet);
    let fresh = Trials { count: trials, seed, cases: &asked };
    let results = run_trials(pool, subject.tested(), fresh, &AtomicBool::new(false), &progress);
    drop(progress);
    let results = results?;
    let terms = &pool.info().terms;
    let columns = Columns::new(pool.info(), subject.count());
    let table = ProtocolTable::new(&protocol.cases, trials, &columns, &results);
    let run = ProtocolRun {
        directory: directory.path().display().to_string(),
        generation: subject.generation,
        individual: subject.individual,
        individuals: subject.individuals.clone(),
        seed,
        trials,
        cases: CaseSummary::all(&table, terms),
        warning: subject.warning.clone(),
        failure: failure(&results),
        protocol,
    };
    Ok((run, table))
}
