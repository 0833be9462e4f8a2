//! Atomic replacement of files.

use std::fs::{self, File, OpenOptions};
use std::io::{self, Write as _};
use std::path::{Path, PathBuf};

use crate::error::Error;
use crate::store::temporary_file;

/// Replaces a file: the new content is written to a temporary file, synchronized with the disk, then renamed.
///
/// A reader finds the old or the new content, even after a crash or on a full disk. A link is replaced and not followed.
pub(crate) fn replace(path: &Path, bytes: &[u8]) -> Result<(), Error> {
    replace_and_keep(path, bytes).map(drop)
}

/// Replaces a file and keeps it open at its end.
pub(crate) fn replace_and_keep(path: &Path, bytes: &[u8]) -> Result<File, Error> {
    let written = temporary_file::file(path).and_then(|mut draft| {
        draft.as_file_mut().write_all(bytes)?;
        draft.as_file().sync_all()?;
        let file = draft.persist(path).map_err(|error| error.error)?;
        // The file has its final name, so the lock is released. File systems without locks have none to release.
        let _ = file.unlock();
        Ok(file)
    });
    let file = written.map_err(Error::io("write", path))?;
    sync_directory(temporary_file::parent(path))?;
    Ok(file)
}

/// Synchronizes a rename with the disk, where directories can be opened.
pub(crate) fn sync_directory(path: &Path) -> Result<(), Error> {
    if cfg!(unix) {
        File::open(path).and_then(|directory| directory.sync_all()).map_err(Error::io("write", path))?;
    }
    Ok(())
}

/// Refuses the name of an existing file for a result, before the result takes time to compute. The name is checked again when the
/// result is written.
///
/// # Errors
/// [`Error::Usage`].
pub(crate) fn refuse_existing(path: &Path) -> Result<(), Error> {
    refuse_lost(path)?;
    if fs::metadata(path).is_ok_and(|metadata| metadata.is_file() || metadata.is_dir()) {
        return Err(Error::Usage(format!("{}: there is one already", path.display())));
    }
    Ok(())
}

/// Refuses the name of a result in a folder that does not exist.
///
/// # Errors
/// [`Error::Usage`].
pub(crate) fn refuse_lost(path: &Path) -> Result<(), Error> {
    let folder = temporary_file::parent(path);
    if folder.is_dir() {
        return Ok(());
    }
    Err(Error::Usage(format!("{}: there is no folder {}", path.display(), folder.display())))
}

/// Opens a file for a result: a new file, or an existing pipe or device.
///
/// # Errors
/// [`Error::Usage`] for an existing file and without its folder, and [`Error::Io`].
pub(crate) fn create_result(path: &Path) -> Result<File, Error> {
    refuse_lost(path)?;
    match OpenOptions::new().write(true).create_new(true).open(path) {
        Err(error) if error.kind() == io::ErrorKind::AlreadyExists => {
            refuse_existing(path)?;
            OpenOptions::new().write(true).open(path).map_err(Error::io("write", path))
        }
        opened => opened.map_err(Error::io("write", path)),
    }
}

/// Writes results to new files, all of them or none. A file has its final name only when it is complete.
///
/// # Errors
/// As [`create_result`]. No file is left then.
pub(crate) fn create_results(results: &[(PathBuf, impl AsRef<[u8]>)]) -> Result<(), Error> {
    let mut made: Vec<&Path> = Vec::new();
    let written = results.iter().try_for_each(|(path, content)| {
        let content = content.as_ref();
        refuse_lost(path)?;
        if fs::symlink_metadata(path).is_ok() {
            // A pipe, a device, or an existing file.
            return create_result(path)?.write_all(content).map_err(Error::io("write", path));
        }
        temporary_file::sweep_of(path);
        let whole = temporary_file::file(path).and_then(|mut draft| {
            draft.as_file_mut().write_all(content)?;
            draft.as_file().sync_all()?;
            Ok(draft)
        });
        let whole = whole.map_err(Error::io("write", path))?;
        whole.persist_noclobber(path).map_err(|error| match error.error.kind() {
            io::ErrorKind::AlreadyExists => Error::Usage(format!("{}: there is one already", path.display())),
            _ => Error::io("write", path)(error.error),
        })?;
        made.push(path);
        sync_directory(temporary_file::parent(path))
    });
    if written.is_err() {
        for path in made {
            // The first error is more important than a file that cannot be removed.
            let _ = fs::remove_file(path);
        }
    }
    written
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_cannot_be_written_leaves_the_old_content() {
        let folder = tempfile::tempdir().unwrap();
        let root = folder.path();
        let path = root.join("file");
        replace(&path, b"old").unwrap();
        replace(&path, b"new").unwrap();
        assert_eq!(fs::read_dir(root).unwrap().count(), 1);
        // A directory instead of the file.
        fs::create_dir(root.join("folder")).unwrap();
        let error = replace(&root.join("folder"), b"newer").unwrap_err();
        assert!(error.to_string().starts_with("cannot write "), "{error}");
        assert_eq!(fs::read_dir(root).unwrap().count(), 2);
        assert_eq!(fs::read(&path).unwrap(), b"new");
        assert!(create_result(&path).is_err() && create_result(root).is_err());
        assert!(refuse_existing(&path).is_err() && refuse_existing(&root.join("other")).is_ok());
        let results = ["first", "file", "last"].map(|name| (root.join(name), name.to_owned()));
        assert!(create_results(&results).is_err());
        assert!(!root.join("first").exists() && !root.join("last").exists());
        assert_eq!(fs::read(&path).unwrap(), b"new");
        create_results(&[results[0].clone(), results[2].clone()]).unwrap();
        assert_eq!(fs::read(root.join("last")).unwrap(), b"last");
        assert_eq!(fs::read_dir(root).unwrap().count(), 4);
    }

    #[cfg(unix)]
    #[test]
    fn links_named_like_files_are_not_followed() {
        let folder = tempfile::tempdir().unwrap();
        let root = folder.path();
        let victim = root.join("victim");
        fs::write(&victim, "precious").unwrap();
        for name in ["test.csv", ".test.csv.new", "none"] {
            std::os::unix::fs::symlink(&victim, root.join(name)).unwrap();
        }
        replace(&root.join("test.csv"), b"ours").unwrap();
        assert_eq!(fs::read(root.join("test.csv")).unwrap(), b"ours");
        assert!(create_results(&[(root.join("none"), "ours")]).is_err());
        assert_eq!(fs::read(&victim).unwrap(), b"precious");
    }

    #[cfg(unix)]
    #[test]
    fn files_have_the_mode_that_others_have() {
        use std::os::unix::fs::PermissionsExt as _;
        let folder = tempfile::tempdir().unwrap();
        let (plain, ours) = (folder.path().join("plain"), folder.path().join("ours"));
        fs::write(&plain, "x").unwrap();
        replace(&ours, b"x").unwrap();
        let mode = |path: &Path| fs::metadata(path).unwrap().permissions().mode();
        assert_eq!(mode(&ours), mode(&plain));
    }
}
