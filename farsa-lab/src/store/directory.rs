//! Directory of a run and the names of its files.

use std::fs;
use std::io;
use std::path::{Path, PathBuf};

use crate::error::Error;
use crate::escaped::Quoted;
use crate::store::bounded::read_regular_text;
use crate::store::checksummed;
use crate::store::lock::Lock;
use crate::store::replace::sync_directory;
use crate::store::temporary_file;

/// Bytes of the largest configuration that is searched for the name of its experiment.
const MAX_CONFIG_BYTES: u64 = 4_000_000;

/// First bytes of an archive of runs.
pub(crate) const ARCHIVE: [u8; 8] = *b"farsaarc";

/// A run's directory.
#[derive(Debug, Clone)]
pub(crate) struct Directory {
    path: PathBuf,
    /// End of the names of a test's files: empty, or a hyphen and another world than the run's.
    tests: String,
}

impl Directory {
    /// Names a directory that may not exist.
    pub(crate) fn at(path: PathBuf) -> Self {
        Self { path, tests: String::new() }
    }

    /// Gives the tests in another world than the run's their own names.
    pub(crate) fn tests_in(&mut self, world: &str) {
        self.tests = format!("-{world}");
    }

    /// Creates a directory with its first files. After an error nothing is left.
    ///
    /// The files are written to a temporary directory, which is then renamed. Existing files are never touched.
    ///
    /// # Errors
    /// [`Error::File`] for an existing file or a directory that is not empty, and [`Error::Io`].
    pub(crate) fn create(path: &Path, fill: impl FnOnce(&Self) -> Result<(), Error>) -> Result<Self, Error> {
        vacant(path)?;
        if path.file_name().is_none() {
            return Err(Error::occupied(path, "cannot be the directory of a run"));
        }
        let parent = temporary_file::parent(path);
        fs::create_dir_all(parent).map_err(Error::io("make", parent))?;
        temporary_file::sweep_of(path);
        let (draft, _lock) = temporary_file::directory(path).map_err(Error::io("make", path))?;
        fill(&Self::at(draft.path().into()))?;
        // Windows cannot rename to an existing directory, even an empty one. A directory with content is kept by this call.
        if fs::remove_dir(path).is_err() {
            vacant(path)?;
        }
        if let Err(source) = fs::rename(draft.path(), path) {
            // Another process may have created the directory first.
            vacant(path)?;
            return Err(Error::io("make", path)(source));
        }
        // The directory has its final name, so it is not removed.
        let _ = draft.keep();
        sync_directory(parent)?;
        Ok(Self::at(path.into()))
    }

    /// Renames an existing run to the same name with `.old-` and the first free number, and returns the new path. Other
    /// directories are not moved.
    ///
    /// # Errors
    /// [`Error::File`] for a run claimed by another process, and [`Error::Io`].
    pub(crate) fn move_aside(path: &Path) -> Result<Option<PathBuf>, Error> {
        let Some(name) = path.file_name().filter(|_| path.join("config.toml").is_file()) else { return Ok(None) };
        let _lock = Lock::of_run(path)?;
        for number in 1_u64.. {
            let mut other = name.to_os_string();
            other.push(format!(".old-{number}"));
            let other = path.with_file_name(other);
            // The new name is claimed by an empty directory, which the rename replaces. Two processes cannot claim the same
            // number.
            match fs::create_dir(&other) {
                Err(error) if error.kind() == io::ErrorKind::AlreadyExists => continue,
                made => made.map_err(Error::io("make", &other))?,
            }
            if cfg!(windows) || path.is_symlink() {
                fs::remove_dir(&other).map_err(Error::io("move", path))?;
            }
            fs::rename(path, &other).map_err(Error::io("move", path))?;
            sync_directory(temporary_file::parent(path))?;
            return Ok(Some(other));
        }
        Ok(None)
    }

