//! Append logs: files that grow at their end during a run.

use std::fs::{self, File};
use std::io::Write as _;
use std::path::{Path, PathBuf};

use farsa_num::Crc32;
use serde::{Deserialize, Serialize};

use crate::error::Error;
use crate::store::bounded::read_regular;
use crate::store::replace::{replace_and_keep, sync_directory};

/// Length and checksum of a file when a checkpoint was written.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize)]
pub(crate) struct Mark {
    bytes: u64,
    crc: u32,
}

impl Mark {
    /// Creates the mark of a file with this content.
    pub(crate) fn of(content: &[u8]) -> Self {
        Self { bytes: content.len() as u64, crc: Crc32::new().with(content).finish() }
    }

    /// Checks whether the file was empty or missing.
    pub(crate) fn is_empty(self) -> bool {
        self.bytes == 0
    }

    /// Finds the content up to this mark, or `None` if it was changed.
    pub(crate) fn within(self, content: &[u8]) -> Option<&[u8]> {
        let prefix = content.get(..usize::try_from(self.bytes).ok()?)?;
        (Self::of(prefix) == self).then_some(prefix)
    }
}

/// Reads a file of a run up to a mark, even while another process appends to it.
///
/// # Errors
/// [`Error::Io`], and [`Error::File`] for content that does not match the mark.
pub(crate) fn read(path: &Path, mark: Mark, limit: u64) -> Result<Vec<u8>, Error> {
    let mut content = read_regular(path, limit)?;
    let (found, expected) = (content.len() as u64, mark.bytes);
    if found < expected {
        return Err(Error::damaged(path, format!("truncated: {found} bytes of {expected}")));
    }
    let Some(prefix) = mark.within(&content).map(<[u8]>::len) else {
        return Err(Error::damaged(path, "altered: its checksum is not the one in the checkpoint"));
    };
    content.truncate(prefix);
    Ok(content)
}

/// A file to which this process appends.
pub(crate) struct AppendLog {
    path: PathBuf,
    file: File,
    bytes: u64,
    limit: u64,
    crc: Crc32,
}

impl AppendLog {
    /// Replaces a file by one with this content. The old file is never written to, since it may be a link.
    pub(crate) fn new(path: &Path, content: &[u8]) -> Result<Self, Error> {
        let file = replace_and_keep(path, content)?;
        let (bytes, crc) = (content.len() as u64, Crc32::new().with(content));
        Ok(Self { path: path.into(), file, bytes, limit: u64::MAX, crc })
    }

    /// Sets the largest number of bytes.
    pub(crate) fn with_limit(self, limit: u64) -> Self {
        Self { limit, ..self }
    }

    /// Checks that more bytes fit.
    ///
    /// # Errors
    /// [`Error::Other`].
    pub(crate) fn room_for(&self, more: usize) -> Result<(), Error> {
        let bytes = self.bytes.saturating_add(more as u64);
        if bytes > self.limit { Err(Error::too_large(&self.path, bytes, self.limit)) } else { Ok(()) }
    }

    /// Appends to the file.
    ///
    /// # Errors
    /// [`Error::Io`], and [`Error::Other`] above the limit. Nothing is appended then.
    pub(crate) fn append(&mut self, content: &[u8]) -> Result<(), Error> {
        self.room_for(content.len())?;
        self.file.write_all(content).map_err(Error::io("write", &self.path))?;
        self.bytes += content.len() as u64;
        self.crc = self.crc.with(content);
        Ok(())
    }

    /// Synchronizes the file with the disk and returns its mark.
    pub(crate) fn sync(&mut self) -> Result<Mark, Error> {
        self.file.sync_data().map_err(Error::io("write", &self.path))?;
        Ok(Mark { bytes: self.bytes, crc: self.crc.finish() })
    }

