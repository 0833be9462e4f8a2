//! `fitness.csv`: one line for each finished generation.

use std::fmt::{self, Write as _};
use std::fs;
use std::path::{Path, PathBuf};

use farsa_evo::Statistics;
use serde::{Deserialize, Serialize};

use crate::error::Error;
use crate::store::append_log::AppendLog;
use crate::store::bounded::read_regular_if_present;

/// First line for one population.
const HEADER: &str = "generation,best,mean,worst,evaluations,failed\n";
/// Bytes of the largest log that is compared with the record.
const MAX_BYTES: u64 = 1 << 32;

/// Formats the first line, with three more columns for each of several populations.
pub(crate) fn header(populations: &[impl fmt::Display]) -> String {
    let mut text = HEADER.trim_end().to_owned();
    for population in populations.iter().filter(|_| populations.len() > 1) {
        // Writing into a string cannot fail.
        let _ = write!(text, ",best {population},mean {population},worst {population}");
    }
    text + "\n"
}

/// One generation's best, mean and worst fitness.
pub(crate) type Row = [f64; 3];

/// Content of a line.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub(crate) struct Line {
    pub(crate) row: Row,
    /// Row of each population, where there are several.
    pub(crate) each: Vec<Row>,
    pub(crate) evaluations: u64,
    pub(crate) failed: u64,
}

impl Line {
    /// Creates the line of a generation. `each` has the statistics of every population, where there are several.
    pub(crate) fn new(statistics: &Statistics, evaluations: usize, each: &[Statistics]) -> Self {
        let row = |&Statistics { best, mean, worst, .. }: &Statistics| [best, mean, worst];
        let (evaluations, failed) = (evaluations as u64, statistics.failed as u64);
        Self { row: row(statistics), each: each.iter().map(row).collect(), evaluations, failed }
    }

    /// Formats the line of a generation.
    fn text(&self, generation: usize) -> String {
        let Self { row: [best, mean, worst], each, evaluations, failed } = self;
        // The debug form is the shortest that reads back as the same number.
        let mut text = format!("{generation},{best:?},{mean:?},{worst:?},{evaluations},{failed}");
        for [best, mean, worst] in each {
            // Writing into a string cannot fail.
            let _ = write!(text, ",{best:?},{mean:?},{worst:?}");
        }
        text.push('\n');
        text
    }
}

/// Log of a run in progress. Its lines are not kept in memory.
pub(crate) struct Log {
    file: AppendLog,
    generations: usize,
}

impl Log {
    /// Writes the log of a resumed run again from its record.
    ///
    /// A file with other content is kept under another name, which is returned. Lines of later generations and other line
    /// endings, as spreadsheets write them, are not other content.
    pub(crate) fn resume(
        path: &Path,
        lines: &[Line],
        populations: &[String],
    ) -> Result<(Self, Option<PathBuf>), Error> {
        let body: String = lines.iter().enumerate().map(|(generation, line)| line.text(generation)).collect();
        let text = header(populations) + &body;
        // Early versions numbered the populations.
        let numbered = header(&(0..populations.len()).collect::<Vec<_>>()) + &body;
        let is_same = |path: &Path| Ok::<bool, Error>(says_the_same(path, &text)? || says_the_same(path, &numbered)?);
        let kept = if fs::symlink_metadata(path).is_ok() && !is_same(path)? { Some(keep(path)?) } else { None };
        Ok((Self { file: AppendLog::new(path, text.as_bytes())?, generations: lines.len() }, kept))
    }

    /// Appends a generation.
    ///
    /// # Errors
    /// [`Error::Io`], and [`Error::File`] when another program has removed, replaced or changed the file.
    pub(crate) fn append(&mut self, line: &Line) -> Result<(), Error> {
        self.file.check()?;
        self.file.append(line.text(self.generations).as_bytes())?;
        self.generations += 1;
        Ok(())
    }

    /// Synchronizes the file with the disk.
    ///
    /// # Errors
    /// As [`append`](Self::append).
    pub(crate) fn sync(&mut self) -> Result<(), Error> {
        self.file.check()?;
        self.file.sync().map(drop)
    }
}