    /// Opens the directory of an existing run.
    ///
    /// # Errors
    /// [`Error::File`].
    pub(crate) fn open(path: &Path) -> Result<Self, Error> {
        let directory = Self::at(path.into());
        if path.is_file() && checksummed::magic(path)? == Some(ARCHIVE) {
            return Err(Error::no_run(path, "is an archive. `merge --out DIR` restores its runs"));
        }
        if !path.is_dir() {
            let near =
                run_named(path, Path::new("runs")).map(|run| format!("; a run of this name is {}", Quoted(&run)));
            return Err(Error::no_run(path, &format!("there is no such directory{}", near.unwrap_or_default())));
        }
        if !directory.config().is_file() {
            return Err(Error::no_run(path, "holds no run: there is no config.toml"));
        }
        Ok(directory)
    }

    pub(crate) fn path(&self) -> &Path {
        &self.path
    }
    /// Gets the path of the complete configuration.
    pub(crate) fn config(&self) -> PathBuf {
        self.path.join("config.toml")
    }
    /// Program versions, machine and timings.
    pub(crate) fn manifest(&self) -> PathBuf {
        self.path.join("manifest.json")
    }
    /// Gets the path of the log of fitness.
    pub(crate) fn log(&self) -> PathBuf {
        self.path.join("fitness.csv")
    }
    /// Gets the path of the log as a picture.
    pub(crate) fn plot(&self) -> PathBuf {
        self.path.join("fitness.svg")
    }
    /// Gets the path of the champion of each population.
    pub(crate) fn champion(&self) -> PathBuf {
        self.path.join("champion.bin")
    }
    /// Gets the path of the state from which a run continues.
    pub(crate) fn checkpoint(&self) -> PathBuf {
        self.path.join("checkpoint.bin")
    }
    /// Gets the path of the reported fitness of every generation.
    pub(crate) fn record(&self) -> PathBuf {
        self.path.join("record.bin")
    }
    /// Gets the path of the file from which earlier versions rebuilt generations.
    pub(crate) fn earlier_lineage(&self) -> PathBuf {
        self.path.join("lineage.bin")
    }
    /// Gets the path of the failed evaluations, if there are any.
    pub(crate) fn failures(&self) -> PathBuf {
        self.path.join("failures.csv")
    }
    /// Gets the path of the parents of every individual.
    pub(crate) fn lineage(&self) -> PathBuf {
        self.path.join("lineage.csv")
    }
    /// The diagnostics of a strategy, in a file with the given name, and their picture.
    pub(crate) fn diagnostics(&self, file: &str) -> [PathBuf; 2] {
        ["csv", "svg"].map(|end| self.path.join(format!("{file}.{end}")))
    }
    /// Imported genotypes, instead of checkpoint and record.
    pub(crate) fn genotypes(&self) -> PathBuf {
        self.path.join("genotypes.bin")
    }
    /// Gets the path of the champion's trials on new starts.
    pub(crate) fn test(&self) -> PathBuf {
        self.path.join(format!("test{}.csv", self.tests))
    }
    /// Gets the path of the description of the test.
    pub(crate) fn test_record(&self) -> PathBuf {
        self.path.join(format!("test{}.json", self.tests))
    }
    /// Gets the paths of the tests of every n-th generation, a table and its description.
    pub(crate) fn sampled_tests(&self) -> [PathBuf; 2] {
        ["csv", "json"].map(|end| self.path.join(format!("test-generations{}.{end}", self.tests)))
    }
    /// Gets the directory of tests by protocols.
    pub(crate) fn protocols(&self) -> PathBuf {
        self.path.join(format!("protocols{}", self.tests))
    }
}

/// Finds the first run in `runs` with the name of a path, or of the experiment of that name.
fn run_named(path: &Path, runs: &Path) -> Option<String> {
    let name = path.file_stem()?.to_str().filter(|_| path.components().count() == 1)?;
    let experiment = format!("experiment = {name:?}");
    let mut names: Vec<String> =
        fs::read_dir(runs).ok()?.filter_map(|entry| entry.ok()?.file_name().into_string().ok()).collect();
    names.sort();
    let is_run = |run: &String| {
        let Some(rest) = run.strip_prefix(name) else { return false };
        let config = read_regular_text(&runs.join(run).join("config.toml"), MAX_CONFIG_BYTES);
        config.is_ok_and(|config| {
            // Below a comment, the experiment comes first in every configuration.
            let is_of_experiment = || config.lines().take(2).any(|line| line == experiment);
            rest.is_empty()
                || rest.strip_prefix('-').is_some_and(|end| end.parse::<u64>().is_ok() || is_of_experiment())
        })
    };
    Some(runs.join(names.into_iter().find(is_run)?).display().to_string())
}

