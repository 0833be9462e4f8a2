//! `fitness.csv`: one line per finished generation, appended and never rewritten.

use std::fmt::Write as _;
use std::fs::{File, OpenOptions, TryLockError};
use std::io::{Read as _, Seek as _, SeekFrom, Write as _};
use std::path::{Path, PathBuf};

use farsa_evo::Statistics;
use farsa_num::crc32;
use serde::{Deserialize, Serialize};

use crate::error::Error;

/// The first line.
pub(crate) const HEADER: &str = "generation,best,mean,worst,evaluations,failed\n";

/// One generation's best, mean and worst fitness.
pub(crate) type Row = [f64; 3];

/// How far the log had come when a checkpoint was written.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
pub(crate) struct Mark {
    bytes: u64,
    crc: u32,
}

/// The log of a running run; holding it keeps other processes from going on with the same run.
pub(crate) struct Log {
    path: PathBuf,
    file: File,
    text: String,
    rows: Vec<Row>,
}

impl Log {
    /// The mark of a log that has only its header.
    pub(crate) fn start() -> Mark {
        mark(HEADER)
    }

    /// Takes possession of a run's log and reads it, whole.
    pub(crate) fn open(path: &Path) -> Result<Self, Error> {
        let mut file = OpenOptions::new().read(true).append(true).open(path).map_err(Error::io("open", path))?;
        match file.try_lock() {
            Ok(()) => {}
            Err(TryLockError::WouldBlock) => {
                let directory = path.parent().unwrap_or(path).into();
                return Err(Error::Occupied { directory, why: "another process is at this run right now".into() });
            }
            Err(TryLockError::Error(source)) => return Err(Error::Io { doing: "lock", path: path.into(), source }),
        }
        let mut text = String::new();
        file.read_to_string(&mut text).map_err(Error::io("read", path))?;
        Ok(Self { path: path.into(), file, text, rows: Vec::new() })
    }

    /// Drops the lines after a mark: their generations will be lived again, to the same lines.
    ///
    /// # Errors
    /// [`Error::Damaged`] when the lines up to the mark are not the ones that were written.
    pub(crate) fn rewind(&mut self, to: Mark) -> Result<(), Error> {
        let Some(kept) = usize::try_from(to.bytes).ok().and_then(|bytes| self.text.get(..bytes)) else {
            let why = format!("truncated: {} bytes of {}", self.text.len(), to.bytes);
            return Err(Error::damaged(&self.path, why));
        };
        if mark(kept) != to {
            return Err(Error::damaged(&self.path, "altered: its checksum is not the one in the checkpoint"));
        }
        self.rows = rows(kept).ok_or_else(|| Error::damaged(&self.path, "is not a log of fitness"))?;
        self.text.truncate(kept.len());
        self.file.set_len(to.bytes).map_err(Error::io("truncate", &self.path))?;
        self.file.seek(SeekFrom::End(0)).map_err(Error::io("write", &self.path))?;
        Ok(())
    }

    /// Appends a generation.
    pub(crate) fn append(&mut self, statistics: &Statistics, evaluations: usize) -> Result<(), Error> {
        let Statistics { best, mean, worst, failed, .. } = *statistics;
        let start = self.text.len();
        let generation = self.rows.len();
        // The debug form is the shortest that reads back as the same number. Writing into a string cannot fail.
        let _ = writeln!(self.text, "{generation},{best:?},{mean:?},{worst:?},{evaluations},{failed}");
        self.rows.push([best, mean, worst]);
        self.file.write_all(&self.text.as_bytes()[start..]).map_err(Error::io("write", &self.path))
    }

    /// Brings everything to the disk and says how far it has come.
    pub(crate) fn sync(&mut self) -> Result<Mark, Error> {
        self.file.sync_data().map_err(Error::io("write", &self.path))?;
        Ok(mark(&self.text))
    }

    /// The generations so far.
    pub(crate) fn rows(&self) -> &[Row] {
        &self.rows
    }
}

fn mark(text: &str) -> Mark {
    Mark { bytes: text.len() as u64, crc: crc32(text.as_bytes()) }
}

/// The lines' numbers, if it is a log.
fn rows(text: &str) -> Option<Vec<Row>> {
    let lines = text.strip_prefix(HEADER)?.lines();
    lines
        .enumerate()
        .map(|(index, line)| {
            let mut fields = line.split(',');
            (fields.next()?.parse() == Ok(index)).then_some(())?;
            let mut number = || fields.next()?.parse().ok();
            Some([number()?, number()?, number()?])
        })
        .collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn lines_read_back() {
        let text = format!("{HEADER}0,1.5,-0.25,-inf,20,3\n1,1e-300,0.0,-1.0,20,0\n");
        assert_eq!(rows(&text), Some(vec![[1.5, -0.25, f64::NEG_INFINITY], [1e-300, 0.0, -1.0]]));
        assert_eq!(rows("generation\n"), None);
        assert_eq!(rows(&format!("{HEADER}1,1,1,1,1,1\n")), None);
        assert_eq!(rows(&format!("{HEADER}0,1,x,1,1,1\n")), None);
    }
}