/// Returns whether a file has this text, a part of it, or lines of later generations after it, as a killed process leaves it.
///
/// # Errors
/// [`Error::Io`].
fn says_the_same(path: &Path, text: &str) -> Result<bool, Error> {
    let Some(bytes) = read_regular_if_present(path, MAX_BYTES)? else { return Ok(false) };
    // A cut may split a character. The rest is then compared as replaced characters.
    let content = String::from_utf8_lossy(&bytes);
    let content = content.strip_prefix('\u{feff}').unwrap_or(&content).replace("\r\n", "\n").replace('\r', "\n");
    let Some(more) = content.strip_prefix(text) else { return Ok(text.starts_with(&content)) };
    let later = more.lines().zip(text.lines().count().saturating_sub(1)..);
    Ok(later.into_iter().all(|(line, generation)| {
        let start = format!("{generation},");
        line.starts_with(&start) || start.starts_with(line)
    }))
}

/// Renames a file to an unused name.
fn keep(path: &Path) -> Result<PathBuf, Error> {
    let (stem, end) = (path.file_stem().unwrap_or_default(), path.extension().unwrap_or_default());
    let name = |number: u32| format!("{}-changed-{number}.{}", stem.to_string_lossy(), end.to_string_lossy());
    let mut others = (1..u32::MAX).map(|number| path.with_file_name(name(number)));
    let other = others.find(|other| fs::symlink_metadata(other).is_err());
    let other = other.unwrap_or_else(|| path.with_extension("changed"));
    fs::rename(path, &other).map_err(Error::io("rename", path))?;
    Ok(other)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn line(best: f64) -> Line {
        Line { row: [best, -0.25, f64::NEG_INFINITY], each: Vec::new(), evaluations: 20, failed: 3 }
    }

    #[test]
    fn lines_hold_the_shortest_numbers_that_read_back() {
        assert_eq!(line(1e-300).text(7), "7,1e-300,-0.25,-inf,20,3\n");
        let each = vec![[1.0; 3], [3.0, 3.0, f64::NEG_INFINITY]];
        let both = Line { row: [3.0, 2.0, 1.0], each, evaluations: 20, failed: 0 };
        assert_eq!(both.text(0), "0,3.0,2.0,1.0,20,0,1.0,1.0,1.0,3.0,3.0,-inf\n");
        let head = header(&["hunter", "prey"]);
        let more = "best hunter,mean hunter,worst hunter,best prey,mean prey,worst prey";
        assert_eq!(head.trim_end(), format!("{},{more}", HEADER.trim_end()));
        assert_eq!((header(&["all"; 0]), header(&["all"])), (HEADER.into(), HEADER.into()));
    }

    #[test]
    fn a_log_with_numbers_of_populations_gets_their_names() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("fitness.csv");
        fs::write(&path, header(&[0, 1])).unwrap();
        let names = ["hunter".to_owned(), "prey".to_owned()];
        let (_, kept) = Log::resume(&path, &[], &names).unwrap();
        assert_eq!((kept, fs::read_to_string(&path).unwrap()), (None, header(&names)));
    }

    #[test]
    fn a_log_is_written_again_and_nothing_of_anybody_is_lost() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("fitness.csv");
        let lines = vec![line(1.5), line(2.5)];
        let text = format!("{HEADER}{}{}", lines[0].text(0), lines[1].text(1));
        let resumed = |content: Option<&[u8]>| {
            let _ = fs::remove_file(&path);
            if let Some(content) = content {
                fs::write(&path, content).unwrap();
            }
            let (mut log, kept) = Log::resume(&path, &lines, &["0".into()]).unwrap();
            assert_eq!(fs::read_to_string(&path).unwrap(), text);
            log.append(&line(3.5)).unwrap();
            log.sync().unwrap();
            assert_eq!(fs::read_to_string(&path).unwrap(), format!("{text}{}", line(3.5).text(2)));
            kept
        };
        // Removed, cut, extended by a killed process, and saved by a spreadsheet.
        assert_eq!(resumed(None), None);
        assert_eq!(resumed(Some(&text.as_bytes()[..60])), None);
        assert_eq!(resumed(Some(format!("{text}2,3.5,-0.2").as_bytes())), None);
        assert_eq!(resumed(Some(text.replace('\n', "\r\n").as_bytes())), None);
        assert_eq!(resumed(Some(format!("\u{feff}{}", text.trim_end()).as_bytes())), None);
        assert_eq!(resumed(Some(&[text.as_bytes(), b"2,", &[0xff, 0xfe]].concat())), None);
        // Any other change is the user's.
        let changed = text.replace("1.5", "1,5");
        for (number, content) in (1..).zip([changed, format!("{text}the best so far\n"), "dear diary".into()]) {
            let kept = resumed(Some(content.as_bytes())).unwrap();
            assert!(kept.ends_with(format!("fitness-changed-{number}.csv")), "{}", kept.display());
            assert_eq!(fs::read_to_string(kept).unwrap(), content);
        }
    }
}
