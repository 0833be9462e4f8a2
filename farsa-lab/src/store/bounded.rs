//! Files read with a bound on their bytes and on the time waited for them.
//!
//! A user may name a pipe or a device ([`read_stream`]); a run directory may be a stranger's, and holds only regular files
//! ([`read_regular`]).

use std::fs::{File, Metadata, OpenOptions};
use std::io::{self, ErrorKind, Read};
use std::path::Path;
use std::thread;
use std::time::Duration;

use crate::error::Error;

/// How long a pipe may give nothing.
const PATIENCE: Duration = Duration::from_secs(10);
/// Between two looks into a pipe that gives nothing.
const PAUSE: Duration = Duration::from_millis(10);
/// Bytes read at once.
const CHUNK: usize = 1 << 16;

/// The bytes of a file that a user names: a regular file, a pipe or a device, which has to end within the limit [bytes].
///
/// # Errors
/// [`Error::Io`]; [`Error::Damaged`] for more bytes than the limit, and for a pipe that gives nothing for ten seconds.
pub(crate) fn read_stream(path: &Path, limit: u64) -> Result<Vec<u8>, Error> {
    read_within(path, limit, PATIENCE)
}

/// The same as text.
///
/// # Errors
/// As [`read_stream`], and [`Error::Damaged`] with the line of the first byte that is not UTF-8.
pub(crate) fn read_stream_text(path: &Path, limit: u64) -> Result<String, Error> {
    text(path, read_stream(path, limit)?)
}

/// The bytes of a file of a run directory, which has to be a regular one, or a link to one.
///
/// # Errors
/// [`Error::Io`]; [`Error::Damaged`] for more bytes than the limit, and for a pipe, a device or a directory.
pub(crate) fn read_regular(path: &Path, limit: u64) -> Result<Vec<u8>, Error> {
    let regular = |found: Metadata| {
        if found.is_file() { Ok(found) } else { Err(Error::damaged(path, "is not a regular file")) }
    };
    // Asked twice: opening a device may do something, and what is opened may no longer be what was asked about.
    regular(path.metadata().map_err(Error::io("read", path))?)?;
    let mut file = open(path).map_err(Error::io("read", path))?;
    let size = regular(file.metadata().map_err(Error::io("read", path))?)?.len();
    bytes(&mut file, path, Bounds { size, limit, patience: Duration::ZERO, writer: true })
}

/// The same of a file that a run can do without: nothing where there is no file, or another thing in its place.
///
/// # Errors
/// [`Error::Io`] for a regular file that cannot be read: what it holds may still be wanted.
pub(crate) fn read_regular_if_present(path: &Path, limit: u64) -> Result<Option<Vec<u8>>, Error> {
    match read_regular(path, limit) {
        Err(error @ Error::Io { .. }) if path.symlink_metadata().is_ok_and(|found| found.is_file()) => Err(error),
        read => Ok(read.ok()),
    }
}

/// The same as text.
///
/// # Errors
/// As [`read_regular`], and [`Error::Damaged`] with the line of the first byte that is not UTF-8.
pub(crate) fn read_regular_text(path: &Path, limit: u64) -> Result<String, Error> {
    text(path, read_regular(path, limit)?)
}

/// The text of a file that a setting names, of at most `limit` bytes: for [`Experiment::prepare`](crate::Experiment::prepare).
///
/// It has to be a regular file, or a link to one: it is read for each thread, and by each command on the run.
///
/// # Errors
/// [`Error::Io`]; [`Error::Damaged`] for more bytes than the limit, for a pipe, a device or a directory, and with the line of
/// the first byte that is not UTF-8.
pub fn read_text_file(path: &Path, limit: u64) -> Result<String, Error> {
    read_regular_text(path, limit)
}

fn read_within(path: &Path, limit: u64, patience: Duration) -> Result<Vec<u8>, Error> {
    let mut file = open(path).map_err(Error::io("read", path))?;
    let found = file.metadata().map_err(Error::io("read", path))?;
    if found.is_dir() {
        return Err(Error::io("read", path)(io::Error::new(ErrorKind::IsADirectory, "it is a directory")));
    }
    let size = if found.is_file() { found.len() } else { 0 };
    bytes(&mut file, path, Bounds { size, limit, patience, writer: !is_pipe(&found) })
}

