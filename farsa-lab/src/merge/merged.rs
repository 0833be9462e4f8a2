//! `farsa merge`: what is copied and told of the runs.

use std::fmt::Write as _;
use std::fs;
use std::path::{Path, PathBuf};

use serde::Serialize;

use crate::error::Error;
use crate::escaped::OneLine;
use crate::merge::copy::Copy;
use crate::merge::gather::{Gathered, Gathering};
use crate::merge::run_table;
use crate::run::laboratory::Laboratory;
use crate::store::replace::create_results;

/// What is asked for.
pub(crate) struct Merge<'a> {
    /// Runs, or directories that hold some.
    pub(crate) directories: &'a [PathBuf],
    /// Where the finished runs are copied to.
    pub(crate) out: Option<&'a Path>,
    /// A new file for the table.
    pub(crate) csv: Option<&'a Path>,
}

/// What was found and made.
#[derive(Debug, Serialize)]
pub(crate) struct Merged {
    runs: usize,
    /// Directories of runs that other directories have, too.
    twice: Vec<[String; 2]>,
    unfinished: Vec<Unfinished>,
    /// The directories that were made.
    copied: Vec<String>,
    /// Those that were there already.
    there: Vec<String>,
    #[serde(skip)]
    pub(crate) table: Vec<u8>,
}

/// A run that has generations to come: it is in the table, and not copied.
#[derive(Debug, Serialize)]
struct Unfinished {
    directory: String,
    generations: usize,
    of: usize,
}

impl Merge<'_> {
    /// Reads all runs, copies those that are finished, and makes a table of all.
    ///
    /// # Errors
    /// Those of [`Gathering::new`] and [`Copy::all`], after which nothing was written; [`Error::Usage`] for a place of the
    /// copies within a directory that is read. Copies before one that fails are whole, and the same command goes on.
    pub(crate) fn make(&self, laboratory: &Laboratory<'_>) -> Result<Merged, Error> {
        if let Some(out) = self.out {
            apart(out, self.directories)?;
        }
        if let Some(csv) = self.csv.filter(|csv| fs::symlink_metadata(csv).is_ok_and(|found| found.is_file())) {
            return Err(Error::Usage(format!("{}: there is one already", csv.display())));
        }
        let Gathering { runs, twins } = Gathering::new(laboratory, self.directories)?;
        let finished = runs.iter().filter(|run| run.is_finished());
        let copies = self.out.map_or(Ok(Vec::new()), |out| Copy::all(finished, out, laboratory))?;
        let mut places = copies.iter();
        let rows: Vec<(&Gathered<'_>, &Path)> = runs
            .iter()
            .map(|run| {
                let copy = if run.is_finished() { places.next() } else { None };
                (run, copy.map_or(run.directory.path(), |copy| copy.to.as_path()))
            })
            .collect();
        let table = run_table::csv(&rows)?;
        for copy in copies.iter().filter(|copy| !copy.there) {
            copy.make(laboratory)?;
        }
        if let Some(csv) = self.csv {
            create_results(&[(csv.to_path_buf(), &table)])?;
        }
        let names =
            |there: bool| copies.iter().filter(move |copy| copy.there == there).map(|copy| shown(&copy.to)).collect();
        let unfinished = runs.iter().filter(|run| !run.is_finished()).map(|run| Unfinished {
            directory: shown(run.directory.path()),
            generations: run.lines.len(),
            of: run.asked,
        });
        Ok(Merged {
            runs: runs.len(),
            twice: twins.iter().map(|pair| pair.each_ref().map(|path| shown(path))).collect(),
            unfinished: unfinished.collect(),
            copied: names(false),
            there: names(true),
            table,
        })
    }
}

fn shown(path: &Path) -> String {
    path.display().to_string()
}

/// Refuses to copy runs into a directory that is searched for them: they would be found again.
fn apart(out: &Path, directories: &[PathBuf]) -> Result<(), Error> {
    let real = out.ancestors().find_map(|path| {
        let path = if path == Path::new("") { Path::new(".") } else { path };
        path.canonicalize().ok()
    });
    let within = |directory: &&PathBuf| {
        let directory = directory.canonicalize().ok();
        real.as_ref().zip(directory).is_some_and(|(out, directory)| out.starts_with(directory))
    };
    match directories.iter().find(within) {
        None => Ok(()),
        Some(directory) => {
            let (out, directory) = (out.display(), directory.display());
            Err(Error::Usage(format!("--out {out}: lies in {directory}, from where the runs come")))
        }
    }
}

impl Merged {
    /// The same in a few lines.
    pub(crate) fn text(&self) -> String {
        let plural = |count: usize| if count == 1 { "run" } else { "runs" };
        let mut text = format!("{} {}", self.runs, plural(self.runs));
        // Writing into a string cannot fail.
        let _ = match (self.copied.len(), self.there.len()) {
            (0, 0) => writeln!(text),
            (copied, 0) => writeln!(text, ", {copied} copied"),
            (copied, there) => writeln!(text, ", {copied} copied, {there} there already"),
        };
        for Unfinished { directory, generations, of } in &self.unfinished {
            let _ = writeln!(text, "{}: not finished: {generations} of {of} generations", OneLine(directory));
        }
        for [left, kept] in &self.twice {
            let _ = writeln!(text, "{}: the same run as {}", OneLine(left), OneLine(kept));
        }
        text
    }
}
