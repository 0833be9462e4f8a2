//! `fitness.csv`: one line per finished generation, appended and never rewritten.

use std::fmt::Write as _;
use std::fs::{self, File, OpenOptions, TryLockError};
use std::io::{Read as _, Seek as _, SeekFrom, Write as _};
use std::path::{Path, PathBuf};

use farsa_evo::Statistics;
use farsa_num::crc32;
use serde::{Deserialize, Serialize};

use crate::error::Error;

/// The first line where there is one population.
const HEADER: &str = "generation,best,mean,worst,evaluations,failed\n";

/// The first line: with several populations three more columns for each of them.
pub(crate) fn header(populations: usize) -> String {
    let mut text = HEADER.trim_end().to_owned();
    for population in (0..populations).filter(|_| populations > 1) {
        // Writing into a string cannot fail.
        let _ = write!(text, ",best {population},mean {population},worst {population}");
    }
    text + "\n"
}

/// One generation's best, mean and worst fitness.
pub(crate) type Row = [f64; 3];

/// What a line says about a generation.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Line {
    pub(crate) row: Row,
    /// The same of each population where there are several.
    pub(crate) each: Vec<Row>,
    pub(crate) evaluations: u64,
    pub(crate) failed: u64,
}

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
    lines: Vec<Line>,
}

impl Log {
    /// The mark of a log that has only its header.
    pub(crate) fn start(populations: usize) -> Mark {
        mark(&header(populations))
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
        Ok(Self { path: path.into(), file, text, lines: Vec::new() })
    }

    /// Drops the lines after a mark: their generations will be evaluated again, to the same lines.
    ///
    /// # Errors
    /// [`Error::Damaged`] when the lines up to the mark are not the ones that were written.
    pub(crate) fn rewind(&mut self, to: Mark) -> Result<(), Error> {
        let (kept, lines) = up_to(&self.text, to, &self.path)?;
        self.lines = lines;
        let kept = kept.len();
        self.text.truncate(kept);
        self.file.set_len(to.bytes).map_err(Error::io("truncate", &self.path))?;
        self.file.seek(SeekFrom::End(0)).map_err(Error::io("write", &self.path))?;
        Ok(())
    }

    /// Appends a generation; `each` has the statistics of every population where there are several.
    pub(crate) fn append(
        &mut self,
        statistics: &Statistics,
        evaluations: usize,
        each: &[Statistics],
    ) -> Result<(), Error> {
        let Statistics { best, mean, worst, failed, .. } = *statistics;
        let start = self.text.len();
        let generation = self.lines.len();
        // The debug form is the shortest that reads back as the same number. Writing into a string cannot fail.
        let _ = write!(self.text, "{generation},{best:?},{mean:?},{worst:?},{evaluations},{failed}");
        let each: Vec<Row> = each.iter().map(|&Statistics { best, mean, worst, .. }| [best, mean, worst]).collect();
        for [best, mean, worst] in &each {
            let _ = write!(self.text, ",{best:?},{mean:?},{worst:?}");
        }
        self.text.push('\n');
        self.lines.push(Line {
            row: [best, mean, worst],
            each,
            evaluations: evaluations as u64,
            failed: failed as u64,
        });
        self.file.write_all(&self.text.as_bytes()[start..]).map_err(Error::io("write", &self.path))
    }

    /// Brings everything to the disk and says how far it has come.
    pub(crate) fn sync(&mut self) -> Result<Mark, Error> {
        self.file.sync_data().map_err(Error::io("write", &self.path))?;
        Ok(mark(&self.text))
    }

    /// The generations so far.
    pub(crate) fn lines(&self) -> &[Line] {
        &self.lines
    }
}

/// Reads the lines up to a mark, whether or not a process is writing more of them.
///
/// # Errors
/// [`Error::Io`], [`Error::Damaged`] when they are not the ones that were written.
pub(crate) fn read(path: &Path, to: Mark) -> Result<Vec<Line>, Error> {
    let text = fs::read_to_string(path).map_err(Error::io("read", path))?;
    up_to(&text, to, path).map(|(_, lines)| lines)
}

