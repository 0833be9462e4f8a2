//! Complete copies of runs in one directory. Existing files are not overwritten.

use std::collections::BTreeMap;
use std::fs::{self, File, OpenOptions};
use std::io;
use std::path::{Path, PathBuf};

use crate::archive::restore;
use crate::error::Error;
use crate::merge::gather::{Gathered, same_version};
use crate::run::laboratory::Laboratory;
use crate::store::directory::{Directory, vacant};
use crate::store::replace::sync_directory;

/// Largest depth of folders in a run.
const DEEPEST: usize = 8;

/// Destination of a run.
pub(crate) struct Copy<'r, 'e> {
    run: &'r Gathered<'e>,
    pub(crate) to: PathBuf,
    /// True if the destination already has the same run with the same generations.
    pub(crate) there: bool,
}

impl<'r, 'e> Copy<'r, 'e> {
    /// Checks the destinations of all runs before the first is copied.
    ///
    /// # Errors
    /// [`Error::Usage`] for two runs with one name, and for an existing run with another number of generations.
    /// [`Error::File`] and [`Error::Usage`] for a destination with other content.
    pub(crate) fn all(
        runs: impl Iterator<Item = &'r Gathered<'e>>,
        root: &Path,
        laboratory: &Laboratory<'e>,
    ) -> Result<Vec<Self>, Error> {
        let mut names: BTreeMap<&Path, &Gathered<'_>> = BTreeMap::new();
        let copies = runs.map(|run| {
            if let Some(first) = names.insert(&run.name, run) {
                let [first, second] = [first, run].map(|run| run.place.display().to_string());
                let name = run.name.display();
                return Err(Error::Usage(format!("{first} and {second} are different runs of one name, {name}")));
            }
            let to = root.join(&run.name);
            let there = is_there(run, &to, laboratory)?;
            Ok(Self { run, to, there })
        });
        copies.collect()
    }

    /// Copies the run. After an error nothing is left.
    ///
    /// # Errors
    /// [`Error::Io`], [`Error::Usage`] for a link or a pipe in the run, and the errors of reading the copy.
    pub(crate) fn make(&self, laboratory: &Laboratory<'e>) -> Result<(), Error> {
        let from = self.run.directory.path();
        Directory::create(&self.to, |draft| {
            // The marks of the checkpoint remain valid while the other files grow.
            copy_file(&self.run.directory.checkpoint(), &draft.checkpoint())?;
            copy_folder(from, draft.path(), 0)?;
            if self.run.is_archived() {
                restore(&self.run.plan, draft)?;
            }
            let copy = Gathered::read(laboratory, draft.clone(), self.run.name.clone())?;
            if copy.lines == self.run.lines { Ok(()) } else { Err(changed(from)) }
        })
        .map(drop)
    }
}

fn changed(path: &Path) -> Error {
    Error::Other(format!("{}: was changed while it was copied", path.display()))
}

/// Checks whether the destination has the run. The result is `false` for a vacant destination.
fn is_there(run: &Gathered<'_>, to: &Path, laboratory: &Laboratory<'_>) -> Result<bool, Error> {
    let Ok(directory) = Directory::open(to) else { return vacant(to).map(|()| false) };
    let there = Gathered::read(laboratory, directory, run.name.clone())?;
    there.identity.same_run(&run.identity, to)?;
    same_version(&there, run)?;
    if there.lines == run.lines {
        return Ok(true);
    }
    let (found, other, from) = (there.lines.len(), run.lines.len(), run.place.display());
    Err(Error::Usage(format!("{}: holds {found} generations of the run that has {other} in {from}", to.display())))
}

/// Copies the files of a folder that are missing in the destination. Hidden files belong to running processes.
fn copy_folder(from: &Path, to: &Path, depth: usize) -> Result<(), Error> {
    let read = || fs::read_dir(from)?.collect::<Result<Vec<_>, _>>();
    for entry in read().map_err(Error::io("read", from))? {
        let (path, to) = (entry.path(), to.join(entry.file_name()));
        if entry.file_name().to_string_lossy().starts_with('.') || to.exists() {
            continue;
        }
        let kind = entry.file_type().map_err(Error::io("read", &path))?;
        if kind.is_file() {
            copy_file(&path, &to)?;
        } else if kind.is_dir() && depth < DEEPEST {
            fs::create_dir(&to).map_err(Error::io("make", &to))?;
            copy_folder(&path, &to, depth + 1)?;
        } else {
            return Err(Error::Usage(format!("{}: is no file that can be copied", path.display())));
        }
    }
    sync_directory(to)
}

/// Copies a file to a new one and synchronizes it with the disk.
fn copy_file(from: &Path, to: &Path) -> Result<(), Error> {
    let mut source = File::open(from).map_err(Error::io("read", from))?;
    let mut copy = OpenOptions::new().write(true).create_new(true).open(to).map_err(Error::io("write", to))?;
    io::copy(&mut source, &mut copy).and_then(|_| copy.sync_all()).map_err(Error::io("write", to))
}
