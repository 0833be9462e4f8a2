//! `farsa test`: the champion on starts that it has never met.

use std::fmt::Write as _;
use std::sync::atomic::AtomicBool;

use farsa_evo::ObservationStatistics;
use serde::{Deserialize, Serialize};

use crate::error::Error;
use crate::evaluation::findings::Findings;
use crate::evaluation::recorded::{self, TableRecord};
use crate::evaluation::replay::{LocatedIndividual, Selection};
use crate::evaluation::test_table::{Columns, Table, TrialResult};
use crate::evaluation::trials::{episode, why_failed};
use crate::experiment::episode::EpisodeId;
use crate::experiment::evaluator::Evaluation;
use crate::experiment::intervention::Intervention;
use crate::experiment::lanes::LaneRequest;
use crate::experiment::outcome::Outcome;
use crate::experiment::protocol::CaseId;
use crate::run::evaluation_backend::Unfinished;
use crate::run::plan::Plan;
use crate::run::pool::Pool;
use crate::run::progress::Progress;
use crate::run::records::{Best, Champions};
use crate::store::directory::Directory;
use crate::store::lock::Lock;

/// Part of `test.json` that names the champion of `test.csv` and repeats the test.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
pub(crate) struct Record {
    pub(crate) generation: u32,
    pub(crate) individual: u32,
    pub(crate) trials: usize,
    pub(crate) seed: u64,
    /// CRC-32 of the table: a process that was killed between the two files leaves another.
    table_crc: u32,
}

/// Content of `test.json`: a record with the results of its test.
#[derive(Serialize)]
struct Recorded<'r> {
    #[serde(flatten)]
    record: Record,
    results: &'r Findings,
}

impl TableRecord for Record {
    fn table_crc(&self) -> u32 {
        self.table_crc
    }
}

/// Reads the test of a directory with its record, see [`recorded::read`].
///
/// # Errors
/// [`Error::Io`], [`Error::File`].
pub(crate) fn read(directory: &Directory) -> Result<Option<(Table, Option<Record>)>, Error> {
    let path = directory.test();
    let Some((text, record)) = recorded::read(&path, &directory.test_record())? else { return Ok(None) };
    Ok(Some((Table::from_text(&path, &text)?, record)))
}

/// Reads the results of an equal test of the champion that a run has now, if there is one.
///
/// # Errors
/// The errors of [`read`], and [`Error::File`] for a run without champions.
pub(crate) fn repeated(
    plan: &Plan<'_>,
    directory: &Directory,
    trials: usize,
    seed: u64,
) -> Result<Option<Findings>, Error> {
    let Some((table, Some(record))) = read(directory)? else { return Ok(None) };
    let Champions { generation, best, .. } = Champions::read(plan, directory)?;
    let is_same = (record.trials, record.seed, record.generation) == (trials, seed, generation)
        && best.first().is_some_and(|best| best.individual == record.individual);
    if !is_same {
        return Ok(None);
    }
    Ok(Some(table.findings(&plan.evaluator()?.info().terms)))
}

/// Trials of a test where no number is asked for.
pub(crate) const TRIALS: usize = 100;
/// Seed of the tests of `farsa run` and `farsa sweep`, the default one of `farsa test`.
pub(crate) const TEST_SEED: u64 = 1;

/// Most lines that a terminal shows, and the lines of a longer table.
const MAX_SHOWN: usize = 200;
const SHOWN: usize = 20;

/// Result of a test.
#[derive(Debug, Serialize)]
pub(crate) struct TestRun {
    directory: String,
    generation: u32,
    individual: u32,
    /// Champions of all populations, if there are several.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    individuals: Vec<u32>,
    seed: u64,
    #[serde(flatten)]
    pub(crate) findings: Findings,
    /// Combination of trials into the fitness of a run. Empty for a single trial.
    #[serde(rename = "fitness_of_run", skip_serializing_if = "String::is_empty")]
    combined: String,
    /// That the champion may behave otherwise than in its run.
    warning: Option<String>,
    /// Why the first of the trials that failed did, if any did.
    #[serde(skip_serializing_if = "Option::is_none")]
    failure: Option<String>,
    #[serde(skip)]
    table: Table,
}

