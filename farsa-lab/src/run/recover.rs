//! Makes the files of a run agree with its checkpoint, whatever moment the previous process was killed at.
//!
//! The checkpoint is written last. A killed process can leave temporary files, entries behind the marks of the checkpoint, and the
//! champions of a later generation.

use std::path::PathBuf;

use farsa_evo::{Fitness, Record};

use crate::error::Error;
use crate::run::config_file;
use crate::run::diagnostics::DiagnosticsTable;
use crate::run::plan::Plan;
use crate::run::record_file::{RunRecord, RunRecordWriter};
use crate::run::records::{Best, Champions, Checkpoint};
use crate::store::bounded::read_regular_text;
use crate::store::directory::Directory;
use crate::store::failures::Failures;
use crate::store::lineage::{Lineage, rows};
use crate::store::log::Log;
use crate::store::replace::replace;
use crate::store::temporary_file;
use crate::strategy::any_strategy::AnyStrategy;
use crate::strategy::history::History;

/// Files of a run that grow, open at their ends.
pub(crate) struct RunFiles {
    pub(crate) record: RunRecordWriter,
    pub(crate) log: Log,
    /// New name of a log that another program had changed.
    pub(crate) changed_log: Option<PathBuf>,
    /// `None` for a strategy whose individuals have no parents.
    pub(crate) lineage: Option<Lineage>,
    pub(crate) failures: Failures,
    pub(crate) diagnostics: DiagnosticsTable,
}

/// Makes all files of a run agree with its checkpoint and opens those that grow.
///
/// # Errors
/// [`Error::Io`], and [`Error::File`] for a record from which the champions or the lineage cannot be rebuilt.
pub(crate) fn recover(
    plan: &Plan<'_>,
    directory: &Directory,
    checkpoint: &Checkpoint,
    run_record: &mut RunRecord,
    search: &AnyStrategy,
) -> Result<RunFiles, Error> {
    temporary_file::sweep_run(directory.path());
    let config = plan.to_toml()?;
    if read_regular_text(&directory.config(), config_file::MAX_BYTES).ok().as_ref() != Some(&config) {
        replace(&directory.config(), config.as_bytes())?;
    }
    let record = run_record.writer(plan, directory)?;
    let lineage = lineage(plan, directory, checkpoint, &run_record.record, search)?;
    restore_champions(plan, directory, checkpoint, run_record)?;
    let populations = plan.evaluator()?.info().populations;
    let (log, changed_log) = Log::resume(&directory.log(), &run_record.lines, &populations)?;
    let failures = Failures::resume(&directory.failures(), checkpoint.failures)?;
    let diagnostics = DiagnosticsTable::resume(plan.definition().diagnostics(), directory, &run_record.diagnostics)?;
    Ok(RunFiles { record, log, changed_log, lineage, failures, diagnostics })
}

/// Opens the lineage at the mark of the checkpoint, or rebuilds it from the record.
fn lineage(
    plan: &Plan<'_>,
    directory: &Directory,
    checkpoint: &Checkpoint,
    record: &Record,
    search: &AnyStrategy,
) -> Result<Option<Lineage>, Error> {
    if search.genealogy().is_none() {
        return Ok(None);
    }
    let rebuild = |append: &mut dyn FnMut(&str) -> Result<(), Error>| {
        let mut strategy = plan.strategy()?;
        for generation in 0..=checkpoint.generation {
            let rebuilt = strategy.rebuild(record, generation);
            rebuilt.map_err(|error| Error::damaged(&directory.record(), error))?;
            append(&rows(&strategy))?;
        }
        Ok(())
    };
    Lineage::resume(&directory.lineage(), checkpoint.lineage, rebuild).map(Some)
}

/// Writes `champion.bin` again where it cannot be read or has the champions of another generation than the checkpoint.
fn restore_champions(
    plan: &Plan<'_>,
    directory: &Directory,
    checkpoint: &Checkpoint,
    run_record: &RunRecord,
) -> Result<(), Error> {
    let Some(generation) = run_record.champion() else { return Ok(()) };
    if Champions::read(plan, directory).is_ok_and(|champions| champions.generation == generation) {
        return Ok(());
    }
    let RunRecord { record, lines, observed, .. } = run_record;
    let missing = || Error::damaged(&directory.record(), format!("has no champion of generation {generation}"));
    let individuals = (0..record.populations()).map(|population| record.champion(population, generation));
    let individuals: Vec<usize> = individuals.collect::<Option<_>>().ok_or_else(missing)?;
    let places: Vec<(u32, usize)> = individuals.iter().map(|&individual| (generation, individual)).collect();
    let genomes = History::new(directory.record(), record.clone(), plan.fresh()).genomes(&places)?;
    let line = lines.get(generation as usize).ok_or_else(missing)?;
    // A single population has no separate rows.
    let rows = if line.each.is_empty() { std::slice::from_ref(&line.row) } else { &line.each };
    let best = individuals.into_iter().zip(genomes).zip(rows).map(|((individual, genes), [best, ..])| Best {
        individual: individual as u32,
        fitness: Fitness::nan_as_failed(*best),
        genes,
    });
    let best = best.collect();
    let previous = (generation as usize).checked_sub(1).and_then(|previous| observed.get(previous)).cloned();
    let normalisation = if observed.is_empty() { None } else { previous.or(plan.no_observations()?) };
    Champions { identity: checkpoint.identity.clone(), generation, best, normalisation }.write(&directory.champion())
}
