//! `farsa test`: the champion on starts that it has never met.

use std::fmt::Write as _;
use std::sync::atomic::AtomicBool;
use std::thread;
use std::time::Duration;

use farsa_evo::ObservationStatistics;
use farsa_num::crc32;
use serde::{Deserialize, Serialize};

use crate::error::Error;
use crate::evaluation::test_table::{Findings, Table, TrialResult};
use crate::experiment::episode::EpisodeId;
use crate::experiment::evaluator::Evaluation;
use crate::experiment::lanes::Wanted;
use crate::experiment::outcome::Outcome;
use crate::run::plan::{LARGEST_SEED, Plan};
use crate::run::pool::{Pool, Unfinished};
use crate::run::progress::Progress;
use crate::run::records::{Best, Champions};
use crate::store::bounded::read_own_text;
use crate::store::directory::Directory;
use crate::store::draft;
use crate::store::lock::Lock;
use crate::store::replace::replace;

/// `test.json`: which champion `test.csv` is about, and how to make it again.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
pub(crate) struct Record {
    pub(crate) generation: u32,
    pub(crate) individual: u32,
    pub(crate) trials: usize,
    pub(crate) seed: u64,
    /// CRC-32 of the table: a process that was killed between the two files leaves another.
    table_crc: u32,
}

/// Bytes of the largest table and of the largest record that are read.
const LARGEST: [u64; 2] = [1 << 30, 1 << 20];
/// How often, and with which pauses, the two files are read again while another process writes them.
const ATTEMPTS: usize = 20;
const PAUSE: Duration = Duration::from_millis(25);

/// The test that a directory holds, with its record; none of both where there is no test, and no record of a table that was made
/// before there were records, or by a process that was killed before it wrote one.
///
/// # Errors
/// [`Error::Io`], [`Error::Damaged`].
pub(crate) fn read(directory: &Directory) -> Result<Option<(Table, Option<Record>)>, Error> {
    let (table, record) = (directory.test(), directory.test_record());
    if !table.is_file() {
        return Ok(None);
    }
    for attempt in 1..=ATTEMPTS {
        let text = read_own_text(&table, LARGEST[0])?;
        let found: Option<Record> = if record.is_file() {
            let text = read_own_text(&record, LARGEST[1])?;
            Some(serde_json::from_str(&text).map_err(|error| Error::damaged(&record, error))?)
        } else {
            None
        };
        let own = found.filter(|record| record.table_crc == crc32(text.as_bytes()));
        if own.is_some() || attempt == ATTEMPTS || !record.is_file() {
            return Ok(Some((Table::from_text(&table, &text)?, own)));
        }
        // One file is of a test that is just being written.
        thread::sleep(PAUSE);
    }
    Ok(None)
}

/// Writes both files of a test, which no other process does meanwhile.
fn write(directory: &Directory, table: &Table, record: impl FnOnce(u32) -> Record) -> Result<(), Error> {
    let (path, json) = (directory.test(), directory.test_record());
    let bytes = table.csv(&path)?;
    let record = record(crc32(&bytes));
    let text = serde_json::to_string_pretty(&record).map_err(|error| Error::Other(error.to_string()))?;
    let _lock = Lock::of_tests(directory.path())?;
    draft::sweep_of(&path);
    draft::sweep_of(&json);
    replace(&path, &bytes)?;
    replace(&json, format!("{text}\n").as_bytes())
}

/// What a test found.
#[derive(Debug, Serialize)]
pub(crate) struct TestRun {
    directory: String,
    generation: u32,
    individual: u32,
    /// The champions of all populations, if there are several.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    individuals: Vec<u32>,
    seed: u64,
    #[serde(flatten)]
    findings: Findings,
    /// That the champion may behave otherwise than in its run.
    warning: Option<String>,
    /// Why the first of the trials that failed did, if any did.
    #[serde(skip_serializing_if = "Option::is_none")]
    failure: Option<String>,
    #[serde(skip)]
    table: Table,
}

impl TestRun {
    /// A table for reading, and what it says together.
    pub(crate) fn text(&self) -> String {
        let Self { generation, individual, seed, .. } = self;
        let mut text = self.table.aligned();
        // Writing into a string cannot fail.
        let _ = match self.individuals.as_slice() {
            [] => writeln!(text, "\nindividual {individual} of generation {generation}, test seed {seed}"),
            all => {
                let all = all.iter().map(ToString::to_string).collect::<Vec<_>>().join(", ");
                writeln!(text, "\nindividuals {all} of generation {generation} against each other, test seed {seed}")
            }
        };
        text.push_str(&self.findings.text());
        if let Some(warning) = &self.warning {
            let _ = writeln!(text, "warning: {warning}");
        }
        if let Some(failure) = &self.failure {
            let _ = writeln!(text, "{failure}");
        }
        text
    }
}