/// Checks that a run can be created: there is no file, or an empty directory.
///
/// # Errors
/// [`Error::File`], [`Error::Io`].
pub(crate) fn vacant(path: &Path) -> Result<(), Error> {
    match fs::read_dir(path).map(|mut entries| entries.next().is_none()) {
        Ok(true) => Ok(()),
        Ok(false) if path.join("config.toml").is_file() => Err(Error::occupied(
            path,
            "already holds a run: go on with `run --resume`, give another directory with --out, or move \
                 it aside with --force",
        )),
        Ok(false) => Err(Error::occupied(path, "already holds other files: give another directory with --out")),
        Err(error) if error.kind() == io::ErrorKind::NotFound => Ok(()),
        Err(error) if error.kind() == io::ErrorKind::NotADirectory => Err(Error::occupied(path, "is not a directory")),
        Err(source) => Err(Error::Io { doing: "read", path: path.into(), source }),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::store::replace::replace;

    #[test]
    fn a_run_of_another_experiment_is_not_suggested() {
        let folder = tempfile::tempdir().unwrap();
        let add = |run: &str, experiment: &str| {
            fs::create_dir(folder.path().join(run)).unwrap();
            let config = format!("# A comment.\nexperiment = \"{experiment}\"\ncondition = \"far\"\nseed = 1\n");
            fs::write(folder.path().join(run).join("config.toml"), config).unwrap();
        };
        let suggested = |path: &str| {
            let run = run_named(Path::new(path), folder.path())?;
            Some(Path::new(&run).strip_prefix(folder.path()).unwrap().to_str().unwrap().to_owned())
        };
        fs::create_dir(folder.path().join("follow-1")).unwrap();
        add("follow-me-1", "follow-me");
        assert_eq!((suggested("follow"), suggested("follow-me-1")), (None, Some("follow-me-1".into())));
        add("follow-me-far-1", "follow-me");
        add("follow-near-2", "follow");
        assert_eq!(
            (suggested("follow"), suggested("follow-me.toml")),
            (Some("follow-near-2".into()), Some("follow-me-1".into()))
        );
        assert_eq!((suggested("follow-near"), suggested("foll")), (Some("follow-near-2".into()), None));
    }

    #[test]
    fn a_directory_is_made_whole_or_not_at_all() {
        let folder = tempfile::tempdir().unwrap();
        let root = folder.path();
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
    }

    #[test]
    fn a_run_is_moved_aside_and_never_lost() {
        let folder = tempfile::tempdir().unwrap();
        let run = folder.path().join("a.run");
        assert_eq!(Directory::move_aside(&run).unwrap(), None);
        fs::create_dir(folder.path().join("a.run.old-2")).unwrap();
        for (text, kept) in [("first", "a.run.old-1"), ("second", "a.run.old-3")] {
            Directory::create(&run, |directory| replace(&directory.config(), text.as_bytes())).unwrap();
            let held = Lock::of_run(&run).unwrap();
            let refused = Directory::move_aside(&run).unwrap_err();
            assert!(refused.to_string().contains("another process is at this run"), "{refused}");
            drop(held);
            let kept = folder.path().join(kept);
            assert_eq!(Directory::move_aside(&run).unwrap(), Some(kept.clone()));
            assert!(!run.exists());
            assert_eq!(fs::read_to_string(kept.join("config.toml")).unwrap(), text);
        }
        assert_eq!(fs::read_dir(folder.path().join("a.run.old-2")).unwrap().count(), 0);
        // A directory without a run is not moved.
        fs::create_dir(&run).unwrap();
        fs::write(run.join("letter.txt"), "dear").unwrap();
        assert_eq!(Directory::move_aside(&run).unwrap(), None);
        assert!(run.join("letter.txt").is_file());
    }
}