impl TestRun {
    /// Formats the table and its summary as text. A terminal shows a part of a long table.
    pub(crate) fn text(&self, is_terminal: bool) -> String {
        let Self { generation, individual, seed, .. } = self;
        let table = self.table.aligned();
        let mut text = if is_terminal { shortened(table) } else { table };
        // Writing into a string cannot fail.
        let _ = writeln!(text, "\n{}, test seed {seed}", whose(*generation, *individual, &self.individuals));
        text.push_str(&self.findings.text());
        if !self.combined.is_empty() {
            let _ = writeln!(text, "fitness of a run: {}", self.combined);
        }
        if let Some(warning) = &self.warning {
            let _ = writeln!(text, "warning: {warning}");
        }
        if let Some(failure) = &self.failure {
            let _ = writeln!(text, "{failure}");
        }
        text
    }
}

/// Shortens a long table.
fn shortened(table: String) -> String {
    let Some(trials) = table.lines().count().checked_sub(1).filter(|trials| *trials > MAX_SHOWN) else { return table };
    let lines = table.lines().take(1 + SHOWN).collect::<Vec<_>>().join("\n");
    format!("{lines}\n... {} more trials; for all add `| less`\n", trials - SHOWN)
}

/// Runs `trials` fresh trials of the champion and writes `test.csv`. Writes no file for another individual, such as one
/// of an archive.
///
/// Trial i of the test is trial i modulo the experiment's number of trials, with its own random numbers. The champions
/// of several populations compete: each trial runs once for each of them, with the same numbers.
pub(crate) fn test(
    plan: &Plan<'_>,
    directory: &Directory,
    other: Option<Selection>,
    trials: usize,
    seed: u64,
    threads: usize,
    lanes: LaneRequest,
    quiet: bool,
) -> Result<TestRun, Error> {
    Ok(test_until(&AtomicBool::new(false), plan, directory, other, trials, seed, threads, lanes, quiet)?)
}

/// Tests as [`test`] does, until `stop` becomes true.
///
/// # Errors
/// [`Unfinished::Stopped`] if the test was stopped, after which no file is written.
pub(crate) fn test_until(
    stop: &AtomicBool,
    plan: &Plan<'_>,
    directory: &Directory,
    other: Option<Selection>,
    trials: usize,
    seed: u64,
    threads: usize,
    lanes: LaneRequest,
    quiet: bool,
) -> Result<TestRun, Unfinished> {
    let mut pool = Pool::new(plan, threads, lanes)?;
    let subject = match other {
        Some(which) => Subject::find(plan, directory, &pool, which)?,
        None => Subject::read(plan, directory, &pool)?,
    };
    if other.is_none() {
        // An occupied directory is reported before the computation.
        drop(Lock::of_tests(directory.path())?);
    }
    let progress = Progress::of_trials(trials, quiet);
    let results = run_trials(&mut pool, subject.tested(), Trials::plain(trials, seed), stop, &progress);
    drop(progress);
    let results = results?;

    let info = pool.info();
    let failure = failure(&results);
    let table = Table::new(&Columns::new(info, subject.count()), &results);
    let (findings, combined) = (table.findings(&info.terms), info.combined());
    let Subject { generation, individual, individuals, warning, .. } = subject;
    if other.is_none() {
        let path = directory.test();
        let bytes = table.csv(&path)?;
        let record = |table_crc| {
            let record = Record { generation, individual, trials, seed, table_crc };
            Recorded { record, results: &findings }
        };
        recorded::write(directory.path(), (&path, &bytes), &directory.test_record(), record)?;
    }
    let directory = directory.path().display().to_string();
    let run =
        TestRun { directory, generation, individual, individuals, seed, findings, combined, warning, failure, table };
    Ok(run)
}

/// Whom a test is about, in words.
pub(crate) fn whose(generation: u32, individual: u32, individuals: &[u32]) -> String {
    match individuals {
        [] => format!("individual {individual} of generation {generation}"),
        all => {
            let all = all.iter().map(ToString::to_string).collect::<Vec<_>>().join(", ");
            format!("individuals {all} of generation {generation} against each other")
        }
    }
}

