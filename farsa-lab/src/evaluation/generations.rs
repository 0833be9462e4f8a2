//! `test-generations.csv`: the best of every n-th generation on fresh starts.

use std::path::Path;
use std::sync::atomic::AtomicBool;

use serde::{Deserialize, Serialize};

use crate::error::Error;
use crate::evaluation::recorded::{self, TableRecord};
use crate::evaluation::test::{Tested, Trials, run_trials};
use crate::evaluation::test_table::{Columns, Table};
use crate::experiment::lanes::LaneRequest;
use crate::run::evaluation_backend::Unfinished;
use crate::run::plan::Plan;
use crate::run::pool::Pool;
use crate::run::progress::Progress;
use crate::run::record_file::history;
use crate::store::directory::Directory;
use crate::store::lock::Lock;
use crate::strategy::history::History;

/// First line of the table.
const HEAD: [&str; 6] = ["generation", "individual", "trials", "broken down", "successes", "fitness"];

/// Tested generations and the trials of each test.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
pub(crate) struct Sampling {
    /// Generations from one tested generation to the next. The first is generation 0.
    pub(crate) every: u32,
    /// Trials of each test.
    pub(crate) trials: u32,
    pub(crate) seed: u64,
}

/// Content of `test-generations.json`.
#[derive(Serialize, Deserialize)]
struct Record {
    #[serde(flatten)]
    sampling: Sampling,
    table_crc: u32,
}

impl TableRecord for Record {
    fn table_crc(&self) -> u32 {
        self.table_crc
    }
}

/// Tests of the best of some generations.
#[derive(Debug, PartialEq)]
pub(crate) struct SampledTests {
    pub(crate) sampling: Sampling,
    /// Tests in the order of the generations.
    pub(crate) rows: Vec<SampledTest>,
}

/// Test of the best of a generation.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct SampledTest {
    pub(crate) generation: u32,
    pub(crate) individual: u32,
    broken_down: usize,
    /// `None` without a criterion of success.
    successes: Option<usize>,
    /// Mean fitness of the trials that did not break down, NaN without any.
    fitness: f64,
}

impl SampledTests {
    /// Finds the last test up to a generation.
    fn at(&self, generation: usize) -> Option<&SampledTest> {
        let after = self.rows.partition_point(|row| row.generation as usize <= generation);
        self.rows.get(after.checked_sub(1)?)
    }

    /// Returns the share of successful trials in the last test up to a generation, NaN without one.
    pub(crate) fn success(&self, generation: usize) -> f64 {
        let trials = self.sampling.trials as usize;
        let row = self.at(generation).filter(|row| row.broken_down < trials);
        row.and_then(|row| row.successes).map_or(f64::NAN, |successes| successes as f64 / trials as f64)
    }

    /// Returns the mean fitness in the last test up to a generation, NaN without one.
    pub(crate) fn fitness(&self, generation: usize) -> f64 {
        self.at(generation).map_or(f64::NAN, |row| row.fitness)
    }

    /// Returns true if the task has a criterion of success.
    pub(crate) fn has_success(&self) -> bool {
        self.rows.iter().any(|row| row.successes.is_some())
    }
}

/// Reads the tests of a directory, `None` without complete ones.
///
/// # Errors
/// [`Error::Io`], and [`Error::File`] for an invalid table.
pub(crate) fn read(directory: &Directory) -> Result<Option<SampledTests>, Error> {
    let [table, record] = directory.sampled_tests();
    let Some((text, Some(Record { sampling, .. }))) = recorded::read(&table, &record)? else { return Ok(None) };
    let rows = parse(&text, sampling.trials).map_err(|why| Error::damaged(&table, why))?;
    Ok(Some(SampledTests { sampling, rows }))
}