    /// Refuses a file that another program has removed, replaced, cut or extended.
    ///
    /// # Errors
    /// [`Error::File`].
    pub(crate) fn check(&self) -> Result<(), Error> {
        let changed = |what: &str| {
            let why = format!("was {what} during the run; `run --resume` continues from what was saved");
            Err(Error::damaged(&self.path, why))
        };
        let Ok(found) = fs::symlink_metadata(&self.path) else { return changed("removed") };
        #[cfg(unix)]
        {
            use std::os::unix::fs::MetadataExt as _;
            let opened = self.file.metadata().map_err(Error::io("read", &self.path))?;
            if (found.dev(), found.ino()) != (opened.dev(), opened.ino()) {
                return changed("replaced");
            }
        }
        if found.len() == self.bytes { Ok(()) } else { changed("changed by another program") }
    }

    /// Removes the file.
    pub(crate) fn remove(path: &Path) -> Result<(), Error> {
        match fs::remove_file(path) {
            Err(error) if error.kind() != std::io::ErrorKind::NotFound => Err(Error::io("remove", path)(error)),
            _ => sync_directory(crate::store::temporary_file::parent(path)),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_was_marked_is_read_whatever_follows() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("log");
        let mut log = AppendLog::new(&path, b"head\n").unwrap();
        let start = log.sync().unwrap();
        assert_eq!(start, Mark::of(b"head\n"));
        log.append(b"one\n").unwrap();
        let mark = log.sync().unwrap();
        log.append(b"to").unwrap();
        log.check().unwrap();
        assert_eq!(read(&path, mark, 100).unwrap(), b"head\none\n");
        assert_eq!(read(&path, start, 100).unwrap(), b"head\n");
        fs::write(&path, "head\n0ne\n").unwrap();
        assert!(read(&path, mark, 100).unwrap_err().to_string().contains("altered"));
        fs::write(&path, "head").unwrap();
        assert!(read(&path, mark, 100).unwrap_err().to_string().contains("truncated: 4 bytes of 9"));
    }

    #[test]
    fn a_file_grows_to_what_is_read_of_it() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("log");
        let mut log = AppendLog::new(&path, b"head\n").unwrap().with_limit(9);
        log.append(b"one\n").unwrap();
        let mark = log.sync().unwrap();
        assert!(log.room_for(0).is_ok() && log.room_for(1).is_err() && log.room_for(usize::MAX).is_err());
        let message = log.append(b"2").unwrap_err().to_string();
        assert_eq!(message, format!("{}: would have 10 bytes, more than the 9 that are read of it", path.display()));
        assert_eq!(log.sync().unwrap(), mark);
        assert_eq!(read(&path, mark, 9).unwrap(), b"head\none\n");
    }

    #[test]
    fn a_file_that_somebody_touched_is_noticed() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("log");
        let message = |change: &dyn Fn()| {
            let mut log = AppendLog::new(&path, b"head\n").unwrap();
            log.append(b"one\n").unwrap();
            log.check().unwrap();
            change();
            log.check().unwrap_err().to_string()
        };
        assert!(message(&|| fs::remove_file(&path).unwrap()).contains("was removed during"));
        assert!(message(&|| fs::write(&path, "").unwrap()).contains("was changed by another program"));
        let replaced = message(&|| {
            fs::copy(&path, folder.path().join("copy")).unwrap();
            fs::rename(folder.path().join("copy"), &path).unwrap();
        });
        assert!(replaced.contains("was replaced during") || !cfg!(unix), "{replaced}");
    }

    #[cfg(unix)]
    #[test]
    fn a_link_in_the_place_of_a_file_is_replaced_and_not_followed() {
        let folder = tempfile::tempdir().unwrap();
        let (path, victim) = (folder.path().join("log"), folder.path().join("victim"));
        fs::write(&victim, "precious").unwrap();
        std::os::unix::fs::symlink(&victim, &path).unwrap();
        AppendLog::new(&path, b"head\n").unwrap().append(b"one\n").unwrap();
        assert_eq!(fs::read(&victim).unwrap(), b"precious");
        assert_eq!(fs::read(&path).unwrap(), b"head\none\n");
    }
}
