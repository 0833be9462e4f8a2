//! The files of a run, and how they are replaced without ever being half written.

use std::fs::{self, File, OpenOptions};
use std::io::{self, Write as _};
use std::path::{Path, PathBuf};
use std::process;

use crate::error::Error;

/// A run's directory.
#[derive(Debug, Clone)]
pub(crate) struct Directory {
    path: PathBuf,
    /// What the names of a test's files end with: nothing, or a hyphen and another world than the run's.
    tests: String,
}

impl Directory {
    fn at(path: PathBuf) -> Self {
        Self { path, tests: String::new() }
    }

    /// Tests in another world than the run's have files of their own.
    pub(crate) fn tests_in(&mut self, world: &str) {
        self.tests = format!("-{world}");
    }

    /// Makes a new directory out of its first files, all of them or none.
    ///
    /// They are written beside the place and moved there at once, so that nothing that is there is ever touched.
    ///
    /// # Errors
    /// [`Error::Occupied`] when there is something at the place already, [`Error::Io`].
    pub(crate) fn create(path: &Path, fill: impl FnOnce(&Self) -> Result<(), Error>) -> Result<Self, Error> {
        vacant(path)?;
        let name = path.file_name().ok_or_else(|| occupied(path, "cannot be the directory of a run"))?;
        let parent = parent(path);
        fs::create_dir_all(parent).map_err(Error::io("make", parent))?;
        let draft = Self::at(parent.join(format!(".{}.{}", name.to_string_lossy(), process::id())));
        fs::create_dir(&draft.path).map_err(Error::io("make", &draft.path))?;
        let moved = fill(&draft).and_then(|()| {
            // Windows moves nothing onto a directory, even an empty one; a full one is in nobody's way by now.
            if fs::remove_dir(path).is_err() {
                vacant(path)?;
            }
            fs::rename(&draft.path, path).map_err(Error::io("make", path))?;
            sync_directory(parent)
        });
        if moved.is_err() {
            // Only our own unfinished files; that they may stay is no reason to hide the first error.
            let _ = fs::remove_dir_all(&draft.path);
        }
        moved.map(|()| Self::at(path.into()))
    }

    /// The directory of a run that exists.
    ///
    /// # Errors
    /// [`Error::NoRun`].
    pub(crate) fn open(path: &Path) -> Result<Self, Error> {
        let directory = Self::at(path.into());
        let why = if !path.is_dir() {
            "there is no such directory"
        } else if !directory.config().is_file() {
            "holds no run: there is no config.toml"
        } else {
            return Ok(directory);
        };
        Err(Error::NoRun { directory: path.into(), why: why.into() })
    }

    pub(crate) fn path(&self) -> &Path {
        &self.path
    }
    /// The complete configuration.
    pub(crate) fn config(&self) -> PathBuf {
        self.path.join("config.toml")
    }
    /// What made the run: versions, machine, timings.
    pub(crate) fn manifest(&self) -> PathBuf {
        self.path.join("manifest.json")
    }
    /// The log of fitness.
    pub(crate) fn log(&self) -> PathBuf {
        self.path.join("fitness.csv")
    }
    /// The log as a picture.
    pub(crate) fn plot(&self) -> PathBuf {
        self.path.join("fitness.svg")
    }
    /// The best individual of the last generation.
    pub(crate) fn champion(&self) -> PathBuf {
        self.path.join("champion.bin")
    }
    /// Where to go on.
    pub(crate) fn checkpoint(&self) -> PathBuf {
        self.path.join("checkpoint.bin")
    }
    /// What the strategy was told in every generation.
    pub(crate) fn record(&self) -> PathBuf {
        self.path.join("record.bin")
    }
    /// What earlier versions rebuilt generations from.
    pub(crate) fn earlier_lineage(&self) -> PathBuf {
        self.path.join("lineage.bin")
    }
    /// The parents of every individual.
    pub(crate) fn lineage(&self) -> PathBuf {
        self.path.join("lineage.csv")
    }
    /// What a strategy says of each generation, in a file whose name without `.csv` it gives, and the picture of it.
    pub(crate) fn diagnostics(&self, file: &str) -> [PathBuf; 2] {
        ["csv", "svg"].map(|end| self.path.join(format!("{file}.{end}")))
    }
    /// Genotypes that were imported, in the place of checkpoint and record.
    pub(crate) fn genotypes(&self) -> PathBuf {
        self.path.join("genotypes.bin")
    }
    /// The champion's trials on fresh starts.
    pub(crate) fn test(&self) -> PathBuf {
        self.path.join(format!("test{}.csv", self.tests))
    }
    /// Which test that was.
    pub(crate) fn test_record(&self) -> PathBuf {
        self.path.join(format!("test{}.json", self.tests))
    }
}

fn occupied(path: &Path, why: &str) -> Error {
    Error::Occupied { directory: path.into(), why: why.into() }
}

/// Whether a run can be put at a place: there is nothing, or an empty directory.
///
/// # Errors
/// [`Error::Occupied`], [`Error::Io`].
pub(crate) fn vacant(path: &Path) -> Result<(), Error> {
    match fs::read_dir(path).map(|mut entries| entries.next().is_none()) {
        Ok(true) => Ok(()),
        Ok(false) if path.join("config.toml").is_file() => {
            Err(occupied(path, "already holds a run: go on with `run --resume`, or give another directory with --out"))
        }
        Ok(false) => Err(occupied(path, "already holds other files: give another directory with --out")),
        Err(error) if error.kind() == io::ErrorKind::NotFound => Ok(()),
        Err(error) if error.kind() == io::ErrorKind::NotADirectory => Err(occupied(path, "is not a directory")),
        Err(source) => Err(Error::Io { doing: "read", path: path.into(), source }),
    }
}