fn parse(text: &str, trials: u32) -> Result<Vec<SampledTest>, String> {
    let mut reader = csv::Reader::from_reader(text.as_bytes());
    if reader.headers().map_err(|error| error.to_string())?.iter().ne(HEAD) {
        return Err("is not the table of tested generations".into());
    }
    let row = |fields: &csv::StringRecord| {
        let [generation, individual, count, broken_down, successes, fitness] = [0, 1, 2, 3, 4, 5].map(|at| &fields[at]);
        let successes = if successes.is_empty() { None } else { Some(successes.parse().ok()?) };
        let row = SampledTest {
            generation: generation.parse().ok()?,
            individual: individual.parse().ok()?,
            broken_down: broken_down.parse().ok()?,
            successes,
            fitness: fitness.parse().ok()?,
        };
        Some(row).filter(|_| count.parse() == Ok(trials))
    };
    let mut rows: Vec<SampledTest> = Vec::new();
    for (number, fields) in reader.records().enumerate() {
        let fields = fields.map_err(|error| error.to_string())?;
        let next = row(&fields).filter(|next| rows.last().is_none_or(|last| last.generation < next.generation));
        rows.push(next.ok_or_else(|| format!("line {} is not the test of a generation", number + 2))?);
    }
    Ok(rows)
}

/// Tests the best of every n-th finished generation and writes the table, unless the same tests are there.
///
/// The best of several populations compete, and the table has the results of the first one. All generations have the same starts.
///
/// # Errors
/// [`Unfinished::Stopped`] after `stop` became true, when no file is written. The errors of reading the run and of a test, and
/// [`Error::File`] while another process writes a test.
pub(crate) fn test(
    stop: &AtomicBool,
    plan: &Plan<'_>,
    directory: &Directory,
    sampling: Sampling,
    (threads, lanes): (usize, LaneRequest),
    quiet: bool,
) -> Result<(), Unfinished> {
    let (identity, history, path) = history(plan, directory)?;
    identity.same_values(&plan.identity()?, &path)?;
    let generations: Vec<u32> = (0..history.finished()).step_by(sampling.every.max(1) as usize).collect();
    let is_same = |found: &SampledTests| {
        let places = found.rows.iter().map(|row| (row.generation, Some(row.individual as usize)));
        found.sampling == sampling
            && places.eq(generations.iter().map(|&generation| (generation, history.champion(0, generation))))
    };
    if read(directory)?.as_ref().is_some_and(is_same) {
        return Ok(());
    }
    // An occupied directory is reported before the computation.
    drop(Lock::of_tests(directory.path())?);
    let progress = Progress::of_trials(sampling.trials as usize * generations.len(), quiet);
    let pool = Pool::new(plan, threads, lanes)?;
    let rows = rows(plan, (&history, &path), &generations, sampling, pool, (stop, &progress))?;
    drop(progress);
    let [table, record] = directory.sampled_tests();
    let bytes = csv(&rows, sampling.trials).map_err(|error| Error::damaged(&table, error))?;
    Ok(recorded::write(directory.path(), (&table, &bytes), &record, |table_crc| Record { sampling, table_crc })?)
}