/// Returns the number of the first failed trial with its reason, if any failed.
pub(crate) fn failure(results: &[TrialResult]) -> Option<String> {
    let failed = results.iter().enumerate().find_map(|(number, result)| Some((number, result.failure.as_ref()?)));
    failed.map(|(number, why)| format!("line {number} of the test failed: {why}"))
}

/// A run's champion or another individual, or one of each of its populations, ready to be tested.
pub(crate) struct Subject {
    pub(crate) generation: u32,
    pub(crate) individual: u32,
    /// Individuals of all populations, if there are several.
    pub(crate) individuals: Vec<u32>,
    /// That the champion may behave otherwise than in its run.
    pub(crate) warning: Option<String>,
    parameters: Vec<Vec<f32>>,
    size: usize,
    normalisation: Option<ObservationStatistics>,
}

impl Subject {
    /// Reads the champions of a run.
    ///
    /// # Errors
    /// [`Error::File`] for a run without champions or of another experiment, [`Error::Io`].
    pub(crate) fn read(plan: &Plan<'_>, directory: &Directory, pool: &Pool<'_>) -> Result<Self, Error> {
        let path = directory.champion();
        if !path.is_file() && directory.checkpoint().is_file() {
            return Err(Error::damaged(&path, "there is none: no generation is finished yet"));
        }
        let Champions { identity, generation, best, normalisation } = Champions::read(plan, directory)?;
        let parameters: Option<Vec<Vec<f32>>> = best.iter().map(|best| best.genes.decode(pool.genotype())).collect();
        let parameters = parameters.filter(|rows| rows.len() == pool.info().populations.len());
        let Some(parameters) = parameters else {
            return Err(Error::damaged(&path, "its genome is not one of the experiment"));
        };
        let warning = identity.same_values(&plan.identity()?, &path).err().map(|error| error.to_string());
        let size = if best.len() > 1 { plan.size()? } else { 0 };
        let Some(&Best { individual, .. }) = best.first() else {
            return Err(Error::damaged(&path, "it has no individual"));
        };
        let individuals = if best.len() > 1 { best.iter().map(|best| best.individual).collect() } else { Vec::new() };
        Ok(Self { generation, individual, individuals, warning, parameters, size, normalisation })
    }

    /// Finds an individual of a finished generation, by default its best. Its opponents are the best of the other
    /// populations.
    ///
    /// # Errors
    /// As for [`LocatedIndividual::new`], and [`Error::File`].
    fn find(plan: &Plan<'_>, directory: &Directory, pool: &Pool<'_>, which: Selection) -> Result<Self, Error> {
        let LocatedIndividual { history, path, generation, individual } =
            LocatedIndividual::new(plan, directory, which)?;
        let (size, own) = (history.size(), individual as usize / history.size().max(1));
        let best = |population| {
            if population == own { Some(individual as usize) } else { history.champion(population, generation) }
        };
        let others = || Error::damaged(&path, "its genomes are not those of the experiment");
        let best: Vec<usize> = (0..history.populations()).map(best).collect::<Option<_>>().ok_or_else(others)?;
        let wanted: Vec<(u32, usize)> = best.iter().map(|&individual| (generation, individual)).collect();
        let genomes = history.genomes(&wanted)?;
        let parameters: Option<Vec<_>> = genomes.iter().map(|genes| genes.decode(pool.genotype())).collect();
        let parameters = parameters.filter(|rows| rows.len() == pool.info().populations.len());
        let several = best.len() > 1;
        Ok(Self {
            generation,
            individual: best.first().map_or(individual, |&first| first as u32),
            individuals: if several { best.iter().map(|&individual| individual as u32).collect() } else { Vec::new() },
            warning: None,
            parameters: parameters.ok_or_else(others)?,
            size: if several { size } else { 0 },
            normalisation: history.normalisation(generation).cloned(),
        })
    }