/// Runs `trials` fresh trials of the champion and writes `test.csv`.
///
/// Trial i of the test is trial i modulo the experiment's number of trials, with random numbers of its own. The champions
/// of several populations meet each other: each trial is run once for each of them, with the same numbers.
pub(crate) fn test(
    plan: &Plan<'_>,
    directory: &Directory,
    trials: usize,
    seed: u64,
    threads: usize,
    lanes: Wanted,
    quiet: bool,
) -> Result<TestRun, Error> {
    let path = directory.champion();
    if !path.is_file() && directory.checkpoint().is_file() {
        return Err(Error::damaged(&path, "there is none: no generation is finished yet"));
    }
    let Champions { identity, generation, best, normalisation } = Champions::read(plan, directory)?;
    let mut pool = Pool::new(plan, threads, lanes)?;
    let parameters: Option<Vec<Vec<f32>>> = best.iter().map(|best| best.genes.decode(pool.genotype())).collect();
    let parameters = parameters.filter(|all| all.len() == pool.evaluator().populations().len());
    let Some(parameters) = parameters else {
        return Err(Error::damaged(&path, "its genome is not one of the experiment"));
    };
    // Where nothing can be written, that is said before anything is computed.
    drop(Lock::of_tests(directory.path())?);
    let warning = identity.same_values(&plan.identity()?, &path).err().map(|error| error.to_string());
    let size = if best.len() > 1 { plan.size()? } else { 0 };
    let progress = Progress::new(0, trials as u64, quiet);
    let champions = Tested { parameters: &parameters, size, normalisation: normalisation.as_ref() };
    let results = run_trials(&mut pool, champions, trials, seed, &progress);
    drop(progress);
    let results = results?;
    let Some(&Best { individual, .. }) = best.first() else {
        return Err(Error::damaged(&path, "it has no individual"));
    };
    let individuals = if best.len() > 1 { best.iter().map(|best| best.individual).collect() } else { Vec::new() };

    let terms = pool.evaluator().terms();
    let names = pool.evaluator().populations();
    let failed =
        results.iter().enumerate().find_map(|(number, found)| Some((number, found.outcome.why_failed(&terms)?)));
    let failure = failed.map(|(number, why)| format!("line {number} of the test failed: {why}"));
    let table = Table::new(&terms, names.get(1..best.len()).unwrap_or(&[]), &results);
    write(directory, &table, |table_crc| Record { generation, individual, trials, seed, table_crc })?;
    let (path, findings) = (directory.path().display().to_string(), table.findings(&terms));
    Ok(TestRun { directory: path, generation, individual, individuals, seed, findings, warning, failure, table })
}

/// The episode of a test's trial, counted through all of them, by the first individual, where there are so many kinds of trials.
pub(crate) fn episode(trial: usize, kinds: usize, seed: u64) -> EpisodeId {
    let kinds = kinds.max(1);
    let (generation, trial) = ((trial / kinds) as u32, (trial % kinds) as u32);
    EpisodeId { seed: seed | !LARGEST_SEED, generation, individual: 0, trial }
}

/// An individual that is tested, or one of each population.
#[derive(Clone, Copy)]
pub(crate) struct Tested<'t> {
    pub(crate) parameters: &'t [Vec<f32>],
    /// Individuals of each of several populations.
    pub(crate) size: usize,
    /// By what observations are normalised, where they are.
    pub(crate) normalisation: Option<&'t ObservationStatistics>,
}

/// Evaluates fresh trials of some parameters.
pub(crate) fn run_trials(
    pool: &mut Pool<'_>,
    tested: Tested<'_>,
    trials: usize,
    seed: u64,
    progress: &Progress,
) -> Result<Vec<TrialResult>, Unfinished> {
    let Tested { parameters: champions, size, normalisation } = tested;
    let (count, kinds) = (champions.len().max(1), pool.evaluator().trials().max(1));
    let others_of = |own: usize| champions.iter().enumerate().filter(move |(other, _)| *other != own);
    let others: Vec<Vec<&[f32]>> =
        (0..champions.len()).map(|own| others_of(own).map(|(_, other)| other.as_slice()).collect()).collect();
    let task = |number: usize| {
        let (population, trial) = (number % count, number / count);
        let id = EpisodeId { individual: (population * size) as u32, ..episode(trial, kinds, seed) };
        let (parameters, opponents) = (champions.get(population)?, others.get(population)?);
        Some(Evaluation { number, parameters, opponents, normalisation, id })
    };
    let done = |number: usize, _: Option<&Outcome>| {
        if number.is_multiple_of(count) {
            progress.advance();
        }
    };
    let outcomes = pool.evaluate(trials * count, &AtomicBool::new(false), task, done)?;
    let fitness = |outcome: &Outcome| {
        let alone = std::slice::from_ref(outcome);
        if outcome.is_finite() { pool.evaluator().fitness(alone) } else { f64::NAN }
    };
    let mut results: Vec<TrialResult> = Vec::with_capacity(trials);
    for (number, outcome) in outcomes.into_iter().flatten().enumerate() {
        let earned = fitness(&outcome);
        if let Some(first) = results.last_mut().filter(|_| !number.is_multiple_of(count)) {
            first.others.push((earned, outcome.success));
        } else {
            let trial = (number / count % kinds) as u32;
            results.push(TrialResult { trial, outcome, fitness: earned, others: Vec::new() });
        }
    }
    Ok(results)
}