/// Evaluates the best of some generations.
fn rows(
    plan: &Plan<'_>,
    (history, path): (&History<'_>, &Path),
    generations: &[u32],
    sampling: Sampling,
    mut pool: Pool<'_>,
    (stop, progress): (&AtomicBool, &Progress),
) -> Result<Vec<SampledTest>, Unfinished> {
    let others = || Error::damaged(path, "its genomes are not those of the experiment");
    let populations = history.populations();
    let best = |&generation: &u32| {
        let best = (0..populations).map(move |population| history.champion(population, generation));
        best.map(move |best| Some((generation, best?)))
    };
    let best: Vec<(u32, usize)> = generations.iter().flat_map(best).collect::<Option<_>>().ok_or_else(others)?;
    let genomes = history.genomes(&best)?;
    let trials = sampling.trials as usize;
    let size = if populations > 1 { plan.size()? } else { 0 };
    let mut rows = Vec::new();
    for (best, genomes) in best.chunks(populations).zip(genomes.chunks(populations)) {
        let parameters = genomes.iter().map(|genes| genes.decode(pool.genotype())).collect::<Option<Vec<_>>>();
        let parameters = parameters.filter(|rows| rows.len() == pool.info().populations.len()).ok_or_else(others)?;
        let (generation, individual) = best.first().map_or((0, 0), |&(generation, best)| (generation, best as u32));
        let tested = Tested { parameters: &parameters, size, normalisation: history.normalisation(generation) };
        let results = run_trials(&mut pool, tested, Trials::plain(trials, sampling.seed), stop, progress)?;
        let info = pool.info();
        let findings = Table::new(&Columns::new(info, populations), &results).findings(&info.terms);
        let (broken_down, successes, fitness) = (findings.broken_down, findings.successes, findings.fitness);
        rows.push(SampledTest { generation, individual, broken_down, successes, fitness });
    }
    Ok(rows)
}

fn csv(rows: &[SampledTest], trials: u32) -> Result<Vec<u8>, csv::Error> {
    let mut writer = csv::Writer::from_writer(Vec::new());
    writer.write_record(HEAD)?;
    for SampledTest { generation, individual, broken_down, successes, fitness } in rows {
        let numbers = [generation.to_string(), individual.to_string(), trials.to_string(), broken_down.to_string()];
        let successes = successes.map_or_else(String::new, |successes| successes.to_string());
        // The debug form is the shortest that reads back as the same number.
        writer.write_record(numbers.into_iter().chain([successes, format!("{fitness:?}")]))?;
    }
    writer.into_inner().map_err(|error| csv::Error::from(std::io::Error::other(error.to_string())))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn tests() -> SampledTests {
        let row = |generation, successes, broken_down, fitness| SampledTest {
            generation,
            individual: 3,
            broken_down,
            successes,
            fitness,
        };
        let rows = vec![row(0, Some(0), 0, 0.1), row(10, Some(5), 2, 1e-300), row(20, Some(0), 20, f64::NAN)];
        SampledTests { sampling: Sampling { every: 10, trials: 20, seed: 1 }, rows }
    }

    #[test]
    fn a_test_counts_until_the_next_one() {
        let tests = tests();
        let success = [0, 9, 10, 19].map(|generation| tests.success(generation));
        assert_eq!(success, [0.0, 0.0, 0.25, 0.25]);
        assert_eq!([0, 9, 10].map(|generation| tests.fitness(generation)), [0.1, 0.1, 1e-300]);
        assert!(tests.success(20).is_nan() && tests.fitness(1000).is_nan());
        let none = SampledTests { rows: Vec::new(), ..tests };
        assert!(none.success(5).is_nan() && none.fitness(5).is_nan() && !none.has_success());
    }

    #[test]
    fn a_table_is_read_back_and_a_wrong_line_is_named() {
        let rows = tests().rows;
        let text = String::from_utf8(csv(&rows, 20).unwrap()).unwrap();
        assert_eq!(
            text,
            "generation,individual,trials,broken down,successes,fitness\n0,3,20,0,0,0.1\n10,3,20,2,5,1e-300\n20,3,20,20,0,NaN\n"
        );
        let same = |found: &[SampledTest]| found[..2] == rows[..2] && found[2].fitness.is_nan() && found.len() == 3;
        assert!(same(&parse(&text, 20).unwrap()));
        let wrong = |from: &str, to: &str| parse(&text.replace(from, to), 20).unwrap_err();
        assert_eq!(wrong("10,3,20,2", "0,3,20,2"), "line 3 is not the test of a generation");
        assert_eq!(wrong("20,3,20,20", "20,3,20,x"), "line 4 is not the test of a generation");
        assert_eq!(wrong("0,3,20,0,0", "0,3,19,0,0"), "line 2 is not the test of a generation");
        assert_eq!(wrong("individual", "which"), "is not the table of tested generations");
    }
}
