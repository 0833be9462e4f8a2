//! Files that a model names: found within its folders only, regular, and read no further than allowed.

use std::fs::{File, FileType};
use std::io::Read as _;
use std::path::{Component, Path, PathBuf};

use crate::error::{ReadError, SourceLocation};
use crate::options::ReadOptions;

/// Reads files for a model.
pub(crate) struct ModelFiles {
    /// Where relative paths begin, and the folder that they must stay in. Both without links.
    start: Option<PathBuf>,
    root: Option<PathBuf>,
    packages: Vec<PathBuf>,
    most_bytes: usize,
    most_files: usize,
    opened: usize,
    most_read: usize,
    read: usize,
}

fn real(path: &Path) -> Result<PathBuf, ReadError> {
    // The folder of a bare file name is the current one.
    let path = if path.as_os_str().is_empty() { Path::new(".") } else { path };
    path.canonicalize().map_err(|error| fault(path, &error))
}

impl ModelFiles {
    pub(crate) fn new(folder: Option<&Path>, options: &ReadOptions) -> Result<Self, ReadError> {
        let start = folder.or(options.root.as_deref()).map(real).transpose()?;
        let root = options.root.as_deref().map(real).transpose()?.or_else(|| start.clone());
        Ok(Self {
            start,
            root,
            packages: options.packages.iter().map(|path| real(path)).collect::<Result<_, _>>()?,
            most_bytes: options.limits.bytes,
            most_files: options.limits.files,
            opened: 0,
            most_read: options.limits.all_bytes,
            read: 0,
        })
    }

    /// Reads the text of the model itself, wherever it is. From a pipe as well, as the caller names it and not a file.
    pub(crate) fn model(&mut self, path: &Path) -> Result<String, ReadError> {
        let place = SourceLocation { file: path.display().to_string(), line: 1 };
        let kind = path.metadata().map_err(|error| fault(path, &error))?.file_type();
        match other_kind(kind) {
            None | Some(PIPE) => text(path, self.bytes(path, &place)?),
            Some(why) => Err(fault(path, &why)),
        }
    }

    /// Reads the text of a file that the model names.
    pub(crate) fn text(&mut self, place: &SourceLocation, name: &str) -> Result<(PathBuf, String), ReadError> {
        let path = self.find(place, name)?;
        let read = text(&path, self.bytes(&path, place)?)?;
        Ok((path, read))
    }

    /// Reads the content of a file that the model names.
    pub(crate) fn content(&mut self, place: &SourceLocation, name: &str) -> Result<Vec<u8>, ReadError> {
        let path = self.find(place, name)?;
        self.bytes(&path, place)
    }

    fn bytes(&mut self, path: &Path, place: &SourceLocation) -> Result<Vec<u8>, ReadError> {
        self.opened += 1;
        if self.opened > self.most_files {
            return Err(ReadError::TooMuch { place: place.clone(), what: "files", limit: self.most_files });
        }
        let mut bytes = Vec::new();
        let most = u64::try_from(self.most_bytes).unwrap_or(u64::MAX);
        let read = File::open(path).and_then(|file| file.take(most.saturating_add(1)).read_to_end(&mut bytes));
        read.map_err(|error| fault(path, &error))?;
        if bytes.len() > self.most_bytes {
            return Err(ReadError::TooMuch { place: place.clone(), what: "bytes in a file", limit: self.most_bytes });
        }
        self.read = self.read.saturating_add(bytes.len());
        if self.read > self.most_read {
            return Err(ReadError::TooMuch { place: place.clone(), what: "bytes in all files", limit: self.most_read });
        }
        Ok(bytes)
    }

    /// Where a file that the model names is, if it may be read.
    fn find(&self, place: &SourceLocation, name: &str) -> Result<PathBuf, ReadError> {
        let refused = |why| ReadError::Path { place: place.clone(), path: name.into(), why };
        let path = self.path(name).map_err(refused)?;
        let kind = path.metadata().map_err(|error| fault(&path, &error))?.file_type();
        // To open a pipe is to wait for its writer, and a device may have no end: neither is opened.
        other_kind(kind).map_or(Ok(path), |why| Err(refused(why)))
    }

    /// Returns the path of a file in the model, as the model gives it.
    fn path(&self, name: &str) -> Result<PathBuf, &'static str> {
        if let Some(within) = name.strip_prefix("package://") {
            if self.packages.is_empty() {
                return Err("names a package, and no folder with packages was given");
            }
            let mut candidates = self.packages.iter().map(|root| (root, root.join(within)));
            let candidate = candidates.find(|(_, path)| path.exists());
            let (root, path) = candidate.ok_or("is in none of the folders with packages")?;
            return inside(root, &path, within);
        }
        if name.contains("://") {
            return Err("is an address; only files are read");
        }
        let (Some(start), Some(root)) = (&self.start, &self.root) else {
            return Err("names a file, and no folder was given");
        };
        inside(root, &start.join(name), name)
    }
}

const PIPE: &str = "is a pipe; a model's files are regular ones";

/// Returns a message for everything that is not a regular file.
fn other_kind(kind: FileType) -> Option<&'static str> {
    #[cfg(unix)]
    if std::os::unix::fs::FileTypeExt::is_fifo(&kind) {
        return Some(PIPE);
    }
    match (kind.is_file(), kind.is_dir()) {
        (true, _) => None,
        (_, true) => Some("is a folder"),
        _ => Some("is a device or socket; only files are read"),
    }
}

fn fault(path: &Path, why: &dyn ToString) -> ReadError {
    ReadError::File { path: path.display().to_string(), why: why.to_string() }
}

/// Returns `path` without links, if it is within `root`. `given` is the part in the model.
fn inside(root: &Path, path: &Path, given: &str) -> Result<PathBuf, &'static str> {
    let absolute = |part| matches!(part, Component::RootDir | Component::Prefix(_));
    if given.contains('\\') || Path::new(given).components().any(absolute) {
        return Err("is no path relative to the model's folder");
    }
    // An absent file and one outside have different errors only if the error reveals nothing about the outside.
    let mut depth = 0_i32;
    let base = path.components().count() - Path::new(given).components().count();
    let within = base.saturating_sub(root.components().count());
    for part in Path::new(given).components() {
        depth += match part {
            Component::ParentDir => -1,
            Component::Normal(_) => 1,
            _ => 0,
        };
        if depth + i32::try_from(within).unwrap_or(0) < 0 {
            return Err("leads out of the folder that may be read");
        }
    }
    let real = path.canonicalize().map_err(|_| "is not there")?;
    if real.starts_with(root) { Ok(real) } else { Err("leads out of the folder that may be read") }
}

fn text(path: &Path, bytes: Vec<u8>) -> Result<String, ReadError> {
    String::from_utf8(bytes).map_err(|_| fault(path, &"is no text (UTF-8)"))
}
