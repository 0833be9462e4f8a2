//! Reads with a limit on the number of bytes.
//!
//! A file named by the user may be a pipe or a device ([`read_stream`]). A run directory may come from an untrusted source. Only
//! regular files are read from it ([`read_regular`]).

use std::fs::{File, Metadata, OpenOptions};
use std::io::{self, ErrorKind, Read as _};
use std::path::Path;

use crate::error::Error;

/// Reads a file named by the user: a regular file, a pipe or a device. It has to end within the limit [bytes].
///
/// # Errors
/// [`Error::Usage`].
pub(crate) fn read_stream(path: &Path, limit: u64) -> Result<Vec<u8>, Error> {
    let read = || {
        let file = File::open(path).map_err(Error::io("read", path))?;
        let metadata = file.metadata().map_err(Error::io("read", path))?;
        if metadata.is_dir() {
            return Err(Error::io("read", path)(io::Error::new(ErrorKind::IsADirectory, "it is a directory")));
        }
        let size = if metadata.is_file() { metadata.len() } else { 0 };
        read_limited(file, path, size, limit)
    };
    read().map_err(Error::into_usage)
}

/// Reads a file named by the user as text.
///
/// # Errors
/// [`Error::Usage`], with the line of the first byte that is not UTF-8.
pub(crate) fn read_stream_text(path: &Path, limit: u64) -> Result<String, Error> {
    to_text(path, read_stream(path, limit)?).map_err(Error::into_usage)
}

/// Reads a file of a run directory, which has to be a regular file or a link to one.
///
/// # Errors
/// [`Error::Io`], and [`Error::File`] above the limit or for a pipe, a device or a directory.
pub(crate) fn read_regular(path: &Path, limit: u64) -> Result<Vec<u8>, Error> {
    let (file, size) = open_regular(path)?;
    read_limited(file, path, size, limit)
}

/// Reads at most `length` bytes of a regular file from a byte on. The result is shorter at the end of the file.
///
/// # Errors
/// [`Error::Io`], and [`Error::File`] for a pipe, a device or a directory.
#[cfg(feature = "command")]
pub(crate) fn read_regular_part(path: &Path, start: u64, length: u64) -> Result<Vec<u8>, Error> {
    use std::io::{Seek as _, SeekFrom};
    let (mut file, _) = open_regular(path)?;
    let mut bytes = Vec::new();
    let read = file.seek(SeekFrom::Start(start)).and_then(|_| file.take(length).read_to_end(&mut bytes));
    read.map_err(Error::io("read", path))?;
    Ok(bytes)
}

/// Opens a regular file, and returns its size.
fn open_regular(path: &Path) -> Result<(File, u64), Error> {
    let regular = |metadata: Metadata| {
        if metadata.is_file() { Ok(metadata) } else { Err(Error::damaged(path, "is not a regular file")) }
    };
    // Checked twice: opening a device may have an effect, and the file may be replaced between the two.
    regular(path.metadata().map_err(Error::io("read", path))?)?;
    let file = open_without_waiting(path).map_err(Error::io("read", path))?;
    let size = regular(file.metadata().map_err(Error::io("read", path))?)?.len();
    Ok((file, size))
}

/// Reads an optional file of a run. The result is `None` where there is no file, or something that is not a regular file.
///
/// # Errors
/// [`Error::Io`] for a regular file that cannot be read, because its content may still be needed.
pub(crate) fn read_regular_if_present(path: &Path, limit: u64) -> Result<Option<Vec<u8>>, Error> {
    match read_regular(path, limit) {
        Err(error @ Error::Io { .. }) if path.symlink_metadata().is_ok_and(|metadata| metadata.is_file()) => Err(error),
        result => Ok(result.ok()),
    }
}

/// Reads a file of a run directory as text.
///
/// # Errors
/// As [`read_regular`], and [`Error::File`] with the line of the first byte that is not UTF-8.
pub(crate) fn read_regular_text(path: &Path, limit: u64) -> Result<String, Error> {
    to_text(path, read_regular(path, limit)?)
}

/// Reads the text of a file that is named by a setting, for example in
/// [`Experiment::prepare`](crate::Experiment::prepare). It can have at most `limit` bytes.
///
/// Since each thread and each command on the run reads it again, the path must refer to a regular file, or be a link
/// to one.
///
/// # Errors
/// Returns [`Error::Io`] if reading fails. You get [`Error::File`] if the file is too large, or if it is a pipe, a
/// device or a directory. If it is not valid UTF-8, the error names the line of the first invalid byte.
pub fn read_text_file(path: &Path, limit: u64) -> Result<String, Error> {
    read_regular_text(path, limit)
}

/// Opens a file for reading. The call returns at once, even for a pipe without a writer.
fn open_without_waiting(path: &Path) -> io::Result<File> {
    let mut options = OpenOptions::new();
    options.read(true);
    #[cfg(unix)]
    std::os::unix::fs::OpenOptionsExt::custom_flags(&mut options, rustix::fs::OFlags::NONBLOCK.bits().cast_signed());
    options.open(path)
}

/// Reads a file of a given size [bytes], or a stream with size 0.
fn read_limited(file: File, path: &Path, size: u64, limit: u64) -> Result<Vec<u8>, Error> {
    let mut bytes = Vec::new();
    if size <= limit {
        file.take(limit.saturating_add(1)).read_to_end(&mut bytes).map_err(Error::io("read", path))?;
    }
    if size.max(bytes.len() as u64) > limit {
        return Err(Error::damaged(path, format!("has more than {limit} bytes, the most that is read of it")));
    }
    Ok(bytes)
}

