//! Readers of a run's files, configurations, command lines and lines of an optimiser, one call each: for the fuzz targets
//! in `fuzz/`.
//!
//! The command has one public entry, [`Laboratory::main`], which reads the arguments of the process, starts threads and writes
//! files. A fuzz target calls a reader ten million times. This module is hidden behind a feature, is not part of the interface,
//! and may change with any version. Directories of runs have a public reader, [`RunDirectory`](crate::advanced::RunDirectory).

use std::fs;
use std::path::Path;

use farsa_evo::{EvoError, Scores};

use crate::command::{cli, manual};
use crate::error::Error;
use crate::evaluation::genotypes::{Shape, written, written_reals};
use crate::evaluation::lines::{Request, RequestSchema};
use crate::evaluation::protocols::case_summary::CaseSummary;
use crate::evaluation::protocols::files::ProtocolRecord;
use crate::evaluation::protocols::states::States;
use crate::evaluation::protocols::table::ProtocolTable;
use crate::evaluation::test::Record as TestRecord;
use crate::evaluation::test_table::Table;
use crate::experiment::evaluator::Evaluator;
use crate::experiment::genotype::Genotype;
use crate::experiment::parameter::Parameter;
use crate::run::config_file::ConfigFile;
use crate::run::laboratory::Laboratory;
use crate::run::plan::Plan;
use crate::run::record_file::RunRecord;
use crate::run::records::Checkpoint;
use crate::store::append_log::Mark;
use crate::store::checksummed;
use crate::store::directory::Directory;
use crate::store::failures::Failures;
use crate::store::lineage::{HEADER, Lineage};
use crate::store::log::{Log, header};
use crate::store::manifest::Manifest;
use crate::strategy::any_strategy::{AnyStrategy, Genome};
use crate::sweep::Study;

/// A reader of command lines. Creating it takes a hundred times as long as reading one.
pub struct CommandLineReader(clap::Command);

impl CommandLineReader {
    /// That of the command over a laboratory.
    pub fn new(laboratory: &Laboratory<'_>) -> Self {
        Self(manual::command("farsa", laboratory))
    }

    /// Reads a command line and executes nothing.
    ///
    /// # Errors
    /// The message of the command.
    pub fn read(&mut self, words: &[&str]) -> Result<(), String> {
        cli::read_by(&mut self.0, words).map(drop).map_err(|error| error.to_string())
    }
}

/// Reads a configuration, and writes it as a run keeps it.
///
/// # Errors
/// The error in the text.
pub fn read_configuration(laboratory: &Laboratory<'_>, text: &str) -> Result<String, Error> {
    Plan::from_file(laboratory, &ConfigFile::parse("config.toml", text)?)?.to_toml()
}

/// Reads the file of a sweep or of checks.
///
/// # Errors
/// The error in the text.
pub fn read_sweep(text: &str) -> Result<(), Error> {
    Study::parse("sweep.toml", text, false).map(drop)
}

/// Reads a table of trials and writes it again.
///
/// # Errors
/// The error in the text.
pub fn read_trials(text: &str, terms: &[String]) -> Result<Vec<u8>, Error> {
    let path = Path::new("test.csv");
    let table = Table::from_text(path, text)?;
    let (findings, _) = (table.findings(terms).text(), table.aligned());
    drop(findings);
    table.csv(path)
}

/// Reads the table of a protocol and writes it again.
///
/// # Errors
/// The error in the text.
pub fn read_cases(text: &str, terms: &[String]) -> Result<Vec<u8>, Error> {
    let path = Path::new("cases.csv");
    let table = ProtocolTable::from_text(path, text)?;
    for found in CaseSummary::all(&table, terms) {
        drop(found.case());
    }
    table.csv(path)
}

/// Reads the states of neurons and writes them again.
///
/// # Errors
/// The error in the text.
pub fn read_states(text: &str) -> Result<Vec<u8>, Error> {
    let path = Path::new("states.csv");
    States::from_text(text).map_err(|why| Error::damaged(path, why))?.csv(path)
}