fn parent(path: &Path) -> &Path {
    match path.parent() {
        Some(parent) if parent != Path::new("") => parent,
        _ => Path::new("."),
    }
}

/// Puts new content in place of a file's: written beside it, brought to the disk, then renamed.
///
/// A reader, a crash or a full disk meets the old content or the new one, never a part.
pub(crate) fn replace(path: &Path, bytes: &[u8]) -> Result<(), Error> {
    let mut name = std::ffi::OsString::from(".");
    name.push(path.file_name().unwrap_or_default());
    name.push(".new");
    let draft = path.with_file_name(name);
    let written = File::create(&draft).and_then(|mut file| {
        file.write_all(bytes)?;
        file.sync_all()?;
        fs::rename(&draft, path)
    });
    if let Err(source) = written {
        // A part of a file is worth nothing, and its room may be what the next write needs.
        let _ = fs::remove_file(&draft);
        return Err(Error::Io { doing: "write", path: path.into(), source });
    }
    sync_directory(parent(path))
}

/// Brings a rename to the disk, where directories can be opened at all.
fn sync_directory(path: &Path) -> Result<(), Error> {
    if cfg!(unix) {
        File::open(path).and_then(|directory| directory.sync_all()).map_err(Error::io("write", path))?;
    }
    Ok(())
}

/// Opens a file to write a result to: a new file, or a pipe or device that is there.
///
/// # Errors
/// [`Error::Usage`] when there is a file already, [`Error::Io`].
pub(crate) fn create_result(path: &Path) -> Result<File, Error> {
    match OpenOptions::new().write(true).create_new(true).open(path) {
        Err(error) if error.kind() == io::ErrorKind::AlreadyExists => {
            if fs::metadata(path).is_ok_and(|metadata| metadata.is_file() || metadata.is_dir()) {
                return Err(Error::Usage(format!("{}: there is one already", path.display())));
            }
            OpenOptions::new().write(true).open(path).map_err(Error::io("write", path))
        }
        opened => opened.map_err(Error::io("write", path)),
    }
}

/// Writes results to new files, all of them or none.
///
/// # Errors
/// As [`create_result`]; no file is then left behind.
pub(crate) fn create_results(results: &[(PathBuf, impl AsRef<[u8]>)]) -> Result<(), Error> {
    let mut made: Vec<&Path> = Vec::new();
    let written = results.iter().try_for_each(|(path, content)| {
        let there = path.exists();
        let mut file = create_result(path)?;
        if !there {
            made.push(path);
        }
        file.write_all(content.as_ref()).map_err(Error::io("write", path))
    });
    if written.is_err() {
        for path in made {
            // Our own file; that it may stay is no reason to hide the first error.
            let _ = fs::remove_file(path);
        }
    }
    written
}

#[cfg(test)]
mod tests {
    use super::*;

    fn scratch(name: &str) -> PathBuf {
        let path = std::env::temp_dir().join(format!("farsa-directory-{name}-{}", process::id()));
        fs::create_dir_all(&path).unwrap();
        path
    }

    #[test]
    fn a_directory_is_made_whole_or_not_at_all() {
        let root = scratch("whole");
        let run = root.join("deep/run");
        let failed = Directory::create(&run, |directory| {
            fs::write(directory.config(), "x").unwrap();
            Err(Error::Other("no".into()))
        });
        assert!(failed.is_err() && !run.exists());
        assert_eq!(fs::read_dir(root.join("deep")).unwrap().count(), 0);

        fs::create_dir(&run).unwrap();
        let made = Directory::create(&run, |directory| replace(&directory.config(), b"x")).unwrap();
        assert_eq!(fs::read(made.config()).unwrap(), b"x");
        assert!(Directory::open(&run).is_ok());

        let again = Directory::create(&run, |_| Ok(())).unwrap_err();
        assert!(again.to_string().contains("already holds a run"), "{again}");
        fs::remove_file(made.config()).unwrap();
        fs::write(run.join("letter.txt"), "dear").unwrap();
        let other = Directory::create(&run, |_| Ok(())).unwrap_err();
        assert!(other.to_string().contains("already holds other files"), "{other}");
        assert!(Directory::create(&run.join("letter.txt"), |_| Ok(())).is_err());
        assert!(Directory::open(&run).is_err() && Directory::open(&root.join("none")).is_err());
        assert_eq!(fs::read(run.join("letter.txt")).unwrap(), b"dear");
        fs::remove_dir_all(root).unwrap();
    }

    #[test]
    fn what_cannot_be_written_leaves_the_old_content() {
        let root = scratch("replace");
        let path = root.join("file");
        replace(&path, b"old").unwrap();
        replace(&path, b"new").unwrap();
        // Something in the way of the new content.
        fs::create_dir(root.join(".file.new")).unwrap();
        let error = replace(&path, b"newer").unwrap_err();
        assert!(error.to_string().starts_with("cannot write "), "{error}");
        assert_eq!(fs::read(&path).unwrap(), b"new");
        assert!(create_result(&path).is_err() && create_result(&root).is_err());
        let results = ["first", "file", "last"].map(|name| (root.join(name), name.to_owned()));
        assert!(create_results(&results).is_err());
        assert!(!root.join("first").exists() && !root.join("last").exists());
        assert_eq!(fs::read(&path).unwrap(), b"new");
        create_results(&[results[0].clone(), results[2].clone()]).unwrap();
        assert_eq!(fs::read(root.join("last")).unwrap(), b"last");
        fs::remove_dir_all(root).unwrap();
    }
}
