//! `lineage.csv`: the parents of every individual, appended generation by generation.

use std::fmt::Write as _;
use std::path::Path;

use crate::error::Error;
use crate::store::append_log::{AppendLog, Mark};
use crate::store::bounded::read_regular;
use crate::strategy::any_strategy::AnyStrategy;

/// The first line. Individuals are counted through all populations. Parents are individuals of the previous generation, separated
/// by blanks.
pub(crate) const HEADER: &str = "generation,individual,parents\n";
/// Bytes of the largest lineage.
const MAX_BYTES: u64 = 1 << 32;

/// Lineage of a run in progress.
pub(crate) struct Lineage(AppendLog);

/// Formats the lines of the current generation, which are empty for individuals without parents.
pub(crate) fn rows(strategy: &AnyStrategy) -> String {
    let mut text = String::new();
    let Some(genealogy) = strategy.genealogy() else { return text };
    for individual in 0..strategy.individuals() {
        let parents: Vec<String> = genealogy.parents_of(individual).iter().map(usize::to_string).collect();
        if !parents.is_empty() {
            // Writing into a string cannot fail.
            let _ = writeln!(text, "{},{individual},{}", strategy.generation(), parents.join(" "));
        }
    }
    text
}

impl Lineage {
    /// Opens the file of a resumed run at a mark.
    ///
    /// A missing or changed file is written again. `rebuild` receives a function that appends lines.
    pub(crate) fn resume(
        path: &Path,
        mark: Mark,
        rebuild: impl FnOnce(&mut dyn FnMut(&str) -> Result<(), Error>) -> Result<(), Error>,
    ) -> Result<Self, Error> {
        let content = read_regular(path, MAX_BYTES).unwrap_or_default();
        if let Some(kept) = mark.within(&content).filter(|_| !mark.is_empty()) {
            return Ok(Self(AppendLog::new(path, kept)?));
        }
        drop(content);
        let mut lineage = Self(AppendLog::new(path, HEADER.as_bytes())?);
        rebuild(&mut |rows| lineage.append(rows))?;
        Ok(lineage)
    }

    /// Appends the lines of a generation.
    pub(crate) fn append(&mut self, rows: &str) -> Result<(), Error> {
        self.0.append(rows.as_bytes())
    }

    /// Synchronizes the file with the disk and returns its mark.
    ///
    /// # Errors
    /// [`Error::Io`], and [`Error::File`] when another program has removed, replaced or changed the file.
    pub(crate) fn sync(&mut self) -> Result<Mark, Error> {
        self.0.check()?;
        self.0.sync()
    }
}
