//! `farsa merge`: copies runs and makes a table of them.

use std::ffi::OsStr;
use std::fmt::Write as _;
use std::path::{Path, PathBuf};

use serde::Serialize;

use crate::error::Error;
use crate::escaped::OneLine;
use crate::merge::copy::Copy;
use crate::merge::gather::{Gathered, Gathering};
use crate::merge::run_table;
use crate::run::laboratory::Laboratory;
use crate::store::replace::{create_results, refuse_existing};
use crate::store::temporary_file;

/// Options of the command.
pub(crate) struct Merge<'a> {
    /// Runs, or directories with runs.
    pub(crate) directories: &'a [PathBuf],
    /// Destination of the finished runs.
    pub(crate) out: Option<&'a Path>,
    /// A new file for the table.
    pub(crate) csv: Option<&'a Path>,
    /// A new file for the fitness of every generation.
    pub(crate) curves: Option<&'a Path>,
}

/// Results of the command.
#[derive(Debug, Serialize)]
pub(crate) struct Merged {
    runs: usize,
    /// Duplicate directories.
    twice: Vec<[String; 2]>,
    unfinished: Vec<Unfinished>,
    /// Created directories.
    copied: Vec<String>,
    /// Directories that existed.
    there: Vec<String>,
    #[serde(skip)]
    pub(crate) table: Vec<u8>,
}

/// An unfinished run, which is in the table and not copied.
#[derive(Debug, Serialize)]
struct Unfinished {
    directory: String,
    generations: usize,
    of: usize,
}

impl Merge<'_> {
    /// Reads all runs, copies the finished ones, and makes a table of all.
    ///
    /// # Errors
    /// The errors of [`Gathering::new`] and [`Copy::all`], before anything is written. [`Error::Usage`] for a destination within
    /// a directory that is read. Copies before a failed one are complete, and the same command continues.
    pub(crate) fn make(&self, laboratory: &Laboratory<'_>) -> Result<Merged, Error> {
        if let Some(out) = self.out {
            apart(out, self.directories)?;
        }
        self.csv.into_iter().chain(self.curves).try_for_each(refuse_existing)?;
        if let Some((csv, curves)) = self.csv.zip(self.curves).filter(|(csv, curves)| place(csv) == place(curves)) {
            let (csv, curves) = (csv.display(), curves.display());
            return Err(Error::Usage(format!("--csv {csv} and --curves {curves}: two tables need two files")));
        }
        let Gathering { runs, twins, .. } = &Gathering::new(laboratory, self.directories)?;
        let finished = runs.iter().filter(|run| run.is_finished());
        let copies = self.out.map_or(Ok(Vec::new()), |out| Copy::all(finished, out, laboratory))?;
        let mut places = copies.iter();
        let rows: Vec<(&Gathered<'_>, &Path)> = runs
            .iter()
            .map(|run| {
                let copy = if run.is_finished() { places.next() } else { None };
                (run, copy.map_or(run.place.as_path(), |copy| copy.to.as_path()))
            })
            .collect();
        let table = run_table::csv(&rows)?;
        let curves = self.curves.map(|path| Ok::<_, Error>((path, run_table::curves(&rows)?))).transpose()?;
        for copy in copies.iter().filter(|copy| !copy.there) {
            copy.make(laboratory)?;
        }
        let files = self.csv.map(|path| (path, table.clone())).into_iter().chain(curves);
        let files: Vec<(PathBuf, Vec<u8>)> = files.map(|(path, content)| (path.to_path_buf(), content)).collect();
        create_results(&files)?;
        let names =
            |there: bool| copies.iter().filter(move |copy| copy.there == there).map(|copy| shown(&copy.to)).collect();
        let unfinished = runs.iter().filter(|run| !run.is_finished()).map(|run| Unfinished {
            directory: shown(&run.place),
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

/// Returns the real folder of a new file with its name.
fn place(path: &Path) -> Option<(PathBuf, &OsStr)> {
    Some((temporary_file::parent(path).canonicalize().ok()?, path.file_name()?))
}

/// Refuses a destination within a searched directory, where the copies would be found again.
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
    /// Formats the results in a few lines.
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
