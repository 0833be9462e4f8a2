//! Locks between processes. They end with the process that holds them.

use std::fs::{self, File, OpenOptions, TryLockError};
use std::io;
use std::path::Path;
use std::thread;
use std::time::Duration;

use crate::error::Error;

/// File that a process locks while it continues a run.
pub(crate) const RUN_LOCK: &str = ".run.lock";
/// File that a process locks while it writes the files of a test.
const TEST_LOCK: &str = ".test.lock";
/// Number of tries for the lock of a test, and the pause between them. Two small files are written under it.
const ATTEMPTS: usize = 200;
const PAUSE: Duration = Duration::from_millis(50);

/// Number of tries for the lock of a run, and the pause between them. [`is_held`] takes a shared lock for some microseconds.
const RUN_ATTEMPTS: usize = 4;
const RUN_PAUSE: Duration = Duration::from_millis(3);

/// A lock that is held until this value is dropped.
#[derive(Debug)]
pub(crate) struct Lock {
    _file: File,
}

impl Lock {
    /// Locks a run.
    ///
    /// # Errors
    /// [`Error::File`] when another process has locked it, and [`Error::Io`].
    pub(crate) fn of_run(directory: &Path) -> Result<Self, Error> {
        Self::of_free_run(directory)?
            .ok_or_else(|| Error::occupied(directory, "another process is at this run right now"))
    }

    /// Locks a run, or returns `None` when another process has locked it.
    ///
    /// # Errors
    /// [`Error::Io`].
    pub(crate) fn of_free_run(directory: &Path) -> Result<Option<Self>, Error> {
        let path = directory.join(RUN_LOCK);
        let file = open(&path).map_err(Error::io("lock", &path))?;
        for attempt in 0..RUN_ATTEMPTS {
            match file.try_lock() {
                Ok(()) => return Ok(Some(Self { _file: file })),
                Err(TryLockError::WouldBlock) if attempt + 1 < RUN_ATTEMPTS => thread::sleep(RUN_PAUSE),
                Err(TryLockError::WouldBlock) => break,
                Err(TryLockError::Error(source)) => return Err(Error::Io { doing: "lock", path, source }),
            }
        }
        Ok(None)
    }

    /// Waits for the lock of a run's tests.
    ///
    /// # Errors
    /// [`Error::File`] when another process holds it for more than ten seconds, and [`Error::Io`].
    pub(crate) fn of_tests(directory: &Path) -> Result<Self, Error> {
        let path = directory.join(TEST_LOCK);
        let file = open(&path).map_err(Error::io("lock", &path))?;
        for _ in 0..ATTEMPTS {
            match file.try_lock() {
                Ok(()) => return Ok(Self { _file: file }),
                Err(TryLockError::WouldBlock) => thread::sleep(PAUSE),
                Err(TryLockError::Error(source)) => return Err(Error::Io { doing: "lock", path, source }),
            }
        }
        Err(Error::occupied(directory, "another process has been writing a test here for ten seconds"))
    }
}

/// Checks if a process has locked a file, which is only read. A missing file is not locked.
pub(crate) fn is_held(path: &Path) -> bool {
    let is_file = fs::symlink_metadata(path).is_ok_and(|metadata| metadata.is_file());
    let file = if is_file { File::open(path).ok() } else { None };
    file.is_some_and(|file| matches!(file.try_lock_shared(), Err(TryLockError::WouldBlock)))
}

/// Opens or creates a file for a lock. Nothing is written, and links and pipes are refused.
pub(crate) fn open(path: &Path) -> io::Result<File> {
    match OpenOptions::new().write(true).create_new(true).open(path) {
        Err(error) if error.kind() == io::ErrorKind::AlreadyExists => {
            if !fs::symlink_metadata(path)?.is_file() {
                return Err(io::Error::other("is no regular file"));
            }
            OpenOptions::new().write(true).open(path)
        }
        opened => opened,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_held_lock_is_seen_and_a_look_at_it_delays_no_run() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join(RUN_LOCK);
        assert!(!is_held(&path) && !path.exists());
        let lock = Lock::of_run(folder.path()).unwrap();
        assert!(is_held(&path) && Lock::of_free_run(folder.path()).unwrap().is_none());
        drop(lock);
        assert!(!is_held(&path));
        let shared = File::open(&path).unwrap();
        shared.try_lock_shared().unwrap();
        let end = thread::spawn(move || {
            thread::sleep(RUN_PAUSE);
            drop(shared);
        });
        Lock::of_run(folder.path()).unwrap();
        end.join().unwrap();
    }
}