/// Opens for reading; what has nothing to give says so, at once.
fn open(path: &Path) -> io::Result<File> {
    let mut options = OpenOptions::new();
    options.read(true);
    #[cfg(unix)]
    std::os::unix::fs::OpenOptionsExt::custom_flags(&mut options, libc::O_NONBLOCK);
    options.open(path)
}

#[cfg(unix)]
fn is_pipe(found: &Metadata) -> bool {
    std::os::unix::fs::FileTypeExt::is_fifo(&found.file_type())
}

#[cfg(not(unix))]
fn is_pipe(_: &Metadata) -> bool {
    false
}

/// How much is read, and how long that may take.
#[derive(Clone, Copy)]
struct Bounds {
    /// Bytes that a regular file says it has.
    size: u64,
    /// The most bytes.
    limit: u64,
    /// How long nothing may come.
    patience: Duration,
    /// Whether no byte means the end; a pipe that nobody has opened for writing yet gives none either.
    writer: bool,
}

fn bytes(source: &mut impl Read, path: &Path, bounds: Bounds) -> Result<Vec<u8>, Error> {
    let Bounds { size, limit, patience, mut writer } = bounds;
    let too_large = || Error::damaged(path, format!("has more than {limit} bytes, the most that is read of it"));
    if size > limit {
        return Err(too_large());
    }
    let mut all = Vec::new();
    let mut chunk = vec![0; CHUNK];
    let mut waited = Duration::ZERO;
    loop {
        match source.read(&mut chunk) {
            Ok(0) if writer => return Ok(all),
            Ok(0) => {}
            Ok(count) => {
                all.extend_from_slice(chunk.get(..count).unwrap_or_default());
                if all.len() as u64 > limit {
                    return Err(too_large());
                }
                (writer, waited) = (true, Duration::ZERO);
                continue;
            }
            Err(error) if error.kind() == ErrorKind::Interrupted => continue,
            Err(error) if error.kind() == ErrorKind::WouldBlock => writer = true,
            Err(error) => return Err(Error::io("read", path)(error)),
        }
        if waited >= patience {
            let count = all.len();
            let more = if count == 0 { "nothing".to_owned() } else { format!("{count} bytes, then nothing") };
            return Err(Error::damaged(path, format!("gave {more} for {} s", patience.as_secs_f64())));
        }
        thread::sleep(PAUSE);
        waited += PAUSE;
    }
}

