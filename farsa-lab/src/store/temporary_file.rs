//! Temporary files and directories, renamed to their final names once they are complete.
//!
//! A temporary file is in the directory of its final name, so that the rename is atomic. Its name is random, it is created
//! exclusively, and no link is followed. Its process holds a lock on it. The system releases the lock when the process ends, so a
//! temporary file that can be locked is abandoned.

use std::ffi::OsString;
use std::fs::{self, File, TryLockError};
use std::io;
use std::path::{Path, PathBuf};

use tempfile::{Builder, NamedTempFile, TempDir};

use crate::store::lock::{self, RUN_LOCK};

/// End of all temporary names.
const SUFFIX: &str = ".new";
/// Number of random letters and digits in a temporary name.
const RANDOM: usize = 12;
/// Bytes of the final name that are repeated in the temporary one. File systems allow 255 in all.
const MAX_NAME_BYTES: usize = 200;
/// Number of tries when another process sweeps a temporary file before it is locked.
const ATTEMPTS: usize = 20;

/// Returns the directory of a path.
pub(crate) fn parent(path: &Path) -> &Path {
    match path.parent() {
        Some(parent) if parent != Path::new("") => parent,
        _ => Path::new("."),
    }
}

/// Formats the start of the temporary names of a file or directory.
fn prefix(path: &Path) -> String {
    let name = path.file_name().unwrap_or_default().to_string_lossy();
    let end = (0..=name.len().min(MAX_NAME_BYTES)).rev().find(|end| name.is_char_boundary(*end)).unwrap_or(0);
    format!(".{}.", &name[..end])
}

fn create<T>(path: &Path, mode: u32, make: impl Fn(&Builder<'_, '_>, &Path) -> io::Result<T>) -> io::Result<T> {
    let prefix = OsString::from(prefix(path));
    let mut builder = Builder::new();
    builder.prefix(&prefix).suffix(SUFFIX).rand_bytes(RANDOM);
    // The mode of a file created under its final name. The user's mask applies to it.
    #[cfg(unix)]
    builder.permissions(std::os::unix::fs::PermissionsExt::from_mode(mode));
    let _ = mode;
    make(&builder, parent(path)).map_err(without_temporary_name)
}

/// The system's error, without the temporary name that `tempfile` adds.
fn without_temporary_name(error: io::Error) -> io::Error {
    match error.get_ref().and_then(|inner| inner.source()) {
        Some(inner) => io::Error::new(error.kind(), inner.to_string()),
        None => error,
    }
}

/// Locks a file that was just created. The result is `false` if another process has locked or removed it.
fn locked(file: &File, path: &Path) -> bool {
    // On a file system without locks no process sweeps.
    !matches!(file.try_lock(), Err(TryLockError::WouldBlock)) && fs::symlink_metadata(path).is_ok()
}

fn swept() -> io::Error {
    io::Error::other("another process removes what this one makes")
}

/// Creates an empty file next to `path`, which is removed unless it is persisted.
pub(crate) fn file(path: &Path) -> io::Result<NamedTempFile> {
    for _ in 0..ATTEMPTS {
        let file = create(path, 0o666, |builder, folder| builder.tempfile_in(folder))?;
        if locked(file.as_file(), file.path()) {
            return Ok(file);
        }
    }
    Err(swept())
}

/// Creates an empty directory next to `path`, and the locked file in it. The directory is removed with its content unless it is
/// kept.
pub(crate) fn directory(path: &Path) -> io::Result<(TempDir, File)> {
    for _ in 0..ATTEMPTS {
        let directory = create(path, 0o777, |builder, folder| builder.tempdir_in(folder))?;
        let lock = directory.path().join(RUN_LOCK);
        match lock::open(&lock) {
            Ok(file) if locked(&file, &lock) => return Ok((directory, file)),
            Ok(_) => {}
            // An empty directory without a lock may have been swept.
            Err(error) if error.kind() == io::ErrorKind::NotFound => {}
            Err(error) => return Err(error),
        }
    }
    Err(swept())
}

/// Removes the abandoned temporary files in a run directory.
pub(crate) fn sweep_run(folder: &Path) {
    sweep(folder, ".");
}

/// Removes the abandoned temporary files of one file or directory.
pub(crate) fn sweep_of(path: &Path) {
    sweep(parent(path), &prefix(path));
}

/// Removes the abandoned temporary files in a folder whose names start with `prefix`.
fn sweep(folder: &Path, prefix: &str) {
    for (path, _) in entries(folder).filter(|(_, name)| is_temporary(name, prefix)) {
        // No result depends on a file that cannot be removed. The next sweep tries again.
        match fs::symlink_metadata(&path) {
            Ok(metadata) if metadata.is_dir() => remove_directory(&path),
            _ => {
                if let Some(_lock) = abandoned(&path) {
                    let _ = fs::remove_file(&path);
                }
            }
        }
    }
}

