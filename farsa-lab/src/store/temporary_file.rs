//! Files and directories before they have their names, and what processes that died have left of them.
//!
//! A draft lies beside what it becomes, so that a rename brings it there at once. Its name cannot be foreseen, it is made
//! exclusively, and no link is followed: what lies in a stranger's directory under any name is never written to. Whoever makes a
//! draft holds a lock on it, which the system releases when the process ends, however it ends; a draft that can be locked is
//! nobody's any more.

use std::ffi::OsString;
use std::fs::{self, File, TryLockError};
use std::hash::{BuildHasher as _, Hasher as _, RandomState};
use std::io;
use std::path::{Path, PathBuf};

use tempfile::{Builder, NamedTempFile, TempDir};

use crate::store::lock::{self, RUN_LOCK};

/// What the names of drafts end with.
const SUFFIX: &str = ".new";
/// Letters before it, which no one can foresee.
const RANDOM: usize = 12;
/// Bytes of the final name that a draft's name begins with: 255 are allowed.
const MAX_NAME_BYTES: usize = 200;
/// How often a draft is made again when somebody has swept it before it was locked.
const ATTEMPTS: usize = 20;

/// The directory that a path lies in.
pub(crate) fn parent(path: &Path) -> &Path {
    match path.parent() {
        Some(parent) if parent != Path::new("") => parent,
        _ => Path::new("."),
    }
}

/// What the names of all drafts of a file or directory begin with.
fn prefix(path: &Path) -> OsString {
    let name = path.file_name().unwrap_or_default().to_string_lossy();
    let end = (0..=name.len().min(MAX_NAME_BYTES)).rev().find(|end| name.is_char_boundary(*end)).unwrap_or(0);
    OsString::from(format!(".{}.", &name[..end]))
}

fn builder<T>(path: &Path, mode: u32, make: impl Fn(&Builder<'_, '_>, &Path) -> io::Result<T>) -> io::Result<T> {
    let mut prefix = prefix(path);
    // The keys of this hash are the system's random numbers.
    let random = RandomState::new().build_hasher().finish();
    prefix.push(format!("{:0RANDOM$x}", random >> (64 - 4 * RANDOM)));
    let mut builder = Builder::new();
    builder.prefix(&prefix).suffix(SUFFIX).rand_bytes(0);
    // As if it had been made under its final name: the user's mask takes away what others may not do.
    #[cfg(unix)]
    builder.permissions(std::os::unix::fs::PermissionsExt::from_mode(mode));
    let _ = mode;
    make(&builder, parent(path)).map_err(plain)
}

/// The system's own error, without the name that nobody knows.
fn plain(error: io::Error) -> io::Error {
    match error.get_ref().and_then(|inner| inner.source()) {
        Some(inner) => io::Error::new(error.kind(), inner.to_string()),
        None => error,
    }
}

/// Whether the lock on a draft that was just made is ours, and the draft still there.
fn held(file: &File, path: &Path) -> bool {
    // A file system without locks has nobody who sweeps, either.
    !matches!(file.try_lock(), Err(TryLockError::WouldBlock)) && fs::symlink_metadata(path).is_ok()
}

fn swept() -> io::Error {
    io::Error::other("another process removes what this one makes")
}

/// Makes an empty file beside `path`, which is removed unless it is persisted.
pub(crate) fn file(path: &Path) -> io::Result<NamedTempFile> {
    for _ in 0..ATTEMPTS {
        let draft = match builder(path, 0o666, |builder, folder| builder.tempfile_in(folder)) {
            Err(error) if error.kind() == io::ErrorKind::AlreadyExists => continue,
            draft => draft?,
        };
        if held(draft.as_file(), draft.path()) {
            return Ok(draft);
        }
    }
    Err(swept())
}