fn text(path: &Path, bytes: Vec<u8>) -> Result<String, Error> {
    String::from_utf8(bytes).map_err(|error| {
        let at = error.utf8_error().valid_up_to();
        let (before, after) = error.as_bytes().split_at_checked(at).unwrap_or_default();
        let line = before.split(|&byte| byte == b'\n').count();
        let byte = after.first().copied().unwrap_or_default();
        Error::damaged(path, format!("line {line}: the byte 0x{byte:02x} is no text (UTF-8)"))
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::collections::VecDeque;
    use std::fs;
    use std::path::PathBuf;

    /// An empty directory of a test, removed when it goes.
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
    fn what_cannot_be_read_is_not_taken_for_lost() {
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
        let path = place.file("a", &vec![7; 3 * CHUNK]);
        for read in [read_stream, read_regular] {
            assert_eq!(read(&path, 3 * CHUNK as u64).unwrap(), vec![7; 3 * CHUNK]);
            let said = read(&path, 3 * CHUNK as u64 - 1).unwrap_err().to_string();
            assert_eq!(said, format!("{}: has more than 196607 bytes, the most that is read of it", path.display()));
            // A hole that no memory could hold.
            fs::File::create(place.0.join("hole")).unwrap().set_len(1 << 42).unwrap();
            let said = read(&place.0.join("hole"), 1 << 30).unwrap_err().to_string();
            assert!(said.ends_with("hole: has more than 1073741824 bytes, the most that is read of it"), "{said}");
            assert!(matches!(read(&place.0.join("none"), 1), Err(Error::Io { .. })));
        }
        let said = read_stream(&place.0, 9).unwrap_err().to_string();
        assert_eq!(said, format!("cannot read {}: it is a directory", place.0.display()));
        assert!(read_regular(&place.0, 9).unwrap_err().to_string().ends_with(": is not a regular file"));
    }

    #[test]
    fn what_is_no_text_has_a_line() {
        let place = Place::new("text");
        let path = place.file("a", "é\n\nb\u{ff}".as_bytes());
        assert_eq!(
            (read_stream_text(&path, 99).unwrap(), read_regular_text(&path, 99).unwrap()),
            ("é\n\nbÿ".into(), "é\n\nbÿ".into())
        );
        let path = place.file("b", b"a = 1\nb = \xff\nc = \xfe");
        for read in [read_stream_text, read_regular_text] {
            let said = read(&path, 99).unwrap_err().to_string();
            assert_eq!(said, format!("{}: line 2: the byte 0xff is no text (UTF-8)", path.display()));
        }
    }

    #[cfg(unix)]
    #[test]
    fn devices_end_or_are_cut_off() {
        let (zero, null) = (Path::new("/dev/zero"), Path::new("/dev/null"));
        let said = read_stream(zero, 100_000).unwrap_err().to_string();
        assert_eq!(said, "/dev/zero: has more than 100000 bytes, the most that is read of it");
        assert_eq!(read_stream(null, 0).unwrap(), b"");
        for device in [zero, null] {
            assert!(read_regular(device, 9).unwrap_err().to_string().ends_with(": is not a regular file"));
        }
    }

    #[cfg(unix)]
    #[test]
    fn a_pipe_is_waited_for_but_not_for_ever() {
        use std::io::Write as _;
        let place = Place::new("pipe");
        let path = place.pipe();
        let said = read_within(&path, 9, 2 * PAUSE).unwrap_err().to_string();
        assert_eq!(said, format!("{}: gave nothing for 0.02 s", path.display()));
        assert!(read_regular(&path, 9).unwrap_err().to_string().ends_with(": is not a regular file"));

        let late = |content: &'static [u8]| {
            let path = path.clone();
            thread::spawn(move || {
                thread::sleep(5 * PAUSE);
                let mut pipe = OpenOptions::new().write(true).open(path).unwrap();
                pipe.write_all(content).unwrap();
            })
        };
        let writer = late(b"a = 1\n");
        assert_eq!(read_stream(&path, 9).unwrap(), b"a = 1\n");
        writer.join().unwrap();
        let writer = late(b"0123456789");
        assert!(read_stream(&path, 9).unwrap_err().to_string().contains("more than 9 bytes"));
        writer.join().unwrap();

        let link = place.0.join("link");
        std::os::unix::fs::symlink(place.file("a", b"here"), &link).unwrap();
        assert_eq!((read_stream(&link, 9).unwrap(), read_regular(&link, 9).unwrap()), (b"here".into(), b"here".into()));
    }

    /// A source that gives these, and then nothing for ever.
    struct Script(VecDeque<io::Result<&'static [u8]>>);

    impl Read for Script {
        fn read(&mut self, to: &mut [u8]) -> io::Result<usize> {
            let given = self.0.pop_front().unwrap_or_else(|| Err(ErrorKind::WouldBlock.into()))?;
            to[..given.len()].copy_from_slice(given);
            Ok(given.len())
        }
    }

    #[test]
    fn a_source_ends_only_after_it_began() {
        let read = |script: Vec<io::Result<&'static [u8]>>, writer: bool| {
            let bounds = Bounds { size: 0, limit: 9, patience: 3 * PAUSE, writer };
            bytes(&mut Script(script.into()), Path::new("p"), bounds).map_err(|error| error.to_string())
        };
        let wait = |kind: ErrorKind| Err(io::Error::from(kind));
        let (none, some): (&[u8], &[u8]) = (b"", b"ab");
        let late = vec![Ok(none), Ok(none), wait(ErrorKind::WouldBlock), Ok(some), wait(ErrorKind::Interrupted)];
        let whole = late.into_iter().chain([wait(ErrorKind::WouldBlock), Ok(some), Ok(none)]).collect();
        assert_eq!(read(whole, false), Ok(b"abab".into()));
        // A writer that came and went without a word, and what is no pipe.
        assert_eq!(read(vec![Ok(none), wait(ErrorKind::WouldBlock), Ok(none)], false), Ok(Vec::new()));
        assert_eq!(read(vec![Ok(none)], true), Ok(Vec::new()));
        assert_eq!(read((0..9).map(|_| Ok(none)).collect(), false), Err("p: gave nothing for 0.03 s".into()));
        assert_eq!(read(vec![Ok(some)], false), Err("p: gave 2 bytes, then nothing for 0.03 s".into()));
        assert_eq!(read(vec![wait(ErrorKind::BrokenPipe)], false), Err("cannot read p: broken pipe".into()));
    }
}