    /// Returns the evaluated parameters.
    pub(crate) fn tested(&self) -> Tested<'_> {
        Tested { parameters: &self.parameters, size: self.size, normalisation: self.normalisation.as_ref() }
    }

    /// Champions, one of each population.
    pub(crate) fn count(&self) -> usize {
        self.parameters.len()
    }
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

/// Condition of a trial: a case of a protocol, a change of the controller, both, or neither.
#[derive(Clone, Copy, Default)]
pub(crate) struct TrialCondition<'t> {
    pub(crate) case: Option<CaseId>,
    pub(crate) intervention: Option<&'t Intervention>,
}

/// Fresh trials, the same for every case.
#[derive(Clone, Copy)]
pub(crate) struct Trials<'t> {
    /// Trials per case.
    pub(crate) count: usize,
    pub(crate) seed: u64,
    /// At least one.
    pub(crate) cases: &'t [TrialCondition<'t>],
}

impl Trials<'_> {
    /// Trials of no protocol.
    pub(crate) fn plain(count: usize, seed: u64) -> Self {
        Self { count, seed, cases: &[TrialCondition { case: None, intervention: None }] }
    }
}

/// Evaluates fresh trials of some parameters, case after case, until `stop` becomes true.
pub(crate) fn run_trials(
    pool: &mut Pool<'_>,
    tested: Tested<'_>,
    trials: Trials<'_>,
    stop: &AtomicBool,
    progress: &Progress,
) -> Result<Vec<TrialResult>, Unfinished> {
    let Tested { parameters: champions, size, normalisation } = tested;
    let (count, kinds) = (champions.len().max(1), pool.info().trials.max(1));
    let others_of = |own: usize| champions.iter().enumerate().filter(move |(other, _)| *other != own);
    let others: Vec<Vec<&[f32]>> =
        (0..champions.len()).map(|own| others_of(own).map(|(_, other)| other.as_slice()).collect()).collect();
    let task = |number: usize| {
        let (population, trial) = (number % count, number / count % trials.count);
        let TrialCondition { case, intervention } = *trials.cases.get(number / count / trials.count)?;
        let id = EpisodeId { individual: (population * size) as u32, ..episode(trial, kinds, trials.seed) };
        let (parameters, opponents) = (champions.get(population)?, others.get(population)?);
        let plain = Evaluation::new(parameters, id);
        Some(Evaluation { number, opponents, normalisation, case, intervention, ..plain })
    };
    let done = |number: usize, _: Option<&Outcome>| {
        if number.is_multiple_of(count) {
            progress.advance();
        }
    };
    let evaluations = trials.count * trials.cases.len();
    let outcomes = pool.evaluate(evaluations * count, stop, task, done)?;
    let (evaluator, names) = (pool.evaluator(), &pool.info().populations);
    let mut results: Vec<TrialResult> = Vec::with_capacity(evaluations);
    for (number, outcome) in outcomes.into_iter().flatten().enumerate() {
        let fitness = if outcome.is_finite() { evaluator.fitness(std::slice::from_ref(&outcome)) } else { f64::NAN };
        let failure = if fitness.is_finite() { None } else { why_failed(evaluator, &outcome) };
        if let Some(first) = results.last_mut().filter(|_| !number.is_multiple_of(count)) {
            let name = names.get(number % count).map_or("", String::as_str);
            first.failure = first.failure.take().or_else(|| Some(format!("population {name}: {}", failure?)));
            first.others.push((fitness, outcome.success && fitness.is_finite()));
        } else {
            let trial = (number / count % trials.count % kinds) as u32;
            results.push(TrialResult { trial, outcome, fitness, failure, others: Vec::new() });
        }
    }
    Ok(results)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_terminal_shows_a_part_of_a_long_table() {
        let table = |trials: usize| (0..=trials).map(|line| line.to_string() + "\n").collect::<Vec<_>>().concat();
        assert_eq!(shortened(table(MAX_SHOWN)), table(MAX_SHOWN));
        let rest = "... 181 more trials; for all add `| less`\n";
        assert_eq!(shortened(table(MAX_SHOWN + 1)), table(SHOWN) + rest);
    }
}