/// Reads the records of a test and of a protocol's, and writes the one that it is.
///
/// # Errors
/// That it is neither.
pub fn read_test_record(text: &str) -> Result<String, Error> {
    // The record of a protocol has all that a test's has, and so is one of a test, too.
    let written = match serde_json::from_str::<ProtocolRecord>(text) {
        Ok(record) => serde_json::to_string(&record),
        Err(_) => serde_json::from_str::<TestRecord>(text).and_then(|record| serde_json::to_string(&record)),
    };
    written.map_err(|error| Error::damaged(Path::new("test.json"), error))
}

/// Reads a manifest and writes it again.
///
/// # Errors
/// The error in the text.
pub fn read_manifest(text: &str) -> Result<String, Error> {
    let path = Path::new("manifest.json");
    let manifest = Manifest::from_text(path, text)?;
    manifest.sessions.iter().for_each(|session| drop((session.machine.cores(), session.machine.describe())));
    manifest.text(path)
}

/// Reads genotypes of three genes of eight bits, or a list of three reals, and writes them again.
///
/// # Errors
/// The error in the text.
pub fn read_genotypes(text: &str) -> Result<String, Error> {
    let genomes = Shape::new(3, 8).genomes(Path::new("genotypes.gen"), text)?;
    let texts = genomes.iter().map(|genome| match genome {
        Genome::Words(genes) => written("s", genes),
        Genome::Reals(genes) => written_reals(genes),
    });
    Ok(texts.collect())
}

/// A reader of an optimizer's lines, with two parameters of each individual, for one population or two.
pub struct RequestReader([RequestSchema; 2]);

impl Default for RequestReader {
    fn default() -> Self {
        let parameters = vec![Parameter::new("gain", [-5.0, 5.0]), Parameter::new("bias", [1.0, 0.0])];
        let of = |names: &[&str], size| RequestSchema {
            experiment: "tune",
            populations: names.iter().map(|&name| name.into()).collect(),
            parameters: parameters.clone(),
            genotype: Genotype::new(&parameters, 16),
            size,
            seed: 1,
            limits: crate::limits::Limits::DEFAULT,
        };
        Self([of(&["only"], 0), of(&["prey", "hunter"], 100)])
    }
}

impl RequestReader {
    /// Reads a line, and writes another with the same request.
    ///
    /// # Errors
    /// The error of the answer.
    pub fn read(&self, several: bool, line: &[u8]) -> Result<String, String> {
        let wanted = &self.0[usize::from(several)];
        let Request { id, seed, generation, individual, parameters, evaluated } = Request::from_line(line, wanted)?;
        let names = || wanted.populations.iter();
        let mut all = serde_json::json!({ "seed": seed, "generation": generation, "individual": individual });
        all["evaluate"] = names().zip(evaluated).filter_map(|(name, evaluated)| evaluated.then_some(&**name)).collect();
        all["parameters"] = match parameters.as_slice() {
            [only] => serde_json::json!(only),
            several => names().cloned().zip(several.iter().map(|rows| serde_json::json!(rows))).collect(),
        };
        if let Some(id) = id {
            all["id"] = id;
        }
        Ok(all.to_string())
    }
}

/// A reader of the files of one run.
pub struct RunReader<'l> {
    plan: Plan<'l>,
    evaluator: Box<dyn Evaluator>,
    genotype: Genotype,
}

impl<'l> RunReader<'l> {
    /// A reader of runs of this configuration.
    ///
    /// # Errors
    /// The error in the text.
    pub fn new(laboratory: &Laboratory<'l>, configuration: &str) -> Result<Self, Error> {
        let plan = Plan::from_file(laboratory, &ConfigFile::parse("config.toml", configuration)?)?;
        let evaluator = plan.evaluator()?;
        let genotype = plan.genotype(evaluator.as_ref());
        Ok(Self { plan, evaluator, genotype })
    }

    /// Builds the head of the record of a run that has no generation yet.
    ///
    /// # Errors
    /// An error of the identity.
    pub fn record_head(&self) -> Result<Vec<u8>, Error> {
        let strategy = self.plan.definition().name().to_owned();
        let head = crate::run::records::RecordHead { identity: self.plan.identity()?, strategy };
        checksummed::to_bytes(Path::new("record.bin"), &head)
    }

