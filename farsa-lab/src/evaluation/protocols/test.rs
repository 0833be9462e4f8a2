//! `farsa test --protocol`: the command.

use std::fmt::Write as _;

use serde::Serialize;

use crate::error::Error;
use crate::evaluation::protocols::files::{self, ProtocolRecord};
use crate::evaluation::protocols::found::{self, FoundCase};
use crate::evaluation::protocols::states::States;
use crate::evaluation::protocols::table::ProtocolTable;
use crate::evaluation::test::{Subject, Trials, failure, run_trials, whose};
use crate::experiment::lanes::Wanted;
use crate::experiment::protocol::{CaseId, Protocol};
use crate::run::plan::Plan;
use crate::run::pool::Pool;
use crate::run::progress::Progress;
use crate::store::directory::Directory;
use crate::store::lock::Lock;

/// Most trials of all cases together.
const MOST_TRIALS: usize = 100_000_000;

/// What a test by a protocol found.
#[derive(Debug, Serialize)]
pub(crate) struct ProtocolRun {
    directory: String,
    #[serde(serialize_with = "name")]
    protocol: Protocol,
    generation: u32,
    individual: u32,
    /// The champions of all populations, if there are several.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    individuals: Vec<u32>,
    seed: u64,
    /// Of each case.
    trials: usize,
    cases: Vec<FoundCase>,
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
        text.push_str(&found::text(protocol, &self.cases));
        if let Some(warning) = &self.warning {
            let _ = writeln!(text, "warning: {warning}");
        }
        if let Some(failure) = &self.failure {
            let _ = writeln!(text, "{failure}");
        }
        text
    }
}

/// Runs fresh trials of the champion in every case of a protocol, and writes `protocols/NAME.csv` with its record; and
/// `protocols/NAME.states.csv` where the protocol records states.
///
/// Trial i of each case is trial i of [`test`](crate::evaluation::test::test), so that cases differ in nothing else. Without a
/// number of `trials` it is the protocol's own.
///
/// # Errors
/// Those of [`Protocol::find`], [`Subject::read`] and [`States::record`], [`Error::Usage`] for more than 10^8 trials, [`Error::Io`].
pub(crate) fn test(
    plan: &Plan<'_>,
    directory: &Directory,
    name: &str,
    trials: Option<usize>,
    seed: u64,
    threads: usize,
    lanes: Wanted,
    quiet: bool,
) -> Result<ProtocolRun, Error> {
    let mut pool = Pool::new(plan, threads, lanes)?;
    let mut protocols = pool.evaluator().protocols();
    let number = Protocol::find(&protocols, name, plan.experiment.name())?;
    let protocol = protocols.swap_remove(number);
    let trials = trials.unwrap_or(protocol.trials as usize);
    let count = protocol.cases.len();
    let all = trials.checked_mul(count).filter(|all| *all <= MOST_TRIALS).ok_or_else(|| {
        Error::Usage(format!("{trials} trials of each of {count} cases are more than {MOST_TRIALS} trials"))
    })?;
    let subject = Subject::read(plan, directory, &pool)?;
    // Where nothing can be written, that is said before anything is computed.
    files::make_folder(directory)?;
    drop(Lock::of_tests(directory.path())?);
    let cases: Vec<Option<CaseId>> = (0..count).map(|case| Some(CaseId { protocol: number, case })).collect();
    let progress = Progress::new(0, all as u64, quiet);
    let fresh = Trials { count: trials, seed, cases: &cases };
    let results = run_trials(&mut pool, subject.tested(), fresh, &progress);
    drop(progress);
    let results = results?;
    let states = if protocol.states.is_empty() {
        None
    } else {
        Some(States::record(plan, subject.tested(), [number, trials], &protocol, seed)?)
    };

    let (terms, names) = (pool.evaluator().terms(), pool.evaluator().populations());
    let others = names.get(1..subject.count()).unwrap_or(&[]);
    let table = ProtocolTable::new(&protocol.cases, trials, &terms, others, &results);
    let Subject { generation, individual, individuals, warning, .. } = subject;
    let record = |table_crc| {
        let protocol = protocol.name.clone();
        ProtocolRecord { protocol, generation, individual, trials, seed, table_crc }
    };
    files::write(directory, &protocol.name, &table, record)?;
    if let Some(states) = &states {
        states.write(directory, &protocol.name, record)?;
    }
    Ok(ProtocolRun {
        directory: directory.path().display().to_string(),
        generation,
        individual,
        individuals,
        seed,
        trials,
        cases: FoundCase::all(&table, &terms),
        warning,
        failure: failure(&results, &terms),
        protocol,
    })
}
