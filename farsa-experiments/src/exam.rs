//! `farsa test`: the champion on starts that it has never met.

use std::fmt::Write as _;
use std::fs;
use std::sync::atomic::AtomicBool;

use farsa_num::crc32;
use serde::{Deserialize, Serialize};

use crate::directory::{Directory, replace};
use crate::error::Error;
use crate::exam_table::{Findings, Table};
use crate::experiment::Task;
use crate::lanes::Wanted;
use crate::life::Job;
use crate::plan::{LARGEST_SEED, Plan};
use crate::pool::{Pool, Unfinished};
use crate::progress::Progress;
use crate::records::{self, Champion};

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

impl Record {
    /// The record of the test that a directory holds; none if it was made before there were records.
    ///
    /// # Errors
    /// [`Error::Io`], [`Error::Damaged`].
    pub(crate) fn read(directory: &Directory) -> Result<Option<Self>, Error> {
        let path = directory.test_record();
        if !path.is_file() {
            return Ok(None);
        }
        let text = fs::read_to_string(&path).map_err(Error::io("read", &path))?;
        let record: Self = serde_json::from_str(&text).map_err(|error| Error::damaged(&path, error))?;
        let table = fs::read(directory.test()).map_err(Error::io("read", &directory.test()))?;
        Ok((crc32(&table) == record.table_crc).then_some(record))
    }
}

/// What a test found.
#[derive(Debug, Serialize)]
pub(crate) struct Exam {
    directory: String,
    generation: u32,
    individual: u32,
    seed: u64,
    #[serde(flatten)]
    findings: Findings,
    /// That the champion may behave otherwise than in its run.
    warning: Option<String>,
    #[serde(skip)]
    table: Table,
}

impl Exam {
    /// A table for reading, and what it says together.
    pub(crate) fn text(&self) -> String {
        let Self { generation, individual, seed, .. } = self;
        let mut text = self.table.aligned();
        // Writing into a string cannot fail.
        let _ = writeln!(text, "\nindividual {individual} of generation {generation}, test seed {seed}");
        text.push_str(&self.findings.text());
        if let Some(warning) = &self.warning {
            let _ = writeln!(text, "warning: {warning}");
        }
        text
    }
}

/// Lives `trials` fresh trials of the champion and writes `test.csv`.
///
/// Trial i of the test is trial i modulo the experiment's number of trials, with random numbers of its own.
pub(crate) fn test(
    plan: &Plan<'_>,
    directory: &Directory,
    trials: usize,
    seed: u64,
    threads: usize,
    lanes: Wanted,
    quiet: bool,
) -> Result<Exam, Error> {
    let path = directory.champion();
    if !path.is_file() && directory.checkpoint().is_file() {
        return Err(Error::damaged(&path, "there is none: no generation is finished yet"));
    }
    let Champion { identity, generation, individual, genes, .. } = records::read(&path, plan, directory.path())?;
    let mut pool = Pool::new(plan, threads, lanes)?;
    if genes.len() != pool.setup().genes() {
        return Err(Error::damaged(&path, "its genome is not one of the experiment"));
    }
    let warning = identity.same_values(&plan.identity(), &path).err().map(|error| error.to_string());

    let progress = Progress::new(0, trials as u64, quiet);
    let kinds = pool.setup().trials().max(1);
    let task = |number: usize| {
        let (round, trial) = ((number / kinds) as u32, (number % kinds) as u32);
        let job = Job { seed: seed | !LARGEST_SEED, generation: round, individual: 0, trial };
        Some(Task { number, genes: &genes, job })
    };
    let results = pool.live(trials, &AtomicBool::new(false), task, |_, _| progress.advance());
    drop(progress);
    let results = results.map_err(|reason| match reason {
        Unfinished::Panicked => Error::Panicked { generation },
        Unfinished::Stopped => Error::Other("stopped".into()),
    })?;
    let results: Vec<_> = results
        .into_iter()
        .flatten()
        .enumerate()
        .map(|(number, outcome)| {
            let alone = std::slice::from_ref(&outcome);
            let fitness = if outcome.is_finite() { pool.setup().fitness(alone) } else { f64::NAN };
            ((number % kinds) as u32, outcome, fitness)
        })
        .collect();

    let terms = pool.setup().terms();
    let table = Table::new(&terms, &results);
    let bytes = table.write(&directory.test())?;
    let record = Record { generation, individual, trials, seed, table_crc: crc32(&bytes) };
    let text = serde_json::to_string_pretty(&record).map_err(|error| Error::Other(error.to_string()))?;
    replace(&directory.test_record(), format!("{text}\n").as_bytes())?;
    let (path, findings) = (directory.path().display().to_string(), table.findings(&terms));
    Ok(Exam { directory: path, generation, individual, seed, findings, warning, table })
}
