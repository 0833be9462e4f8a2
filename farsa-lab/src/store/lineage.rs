//! `lineage.csv`: the parents of every individual, appended generation by generation.

use std::fmt::Write as _;
use std::fs::{File, OpenOptions};
use std::io::{Seek as _, SeekFrom, Write as _};
use std::path::{Path, PathBuf};

use farsa_evo::Strategy;

use crate::error::Error;
use crate::store::directory::replace;

/// The first line. Individuals are counted through all populations; parents are of the generation before, with blanks
/// between them.
const HEADER: &str = "generation,individual,parents\n";

/// The lineage of a run in progress.
pub(crate) struct Lineage {
    path: PathBuf,
    file: File,
    bytes: u64,
}

/// The lines of the generation that waits for its fitness; none for one without parents.
pub(crate) fn rows(strategy: &dyn Strategy) -> String {
    let mut text = String::new();
    let Some(genealogy) = strategy.genealogy() else { return text };
    for individual in 0..strategy.ask().len() {
        let parents: Vec<String> = genealogy.parents_of(individual).iter().map(usize::to_string).collect();
        if !parents.is_empty() {
            // Writing into a string cannot fail.
            let _ = writeln!(text, "{},{individual},{}", strategy.generation(), parents.join(" "));
        }
    }
    text
}

impl Lineage {
    /// Makes the file, with its first line alone, and says how many bytes it has.
    pub(crate) fn create(path: &Path) -> Result<u64, Error> {
        replace(path, HEADER.as_bytes())?;
        Ok(HEADER.len() as u64)
    }

    /// Opens the file for a run that goes on, and forgets what came after so many bytes.
    ///
    /// A file that is gone or shorter, because somebody deleted or cut it, is written again: `rebuild` takes a function that
    /// appends lines.
    pub(crate) fn open(
        path: &Path,
        bytes: u64,
        rebuild: impl FnOnce(&mut dyn FnMut(&str) -> Result<(), Error>) -> Result<(), Error>,
    ) -> Result<Self, Error> {
        let whole = path.metadata().is_ok_and(|found| found.is_file() && found.len() >= bytes);
        if !whole {
            Self::create(path)?;
        }
        let file = OpenOptions::new().write(true).open(path).map_err(Error::io("open", path))?;
        let mut lineage = Self { path: path.into(), file, bytes: if whole { bytes } else { HEADER.len() as u64 } };
        lineage.file.set_len(lineage.bytes).map_err(Error::io("truncate", path))?;
        lineage.file.seek(SeekFrom::End(0)).map_err(Error::io("write", path))?;
        if !whole {
            rebuild(&mut |rows| lineage.append(rows))?;
        }
        Ok(lineage)
    }

    /// Appends the lines of a generation.
    pub(crate) fn append(&mut self, rows: &str) -> Result<(), Error> {
        self.file.write_all(rows.as_bytes()).map_err(Error::io("write", &self.path))?;
        self.bytes += rows.len() as u64;
        Ok(())
    }

    /// Brings everything to the disk and says how many bytes there are.
    pub(crate) fn sync(&mut self) -> Result<u64, Error> {
        self.file.sync_data().map_err(Error::io("write", &self.path))?;
        Ok(self.bytes)
    }
}
