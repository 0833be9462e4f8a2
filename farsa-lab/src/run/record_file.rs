//! `record.bin`: the reported fitness of every generation. The file only grows.
//!
//! A checksummed head identifies the run. An entry for each generation follows, with the observation statistics where
//! observations are normalized. The checkpoint has the valid length of the file and its checksum. It is written later.

use std::path::{Path, PathBuf};

use farsa_evo::{Fitness, ObservationStatistics, Record, RecordEntry, RecordWriter, Snapshot as _};
use serde::{Deserialize, Serialize};

use crate::error::Error;
use crate::run::plan::Plan;
use crate::run::records::{Checkpoint, RecordHead, evolved, imported};
use crate::store::append_log::{self, AppendLog, Mark};
use crate::store::checksummed;
use crate::store::directory::Directory;
use crate::store::identity::Identity;
use crate::store::log::Line;
use crate::strategy::any_strategy::AnyStrategy;
use crate::strategy::history::History;

/// A generation.
#[derive(Serialize, Deserialize)]
struct Entry<'e> {
    /// [`RecordEntry::frame`].
    #[serde(borrow)]
    frame: &'e [u8],
    /// [`RecordEntry::state`].
    #[serde(borrow)]
    state: Option<&'e [u8]>,
    /// Line of the log.
    line: Line,
    /// Diagnostics of the strategy.
    diagnostics: Vec<f64>,
}

/// All finished generations of a run.
pub(crate) struct RunRecord {
    pub(crate) identity: Identity,
    pub(crate) record: Record,
    /// Their lines in the log.
    pub(crate) lines: Vec<Line>,
    /// True if the champion is the best of all generations instead of the last one's.
    pub(crate) keeps_champion: bool,
    /// Observation statistics after each generation, where observations are normalized.
    pub(crate) observed: Vec<ObservationStatistics>,
    /// Diagnostics of each generation, for a strategy that has some.
    pub(crate) diagnostics: Vec<Vec<f64>>,
    /// Bytes of the longest entry.
    longest: usize,
    /// Valid content of the file.
    content: Vec<u8>,
}

impl RunRecord {
    /// Reads the record of a planned run up to a checkpoint. Sizes come from the plan's strategy, so that a forged file cannot
    /// cause large allocations.
    ///
    /// # Errors
    /// As [`Checkpoint::read`], and [`Error::File`] for the record of another strategy.
    pub(crate) fn read(plan: &Plan<'_>, directory: &Directory, checkpoint: &Checkpoint) -> Result<Self, Error> {
        evolved(directory)?;
        Self::from_content(plan, directory, checkpoint, Self::content(plan, directory, checkpoint)?)
    }

    /// Decodes a record from the content of the file up to the checkpoint.
    ///
    /// # Errors
    /// As [`read`](Self::read).
    pub(crate) fn from_content(
        plan: &Plan<'_>,
        directory: &Directory,
        checkpoint: &Checkpoint,
        content: Vec<u8>,
    ) -> Result<Self, Error> {
        let path = directory.record();
        let damaged = |why: String| Error::damaged(&path, why);
        let (head, mut rest) = checksummed::open_first::<RecordHead>(&content).map_err(damaged)?;
        let RecordHead { identity, strategy } = head;
        plan.same_run(&identity, directory.path())?;
        let asked = plan.definition().name();
        if strategy != asked {
            let why = format!("was made by the strategy `{strategy}`, the experiment has `{asked}`");
            return Err(damaged(why));
        }
        let mut search = plan.strategy()?;
        let mut record = search.record().map_err(|error| damaged(error.to_string()))?;
        let each = if record.populations() > 1 { record.populations() } else { 0 };
        let (mut lines, mut diagnostics, mut observed) = (Vec::new(), Vec::new(), Vec::new());
        let none = plan.no_observations()?;
        let mut longest = 0;
        while !rest.is_empty() {
            let (generation, whole) = (record.generations(), rest.len());
            let (entry, more) = postcard::take_from_bytes::<Entry<'_>>(rest)
                .map_err(|error| damaged(format!("holds no generation {generation}: {error}")))?;
            let Entry { frame, state, line, diagnostics: said } = entry;
            if line.each.len() != each {
                let found = line.each.len();
                return Err(damaged(format!(
                    "generation {generation} has {found} populations where {each} are expected"
                )));
            }
            let pushed = record.push(RecordEntry { frame, state });
            pushed.map_err(|error| damaged(format!("generation {generation}: {error}")))?;
            lines.push(line);
            if plan.definition().diagnostics().is_some() {
                diagnostics.push(said);
            }
            rest = more;
            if let Some(none) = &none {
                let (state, more) = postcard::take_from_bytes::<&[u8]>(rest)
                    .map_err(|error| damaged(format!("generation {generation}: what was observed: {error}")))?;
                let mut statistics = none.clone();
                let restored = statistics.restore(state);
                restored.map_err(|error| damaged(format!("generation {generation}: what was observed: {error}")))?;
                observed.push(statistics);
                rest = more;
            }
            longest = longest.max(whole - rest.len());
        }
        let (found, expected) = (record.generations(), checkpoint.generation);
        if found != expected {
            return Err(damaged(format!("{found} generations where checkpoint.bin speaks of {expected}")));
        }
        let keeps_champion = search.champion_is_best_ever();
        Ok(Self { identity, record, lines, keeps_champion, observed, diagnostics, longest, content })
    }