fn entries(folder: &Path) -> impl Iterator<Item = (PathBuf, String)> {
    let entries = fs::read_dir(folder).into_iter().flatten().filter_map(Result::ok);
    entries.filter_map(|entry| Some((entry.path(), entry.file_name().into_string().ok()?)))
}

/// Checks whether a name has the form that [`create`] gives: the prefix, the rest of a final name, and random letters.
fn is_temporary(name: &str, prefix: &str) -> bool {
    let Some((start, random)) = name.strip_suffix(SUFFIX).and_then(|rest| rest.rsplit_once('.')) else { return false };
    let complete = start.len() + 1 >= prefix.len() && name.starts_with(prefix) && start.len() > 1;
    complete && random.len() == RANDOM && random.bytes().all(|letter| letter.is_ascii_alphanumeric())
}

/// Opens and locks a regular file that no process has locked.
fn abandoned(path: &Path) -> Option<File> {
    let regular = fs::symlink_metadata(path).is_ok_and(|metadata| metadata.is_file());
    let file = if regular { File::open(path).ok()? } else { return None };
    file.try_lock().is_ok().then_some(file)
}

fn remove_directory(path: &Path) {
    match abandoned(&path.join(RUN_LOCK)) {
        Some(_lock) => {
            // The lock comes last: without it a later sweep could not claim the rest after a kill.
            for (entry, _) in entries(path).filter(|(_, name)| name != RUN_LOCK) {
                drop(fs::remove_file(&entry).or_else(|_| fs::remove_dir_all(&entry)));
            }
            drop(fs::remove_dir_all(path));
        }
        // Without a lock only an empty directory is ours.
        None => drop(fs::remove_dir(path)),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::io::Write as _;

    fn names(folder: &Path) -> Vec<String> {
        let mut names: Vec<String> = entries(folder).map(|(_, name)| name).collect();
        names.sort();
        names
    }

    #[test]
    fn only_abandoned_files_are_swept() {
        let folder = tempfile::tempdir().unwrap();
        let at = |name: &str| folder.path().join(name);
        let mut alive = file(&at("champion.bin")).unwrap();
        let (_, dead) = file(&at("champion.bin")).unwrap().keep().unwrap();
        for name in [
            "champion.bin",
            ".champion.bin.new",
            ".notes.new",
            ".champion.bin.abc.new",
            ".a.0123456789ab.new~",
            "..0123456789ab.new",
        ] {
            fs::write(at(name), "x").unwrap();
        }
        let victim = at("victim");
        fs::write(&victim, "precious").unwrap();
        #[cfg(unix)]
        std::os::unix::fs::symlink(&victim, at(".link.0123456789ab.new")).unwrap();
        sweep_run(folder.path());
        assert!(!dead.exists() && alive.path().exists());
        let mut left = vec![
            "..0123456789ab.new",
            ".a.0123456789ab.new~",
            ".champion.bin.abc.new",
            ".champion.bin.new",
            ".notes.new",
            "champion.bin",
            "victim",
        ];
        if cfg!(unix) {
            left.push(".link.0123456789ab.new");
        }
        let own = alive.path().file_name().unwrap().to_str().unwrap().to_owned();
        left.push(&own);
        left.sort_unstable();
        assert_eq!(names(folder.path()), left);
        assert_eq!(fs::read(&victim).unwrap(), b"precious");
        alive.write_all(b"still mine").unwrap();
    }

    #[test]
    fn directories_are_swept_once_their_processes_have_ended() {
        let folder = tempfile::tempdir().unwrap();
        let run = folder.path().join("run");
        let (alive, _lock) = directory(&run).unwrap();
        let (dead, lock) = directory(&run).unwrap();
        let dead = dead.keep();
        fs::write(dead.join("config.toml"), "x").unwrap();
        drop(lock);
        let bare = folder.path().join(".run.0123456789ab.new");
        fs::create_dir(&bare).unwrap();
        let other = folder.path().join(".run.ba9876543210.new");
        fs::create_dir(&other).unwrap();
        fs::write(other.join("letter.txt"), "dear").unwrap();
        let (next, _other_lock) = directory(&folder.path().join("next")).unwrap();
        sweep_of(&run);
        assert!(alive.path().exists() && !dead.exists() && !bare.exists());
        assert!(other.join("letter.txt").exists() && next.path().exists());
    }

    #[test]
    fn any_name_has_random_temporary_names() {
        let folder = tempfile::tempdir().unwrap();
        for name in ["x".repeat(255), "é".repeat(127), "a".into()] {
            let path = folder.path().join(name);
            let (first, second) = (file(&path).unwrap(), file(&path).unwrap());
            assert_ne!(first.path(), second.path());
            assert!(directory(&path).is_ok());
        }
    }
}