    /// Reads a checkpoint, continues from its state for a generation, and writes it.
    ///
    /// # Errors
    /// The error in the text.
    ///
    /// # Panics
    /// When a state that was restored is saved as another.
    pub fn checkpoint(&self, bytes: &[u8]) -> Result<Vec<u8>, Error> {
        let path = Path::new("checkpoint.bin");
        let damaged = |error: EvoError| Error::damaged(path, error);
        let checkpoint: Checkpoint = checksummed::open(bytes).map_err(|why| Error::damaged(path, why))?;
        self.plan.same_run(&checkpoint.identity, Path::new("."))?;
        let written = checksummed::to_bytes(path, &checkpoint)?;
        let mut search = self.plan.strategy()?;
        if let (Some(state), Some(strategy)) = (&checkpoint.state, search.snapshot()) {
            strategy.restore(state).map_err(damaged)?;
            let saved = strategy.save();
            strategy.restore(&saved).map_err(damaged)?;
            assert!(strategy.save() == saved, "a state that was restored is saved as another");
            self.go_on(&mut search).map_err(damaged)?;
        }
        Ok(written)
    }

    /// Reads a record with the given number of generations, and rebuilds the genomes of each.
    ///
    /// # Errors
    /// The error in the text.
    ///
    /// # Panics
    /// When an entry that was read is written as another.
    pub fn record(&self, content: &[u8], generation: u32) -> Result<(), Error> {
        let (directory, nothing) = (Directory::at(".".into()), Mark::default());
        let record = Mark::of(content);
        let identity = self.plan.identity()?;
        let checkpoint = Checkpoint { identity, generation, record, lineage: nothing, failures: nothing, state: None };
        let told = RunRecord::from_content(&self.plan, &directory, &checkpoint, content.into())?;
        let damaged = |error: EvoError| Error::damaged(&directory.record(), error);
        let mut search = self.plan.strategy()?;
        let mut again = self.plan.strategy()?.record().map_err(damaged)?;
        for number in 0..generation {
            search.genomes(&told.record, number).map_err(damaged)?;
            let entry = told.record.entry(number).ok_or_else(|| Error::damaged(&directory.record(), "has no entry"))?;
            again.push(entry).map_err(damaged)?;
            assert!(again.entry(number) == Some(entry), "an entry that was read is written as another");
        }
        search.rebuild(&told.record, generation).map_err(damaged)?;
        self.go_on(&mut search).map_err(damaged)
    }

    /// Takes up the logs of a directory where a run without a generation left them: what is in `fitness.csv`, `lineage.csv` and
    /// `failures.csv`. Returns whether the log was kept under another name.
    ///
    /// # Errors
    /// The error in the text.
    ///
    /// # Panics
    /// When a resumed log differs from that of the run.
    pub fn logs(&self, path: &Path) -> Result<bool, Error> {
        let directory = Directory::at(path.into());
        let populations = self.evaluator.info().populations;
        let (_, kept) = Log::resume(&directory.log(), &[], &populations)?;
        let written = fs::read(directory.log()).map_err(Error::io("read", &directory.log()))?;
        assert!(written == header(&populations).as_bytes(), "a resumed log has other content");
        let lineage = Mark::of(HEADER.as_bytes());
        Lineage::resume(&directory.lineage(), lineage, |_| Ok(()))?;
        Failures::resume(&directory.failures(), lineage)?;
        if let Some(kept) = &kept {
            fs::remove_file(kept).map_err(Error::io("remove", kept))?;
        }
        Ok(kept.is_some())
    }

    /// Reports some fitness of a generation, as in a resumed run.
    fn go_on(&self, search: &mut AnyStrategy) -> Result<(), EvoError> {
        // A genome that cannot be decoded ends a run with an error.
        let _ = search.parameters(&self.genotype);
        let shape = search.score_shape();
        let numbers = search.individuals().saturating_mul(shape.width());
        let values = (0..numbers).map(|number| (number * 7 % 11) as f64).collect();
        search.tell_unrecorded(&Scores::new(shape, values)?)
    }
}