    /// Counts the failed evaluations of all generations.
    pub(crate) fn failed(&self) -> u64 {
        self.lines.iter().map(|line| line.failed).fold(0, u64::saturating_add)
    }

    /// Returns the generation of the run's champion, the first one of equal fitness. The result is `None` before the first
    /// generation.
    pub(crate) fn champion(&self) -> Option<u32> {
        let last = self.record.generations().checked_sub(1)?;
        if !self.keeps_champion {
            return Some(last);
        }
        let best =
            |generation: &u32| self.lines.get(*generation as usize).map(|line| Fitness::nan_as_failed(line.row[0]));
        // The last of equal maxima in this order is the first generation.
        (0..=last).rev().max_by_key(best)
    }

    /// Reads the content of the file up to a checkpoint.
    ///
    /// # Errors
    /// [`Error::Io`], and [`Error::File`] for content that does not match the checkpoint.
    pub(crate) fn content(plan: &Plan<'_>, directory: &Directory, checkpoint: &Checkpoint) -> Result<Vec<u8>, Error> {
        append_log::read(&directory.record(), checkpoint.record, plan.limits.record_bytes)
    }

    /// Opens the file at its end and removes the entries after the checkpoint.
    pub(crate) fn writer(&mut self, plan: &Plan<'_>, directory: &Directory) -> Result<RunRecordWriter, Error> {
        let content = std::mem::take(&mut self.content);
        let file = AppendLog::new(&directory.record(), &content)?;
        Ok(RunRecordWriter { file: file.with_limit(plan.limits.record_bytes), longest: self.longest })
    }
}

/// Returns the identity of a planned run, its generations or imported genotypes, and the path of their file.
///
/// # Errors
/// As [`RunRecord::read`].
pub(crate) fn history<'p>(
    plan: &'p Plan<'_>,
    directory: &Directory,
) -> Result<(Identity, History<'p>, PathBuf), Error> {
    let path = directory.genotypes();
    if path.is_file() {
        let (identity, genomes, populations) = imported(plan, directory)?;
        return Ok((identity, History::from_imported(path.clone(), genomes, populations), path));
    }
    let path = directory.record();
    let run_record = RunRecord::read(plan, directory, &Checkpoint::read(plan, directory)?)?;
    let champion = run_record.champion();
    let RunRecord { identity, record, observed, .. } = run_record;
    let observations = plan.no_observations()?.into_iter().chain(observed).collect();
    let history = History::new(path.clone(), record, plan.fresh()).with_observations(observations);
    Ok((identity, history.with_champion(champion), path))
}

/// Record of a run in progress.
pub(crate) struct RunRecordWriter {
    file: AppendLog,
    /// Bytes of the longest entry.
    longest: usize,
}

impl RunRecordWriter {
    /// Creates the file of a run without a generation and returns its mark.
    pub(crate) fn create(path: &Path, identity: &Identity, strategy: &str) -> Result<Mark, Error> {
        let head = RecordHead { identity: identity.clone(), strategy: strategy.into() };
        AppendLog::new(path, &checksummed::to_bytes(path, &head)?)?.sync()
    }

    /// Appends the last generation.
    pub(crate) fn append(
        &mut self,
        record: &RecordWriter,
        line: &Line,
        search: &AnyStrategy,
        observed: Option<&ObservationStatistics>,
    ) -> Result<(), Error> {
        let Some(RecordEntry { frame, state }) = record.entry() else { return Ok(()) };
        let entry = Entry { frame, state, line: line.clone(), diagnostics: search.diagnostics() };
        let failed = |error| Error::Other(format!("record.bin: {error}"));
        let mut bytes = postcard::to_stdvec(&entry).map_err(failed)?;
        if let Some(statistics) = observed {
            bytes = postcard::to_extend(statistics.save().as_slice(), bytes).map_err(failed)?;
        }
        self.longest = self.longest.max(bytes.len());
        self.file.append(&bytes)
    }

    /// Checks that another entry as long as the longest fits. Otherwise the run has to end.
    ///
    /// # Errors
    /// [`Error::Other`].
    pub(crate) fn check_space(&self) -> Result<(), Error> {
        self.file.room_for(self.longest)
    }

    /// Synchronizes the file with the disk and returns its mark.
    ///
    /// # Errors
    /// [`Error::Io`], and [`Error::File`] when another program has removed, replaced or changed the file.
    pub(crate) fn sync(&mut self) -> Result<Mark, Error> {
        self.file.check()?;
        self.file.sync()
    }
}
