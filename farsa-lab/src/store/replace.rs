//! How files are written without ever being half written.

use std::fs::{self, File, OpenOptions};
use std::io::{self, Read as _, Write as _};
use std::path::{Path, PathBuf};

use farsa_view::Page;

use crate::error::Error;
use crate::store::temporary_file;

/// Puts new content in place of a file's: written beside it, brought to the disk, then renamed.
///
/// A reader, a crash or a full disk meets the old content or the new one, never a part. A link is replaced, not followed.
pub(crate) fn replace(path: &Path, bytes: &[u8]) -> Result<(), Error> {
    replace_and_keep(path, bytes).map(drop)
}

/// The same, and keeps the file open at its end.
pub(crate) fn replace_and_keep(path: &Path, bytes: &[u8]) -> Result<File, Error> {
    let written = temporary_file::file(path).and_then(|mut draft| {
        draft.as_file_mut().write_all(bytes)?;
        draft.as_file().sync_all()?;
        let file = draft.persist(path).map_err(|error| error.error)?;
        // It has its name, and is no draft any more. Where there are no locks there is nothing to release.
        let _ = file.unlock();
        Ok(file)
    });
    let file = written.map_err(Error::io("write", path))?;
    sync_directory(temporary_file::parent(path))?;
    Ok(file)
}

/// Brings a rename to the disk, where directories can be opened at all.
pub(crate) fn sync_directory(path: &Path) -> Result<(), Error> {
    if cfg!(unix) {
        File::open(path).and_then(|directory| directory.sync_all()).map_err(Error::io("write", path))?;
    }
    Ok(())
}

/// Refuses a name for a result under which there is a file, before what goes into it takes time; it is looked at again when the
/// result is written.
///
/// # Errors
/// [`Error::Usage`].
pub(crate) fn refuse_existing(path: &Path) -> Result<(), Error> {
    if fs::metadata(path).is_ok_and(|metadata| metadata.is_file() || metadata.is_dir()) {
        return Err(Error::Usage(format!("{}: there is one already", path.display())));
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
            refuse_existing(path)?;
            OpenOptions::new().write(true).open(path).map_err(Error::io("write", path))
        }
        opened => opened.map_err(Error::io("write", path)),
    }
}

/// Writes results to new files, all of them or none; a file has its name only once it is whole.
///
/// # Errors
/// As [`create_result`]; no file is then left behind.
pub(crate) fn create_results(results: &[(PathBuf, impl AsRef<[u8]>)]) -> Result<(), Error> {
    let mut made: Vec<&Path> = Vec::new();
    let written = results.iter().try_for_each(|(path, content)| {
        let content = content.as_ref();
        if fs::symlink_metadata(path).is_ok() {
            // A pipe, a device, or something in the way.
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
            // Our own file; that it may stay is no reason to hide the first error.
            let _ = fs::remove_file(path);
        }
    }
    written
}

/// Writes a page: over an older page of ours, else to a new file.
///
/// # Errors
/// As [`create_results`].
pub(crate) fn write_page(path: &Path, html: &str) -> Result<(), Error> {
    if !is_page(path) {
        return create_results(&[(path.to_owned(), html)]);
    }
    temporary_file::sweep_of(path);
    replace(path, html.as_bytes())
}

/// Whether a file is a page that a command of ours has made.
fn is_page(path: &Path) -> bool {
    if !fs::symlink_metadata(path).is_ok_and(|metadata| metadata.is_file()) {
        return false;
    }
    let mut start = Vec::new();
    let read = File::open(path).and_then(|file| file.take(2000).read_to_end(&mut start));
    read.is_ok() && String::from_utf8_lossy(&start).contains(Page::MARK)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn pages_take_the_place_of_pages_alone() {
        let folder = tempfile::tempdir().unwrap();
        let path = |name: &str| folder.path().join(name);
        let page = |title: &str| Page::new(title).html();
        write_page(&path("page.html"), &page("first")).unwrap();
        write_page(&path("page.html"), &page("second")).unwrap();
        assert_eq!(fs::read_to_string(path("page.html")).unwrap(), page("second"));
        // What a process left that was killed meanwhile.
        fs::write(path(".page.html.0123456789ab.new"), "<p>").unwrap();
        write_page(&path("page.html"), &page("third")).unwrap();
        assert_eq!(fs::read_dir(folder.path()).unwrap().count(), 1);
        fs::write(path("notes.html"), "<p>mine</p>").unwrap();
        let error = write_page(&path("notes.html"), &page("third")).unwrap_err();
        assert!(error.to_string().ends_with("there is one already"), "{error}");
        assert!(write_page(folder.path(), &page("third")).is_err());
        assert_eq!(fs::read_to_string(path("notes.html")).unwrap(), "<p>mine</p>");
    }

    #[test]
    fn what_cannot_be_written_leaves_the_old_content() {
        let folder = tempfile::tempdir().unwrap();
        let root = folder.path();
        let path = root.join("file");
        replace(&path, b"old").unwrap();
        replace(&path, b"new").unwrap();
        assert_eq!(fs::read_dir(root).unwrap().count(), 1);
        // A directory in the place of the file.
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
