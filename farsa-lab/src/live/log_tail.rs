//! Log of fitness, read in parts while it grows.

use std::fs;
use std::path::PathBuf;

use crate::error::Error;
use crate::live::row::Row;
use crate::store::bounded::read_regular_part;

/// Most bytes of a read after the previous line. A line of a hundred populations takes five thousand.
const PART: u64 = 64 << 10;

/// Reader of a log. It holds no file open, and its memory does not depend on the length of the log.
#[derive(Debug, Clone)]
pub(in crate::live) struct LogTail {
    path: PathBuf,
    /// Byte after the last line that was read.
    offset: u64,
    /// Last line that was read, with its end.
    last: Vec<u8>,
    /// Generation of the next line. `None` before the header.
    next: Option<usize>,
    /// First generation to return.
    first: usize,
}

/// Result of a read.
#[derive(Debug, PartialEq)]
pub(in crate::live) enum Part {
    /// New rows, and true if more lines can be read at once.
    Rows(Vec<Row>, bool),
    /// The previous line is no longer there: this is another log.
    Other,
}

impl LogTail {
    /// Starts before the header, and skips rows of generations before `first`.
    pub(in crate::live) fn new(path: PathBuf, first: usize) -> Self {
        Self { path, offset: 0, last: Vec::new(), next: None, first }
    }

    /// Reads the next complete lines.
    ///
    /// The log of a resumed run is first cut to its checkpoint. It is read again when it has its former length.
    ///
    /// # Errors
    /// [`Error::Io`], and [`Error::File`] for an invalid log.
    pub(in crate::live) fn read(&mut self) -> Result<Part, Error> {
        let size = fs::metadata(&self.path).map_err(Error::io("read", &self.path))?.len();
        if size <= self.offset {
            return Ok(Part::Rows(Vec::new(), false));
        }
        let known = self.last.len() as u64;
        let bytes = read_regular_part(&self.path, self.offset - known, known + PART)?;
        let is_full = bytes.len() as u64 == known + PART;
        let Some(new) = bytes.strip_prefix(self.last.as_slice()) else { return Ok(Part::Other) };
        // The last line may be incomplete.
        let Some(end) = new.iter().rposition(|&byte| byte == b'\n') else {
            let endless = || Error::damaged(&self.path, format!("a line of more than {PART} bytes"));
            return if is_full { Err(endless()) } else { Ok(Part::Rows(Vec::new(), false)) };
        };
        let mut next = self.next;
        let mut rows = Vec::new();
        for line in new[..end].split(|&byte| byte == b'\n') {
            if let Some(generation) = next.filter(|&generation| generation >= self.first) {
                rows.push(self.row(generation, line)?);
            }
            next = Some(next.map_or(0, |generation| generation + 1));
        }
        let start = new[..end].iter().rposition(|&byte| byte == b'\n').map_or(0, |before| before + 1);
        self.last = new[start..=end].to_vec();
        self.offset += end as u64 + 1;
        self.next = next;
        Ok(Part::Rows(rows, is_full))
    }

    fn row(&self, generation: usize, line: &[u8]) -> Result<Row, Error> {
        let text = String::from_utf8_lossy(line);
        let mut cells = text.split(',').skip(1).map_while(|cell| cell.parse().ok());
        match [(); 3].map(|()| cells.next()) {
            [Some(best), Some(mean), Some(worst)] => Ok(Row::new(generation, [best, mean, worst])),
            _ => Err(Error::damaged(&self.path, format!("line {}: {text}", generation + 2))),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const HEAD: &str = "generation,best,mean,worst,evaluations,failed\n";

    fn rows(part: Part) -> Vec<Row> {
        match part {
            Part::Rows(rows, false) => rows,
            other => panic!("{other:?}"),
        }
    }

    #[test]
    fn rows_are_returned_once_and_when_complete() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("fitness.csv");
        let write = |text: &str| fs::write(&path, format!("{HEAD}{text}")).unwrap();
        let mut tail = LogTail::new(path.clone(), 1);
        assert!(tail.read().is_err());
        write("0,1.5,1.0,0.0,4,0\n");
        assert_eq!(rows(tail.read().unwrap()), []);
        write("0,1.5,1.0,0.0,4,0\n1,2.0,-inf,-inf,4,1\n2,3");
        assert_eq!(rows(tail.read().unwrap()), [Row::new(1, [2.0, f64::NEG_INFINITY, 0.0])]);
        assert_eq!(rows(tail.read().unwrap()), []);
        // A resumed run cuts the log and writes the same lines again.
        write("0,1.5,1.0,0.0,4,0\n");
        assert_eq!(rows(tail.read().unwrap()), []);
        write("0,1.5,1.0,0.0,4,0\n1,2.0,-inf,-inf,4,1\n2,3.0,2.0,1.0,4,0\n");
        assert_eq!(rows(tail.read().unwrap()), [Row::new(2, [3.0, 2.0, 1.0])]);
        write("0,1.5,1.0,0.0,4,0\n1,2.0,-inf,-inf,4,1\n2,3.0,2.0,1.0,4,0\nmine\n");
        assert!(tail.read().unwrap_err().to_string().contains("line 5: mine"));
        // Another log of the same length up to there, and longer.
        write("0,1.5,1.0,0.0,4,0\n1,2.0,-inf,-inf,4,1\n2,3.5,2.0,1.0,4,0\n3,3.5,2.0,1.0,4,0\n");
        assert_eq!(tail.read().unwrap(), Part::Other);
        assert_eq!(rows(LogTail::new(path, usize::MAX).read().unwrap()), []);
    }

    #[test]
    fn a_long_log_is_read_in_parts() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("fitness.csv");
        let line = |generation: usize| format!("{generation},{generation}.5,1.0,0.0,4,0\n");
        let lines: Vec<String> = (0..9000).map(line).collect();
        fs::write(&path, format!("{HEAD}{}", lines.concat())).unwrap();
        let mut tail = LogTail::new(path.clone(), 4000);
        let mut found = Vec::new();
        let mut parts = 0;
        loop {
            let Part::Rows(rows, more) = tail.read().unwrap() else { panic!("the same log") };
            assert!(rows.len() < 4000 && tail.last.len() < 40);
            found.extend(rows);
            parts += 1;
            if !more {
                break;
            }
        }
        assert_eq!(found.len(), 5000);
        assert!(parts >= 3, "{parts}");
        assert_eq!(found[0].0, 4000);
        assert!(found.windows(2).all(|pair| pair[1].0 == pair[0].0 + 1));
        fs::write(&path, vec![b'1'; 70_000]).unwrap();
        assert!(LogTail::new(path, 0).read().is_err());
    }
}