/// The part of a log up to a mark, and what it says.
fn up_to<'t>(text: &'t str, to: Mark, path: &Path) -> Result<(&'t str, Vec<Line>), Error> {
    let Some(kept) = usize::try_from(to.bytes).ok().and_then(|bytes| text.get(..bytes)) else {
        return Err(Error::damaged(path, format!("truncated: {} bytes of {}", text.len(), to.bytes)));
    };
    if mark(kept) != to {
        return Err(Error::damaged(path, "altered: its checksum is not the one in the checkpoint"));
    }
    let lines = lines(kept).ok_or_else(|| Error::damaged(path, "is not a log of fitness"))?;
    Ok((kept, lines))
}

fn mark(text: &str) -> Mark {
    Mark { bytes: text.len() as u64, crc: crc32(text.as_bytes()) }
}

/// The lines' numbers, if it is a log.
fn lines(text: &str) -> Option<Vec<Line>> {
    let (first, lines) = text.split_once('\n')?;
    let columns = first.split(',').count();
    let populations = columns.saturating_sub(6) / 3;
    (header(populations).trim_end() == first).then_some(())?;
    lines
        .lines()
        .enumerate()
        .map(|(index, line)| {
            let mut fields = line.split(',');
            (fields.next()?.parse() == Ok(index)).then_some(())?;
            let mut number = || fields.next()?.parse().ok();
            let row = [number()?, number()?, number()?];
            let mut count = || fields.next()?.parse().ok();
            let (evaluations, failed) = (count()?, count()?);
            let rest = fields.map(|field| field.parse().ok()).collect::<Option<Vec<f64>>>()?;
            (rest.len() == columns - 6 || columns == 6).then_some(())?;
            let each = rest.chunks_exact(3).take(populations).map(|each| [each[0], each[1], each[2]]).collect();
            Some(Line { row, each, evaluations, failed })
        })
        .collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn lines_read_back() {
        let text = format!("{HEADER}0,1.5,-0.25,-inf,20,3\n1,1e-300,0.0,-1.0,20,0\n");
        let expected = [
            Line { row: [1.5, -0.25, f64::NEG_INFINITY], each: Vec::new(), evaluations: 20, failed: 3 },
            Line { row: [1e-300, 0.0, -1.0], each: Vec::new(), evaluations: 20, failed: 0 },
        ];
        assert_eq!(lines(&text), Some(expected.into()));
        assert_eq!(lines("generation\n"), None);
        for line in ["1,1,1,1,1,1", "0,1,x,1,1,1", "0,1,1,1,1", "0,1,1,1,1,-1"] {
            assert_eq!(lines(&format!("{HEADER}{line}\n")), None, "{line}");
        }
        // Each of two populations has columns of its own.
        let head = header(2);
        assert_eq!(head.trim_end(), format!("{},best 0,mean 0,worst 0,best 1,mean 1,worst 1", HEADER.trim_end()));
        assert_eq!((header(0), header(1)), (HEADER.into(), HEADER.into()));
        let each = vec![[1.0; 3], [3.0, 3.0, f64::NEG_INFINITY]];
        let both = Line { row: [3.0, 2.0, 1.0], each, evaluations: 20, failed: 0 };
        assert_eq!(lines(&format!("{head}0,3.0,2.0,1.0,20,0,1.0,1.0,1.0,3.0,3.0,-inf\n")), Some(vec![both]));
        for rest in ["", ",1,1,1,1,1", ",1,1,1,1,1,x", ",1,1,1,1,1,1,1"] {
            assert_eq!(lines(&format!("{head}0,3.0,2.0,1.0,20,0{rest}\n")), None, "{rest}");
        }
    }
}