fn to_text(path: &Path, bytes: Vec<u8>) -> Result<String, Error> {
    String::from_utf8(bytes).map_err(|error| {
        let end = error.utf8_error().valid_up_to();
        let (valid, rest) = error.as_bytes().split_at_checked(end).unwrap_or_default();
        let line = valid.split(|&byte| byte == b'\n').count();
        let byte = rest.first().copied().unwrap_or_default();
        Error::damaged(path, format!("line {line}: the byte 0x{byte:02x} is no text (UTF-8)"))
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::fs;
    use std::path::PathBuf;
    use std::thread;

    /// A temporary directory of a test.
    struct Place(PathBuf);

    impl Place {
        fn new(name: &str) -> Self {
            let path = std::env::temp_dir().join(format!("farsa bounded {name} {}", std::process::id()));
            let _ = fs::remove_dir_all(&path);
            fs::create_dir_all(&path).unwrap();
            Self(path)
        }

        fn file(&self, name: &str, content: &[u8]) -> PathBuf {
            let path = self.0.join(name);
            fs::write(&path, content).unwrap();
            path
        }

        #[cfg(unix)]
        fn pipe(&self) -> PathBuf {
            let path = self.0.join("pipe");
            assert!(std::process::Command::new("mkfifo").arg(&path).status().unwrap().success());
            path
        }
    }

    impl Drop for Place {
        fn drop(&mut self) {
            let _ = fs::remove_dir_all(&self.0);
        }
    }

    #[test]
    fn an_unreadable_file_is_not_a_missing_one() {
        let place = Place::new("any");
        let file = place.file("some", b"abc");
        assert_eq!(read_regular_if_present(&file, 3).unwrap(), Some(b"abc".into()));
        assert_eq!(read_regular_if_present(&place.0.join("none"), 3).unwrap(), None);
        assert_eq!(read_regular_if_present(&place.0, 3).unwrap(), None);
        // A regular file by its kind, whose first byte nothing can read.
        if cfg!(target_os = "linux") {
            let unread = read_regular_if_present(Path::new("/proc/self/mem"), 3).unwrap_err();
            assert!(unread.to_string().starts_with("cannot read "), "{unread}");
        }
    }

    #[test]
    fn a_file_is_read_up_to_the_limit() {
        let place = Place::new("limit");
        let path = place.file("a", &vec![7; 196_608]);
        for (read, code) in [(read_stream as fn(&Path, u64) -> Result<Vec<u8>, Error>, 2), (read_regular, 1)] {
            assert_eq!(read(&path, 196_608).unwrap(), vec![7; 196_608]);
            let message = read(&path, 196_607).unwrap_err().to_string();
            assert_eq!(message, format!("{}: has more than 196607 bytes, the most that is read of it", path.display()));
            // A hole that no memory could hold.
            fs::File::create(place.0.join("hole")).unwrap().set_len(1 << 42).unwrap();
            let message = read(&place.0.join("hole"), 1 << 30).unwrap_err().to_string();
            assert!(
                message.ends_with("hole: has more than 1073741824 bytes, the most that is read of it"),
                "{message}"
            );
            let missing = read(&place.0.join("none"), 1).unwrap_err();
            assert!(missing.to_string().starts_with("cannot read ") && missing.exit_code() == code, "{missing}");
        }
        let message = read_stream(&place.0, 9).unwrap_err().to_string();
        assert_eq!(message, format!("cannot read {}: it is a directory", place.0.display()));
        assert!(read_regular(&place.0, 9).unwrap_err().to_string().ends_with(": is not a regular file"));
    }

    #[test]
    fn invalid_text_is_reported_with_its_line() {
        let place = Place::new("text");
        let path = place.file("a", "é\n\nb\u{ff}".as_bytes());
        assert_eq!(
            (read_stream_text(&path, 99).unwrap(), read_regular_text(&path, 99).unwrap()),
            ("é\n\nbÿ".into(), "é\n\nbÿ".into())
        );
        let path = place.file("b", b"a = 1\nb = \xff\nc = \xfe");
        for read in [read_stream_text, read_regular_text] {
            let message = read(&path, 99).unwrap_err().to_string();
            assert_eq!(message, format!("{}: line 2: the byte 0xff is no text (UTF-8)", path.display()));
        }
    }

    #[cfg(unix)]
    #[test]
    fn devices_end_or_are_cut_off() {
        let (zero, null) = (Path::new("/dev/zero"), Path::new("/dev/null"));
        let message = read_stream(zero, 100_000).unwrap_err().to_string();
        assert_eq!(message, "/dev/zero: has more than 100000 bytes, the most that is read of it");
        assert_eq!(read_stream(null, 0).unwrap(), b"");
        for device in [zero, null] {
            assert!(read_regular(device, 9).unwrap_err().to_string().ends_with(": is not a regular file"));
        }
    }

    #[cfg(unix)]
    #[test]
    fn pipes_are_streams_and_no_regular_files() {
        let place = Place::new("pipe");
        let path = place.pipe();
        assert!(read_regular(&path, 9).unwrap_err().to_string().ends_with(": is not a regular file"));
        let write = |content: &'static [u8]| {
            let path = path.clone();
            thread::spawn(move || fs::write(path, content).unwrap())
        };
        let writer = write(b"a = 1\n");
        assert_eq!(read_stream(&path, 9).unwrap(), b"a = 1\n");
        writer.join().unwrap();
        let writer = write(b"0123456789");
        assert!(read_stream(&path, 9).unwrap_err().to_string().contains("more than 9 bytes"));
        writer.join().unwrap();

        let link = place.0.join("link");
        std::os::unix::fs::symlink(place.file("a", b"here"), &link).unwrap();
        assert_eq!((read_stream(&link, 9).unwrap(), read_regular(&link, 9).unwrap()), (b"here".into(), b"here".into()));
    }
}