/// Makes an empty directory beside `path`, which is removed with all that is in it unless it is kept, and the file in it that
/// locks it.
pub(crate) fn directory(path: &Path) -> io::Result<(TempDir, File)> {
    for _ in 0..ATTEMPTS {
        let draft = match builder(path, 0o777, |builder, folder| builder.tempdir_in(folder)) {
            Err(error) if error.kind() == io::ErrorKind::AlreadyExists => continue,
            draft => draft?,
        };
        let place = draft.path().join(RUN_LOCK);
        match lock::open(&place) {
            Ok(file) if held(&file, &place) => return Ok((draft, file)),
            Ok(_) => {}
            // An empty directory without a lock may have been swept.
            Err(error) if error.kind() == io::ErrorKind::NotFound => {}
            Err(error) => return Err(error),
        }
    }
    Err(swept())
}

/// Removes the drafts in a run's directory that processes have left which ended before their time.
pub(crate) fn sweep(folder: &Path) {
    for (path, name) in entries(folder) {
        // Earlier versions had one name for the draft of a file.
        let earlier =
            ["champion.bin", "checkpoint.bin", "fitness.svg", "manifest.json", "config.toml", "test.csv", "test.json"]
                .iter()
                .any(|of| name == format!(".{of}{SUFFIX}"));
        if earlier || is_draft(&name, ".") {
            remove_file(&path);
        }
    }
}

/// Removes the drafts of one file or directory that processes have left which ended before their time.
pub(crate) fn sweep_of(path: &Path) {
    let prefix = prefix(path).to_string_lossy().into_owned();
    for (path, _) in entries(parent(path)).filter(|(_, name)| is_draft(name, &prefix)) {
        remove_file(&path);
        remove_directory(&path);
    }
}

fn entries(folder: &Path) -> impl Iterator<Item = (PathBuf, String)> {
    // What cannot be read is swept another time: nothing depends on it.
    let entries = fs::read_dir(folder).into_iter().flatten().filter_map(Result::ok);
    entries.filter_map(|entry| Some((entry.path(), entry.file_name().into_string().ok()?)))
}

/// Whether this is a name that [`builder`] gives: the prefix, the rest of a final name, and random letters.
fn is_draft(name: &str, prefix: &str) -> bool {
    let Some((start, random)) = name.strip_suffix(SUFFIX).and_then(|rest| rest.rsplit_once('.')) else { return false };
    let whole = start.len() + 1 >= prefix.len() && name.starts_with(prefix) && start.len() > 1;
    whole && random.len() == RANDOM && random.bytes().all(|letter| letter.is_ascii_hexdigit())
}

/// Opens a regular file that nobody holds a lock on.
fn abandoned(path: &Path) -> Option<File> {
    let regular = fs::symlink_metadata(path).is_ok_and(|metadata| metadata.is_file());
    let file = if regular { File::open(path).ok()? } else { return None };
    file.try_lock().is_ok().then_some(file)
}

fn remove_file(path: &Path) {
    if let Some(_lock) = abandoned(path) {
        let _ = fs::remove_file(path);
    }
}

fn remove_directory(path: &Path) {
    if !fs::symlink_metadata(path).is_ok_and(|metadata| metadata.is_dir()) {
        return;
    }
    match abandoned(&path.join(RUN_LOCK)) {
        Some(_lock) => {
            // The lock last: without it nobody would know whose the rest is if this process is killed meanwhile.
            for (other, _) in entries(path).filter(|(_, name)| name != RUN_LOCK) {
                drop(fs::remove_file(&other).or_else(|_| fs::remove_dir_all(&other)));
            }
            drop(fs::remove_dir_all(path));
        }
        // Without a lock nothing else is in it; if there is, it is not ours.
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
    fn only_abandoned_drafts_are_swept() {
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
        sweep(folder.path());
        assert!(!dead.exists() && alive.path().exists());
        let mut left = vec![
            "..0123456789ab.new",
            ".a.0123456789ab.new~",
            ".champion.bin.abc.new",
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
    fn drafts_of_directories_are_swept_once_their_makers_are_gone() {
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
    fn any_name_has_a_draft_and_none_is_foreseen() {
        let folder = tempfile::tempdir().unwrap();
        for name in ["x".repeat(255), "é".repeat(127), "a".into()] {
            let path = folder.path().join(name);
            let (first, second) = (file(&path).unwrap(), file(&path).unwrap());
            assert_ne!(first.path(), second.path());
            assert!(directory(&path).is_ok());
        }
    }
}
