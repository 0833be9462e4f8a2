//! Files that a model names: found within its folders only, regular, and read no further than allowed.

use std::fs::{File, FileType};
use std::io::Read as _;
use std::path::{Component, Path, PathBuf};

use crate::error::{ReadError, SourceLocation};
use crate::options::ReadOptions;

/// Name of a file in a model, with the folders that complete it.
#[derive(Clone, Copy)]
pub(crate) struct NamedFile<'a> {
    pub(crate) name: &'a str,
    /// Folder of assets that the model chooses, such as `meshdir`. It may be empty.
    pub(crate) assets: &'a str,
    /// Folder of the included file that contains the name.
    pub(crate) folder: Option<&'a Path>,
}

/// Reads files for a model.
pub(crate) struct ModelFiles {
    /// Where relative paths begin, and the folder that they must stay in. Both without links.
    start: Option<PathBuf>,
    root: Option<PathBuf>,
    /// The root as the caller spells it, for absolute paths in the model.
    spelled: Option<PathBuf>,
    packages: Vec<PathBuf>,
    most_bytes: usize,
    most_files: usize,
    opened: Vec<PathBuf>,
    most_read: usize,
    read: usize,
}

const OUTSIDE: &str = "leads out of the folder that may be read";

fn real(path: &Path) -> Result<PathBuf, ReadError> {
    // The folder of a bare file name is the current one.
    let path = if path.as_os_str().is_empty() { Path::new(".") } else { path };
    path.canonicalize().map_err(|error| fault(path, &error))
}

impl ModelFiles {
    pub(crate) fn new(folder: Option<&Path>, options: &ReadOptions) -> Result<Self, ReadError> {
        let start = folder.or(options.root.as_deref()).map(real).transpose()?;
        let root = options.root.as_deref().map(real).transpose()?.or_else(|| start.clone());
        let spelled = options.root.as_deref().or(folder);
        Ok(Self {
            start,
            root,
            spelled: spelled.and_then(|path| std::path::absolute(path).ok()).map(|path| lexical(&path)),
            packages: options.packages.iter().map(|path| real(path)).collect::<Result<_, _>>()?,
            most_bytes: options.limits.bytes,
            most_files: options.limits.files,
            opened: Vec::new(),
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
    pub(crate) fn text(
        &mut self,
        place: &SourceLocation,
        named: &NamedFile<'_>,
    ) -> Result<(PathBuf, String), ReadError> {
        let path = self.find(place, named)?;
        let read = text(&path, self.bytes(&path, place)?)?;
        Ok((path, read))
    }

    /// Reads the content of a file that the model names.
    pub(crate) fn content(&mut self, place: &SourceLocation, named: &NamedFile<'_>) -> Result<Vec<u8>, ReadError> {
        let path = self.find(place, named)?;
        self.bytes(&path, place)
    }

    /// Formats the path of a file for messages, relative to the model's folder if it is below it.
    pub(crate) fn label(&self, path: &Path) -> String {
        let below = self.start.as_deref().and_then(|start| path.strip_prefix(start).ok());
        below.unwrap_or(path).display().to_string()
    }

    /// Lists the files that were opened, in their order.
    pub(crate) fn opened(self) -> Vec<PathBuf> {
        self.opened
    }

    fn bytes(&mut self, path: &Path, place: &SourceLocation) -> Result<Vec<u8>, ReadError> {
        self.opened.push(path.into());
        if self.opened.len() > self.most_files {
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
    fn find(&self, place: &SourceLocation, named: &NamedFile<'_>) -> Result<PathBuf, ReadError> {
        let path = joined(named.assets, named.name);
        let refused = |why| ReadError::Path { place: place.clone(), path: path.clone(), why };
        let path = self.path(named, &path).map_err(refused)?;
        let kind = path.metadata().map_err(|error| fault(&path, &error))?.file_type();
        // To open a pipe is to wait for its writer, and a device may have no end: neither is opened.
        other_kind(kind).map_or(Ok(path), |why| Err(refused(why)))
    }

    /// Returns the first place with the file: the model's folder of assets, then the folder of the included file, then
    /// the same folder below that of the assets (MuJoCo's place for a model with a relative path), then its own folder
    /// of assets. `path` is the name in the model's folder of assets.
    fn path(&self, named: &NamedFile<'_>, path: &str) -> Result<PathBuf, &'static str> {
        let NamedFile { name, assets, folder } = *named;
        let start = self.start.as_deref();
        let first = self.resolved(start, path);
        let Some(folder) = folder.filter(|_| first.is_err() && !is_complete(name)) else { return first };
        let below = start.and_then(|start| folder.strip_prefix(start).ok()?.to_str());
        let below = below.map(|below| joined(assets, &joined(below, name)));
        let places = [(Some(folder), Some(name)), (start, below.as_deref()), (Some(folder), Some(path))];
        let other = places.into_iter().find_map(|(folder, name)| self.resolved(folder, name?).ok());
        other.map_or(first, Ok)
    }

    /// Returns the path of a file in the model, as the model gives it.
    fn resolved(&self, folder: Option<&Path>, given: &str) -> Result<PathBuf, &'static str> {
        if let Some((scheme, rest)) = given.split_once("://") {
            return match scheme {
                "package" | "model" => self.in_packages(rest),
                "file" => self.on_disk(folder, &decoded(local(rest))),
                _ => Err("is an address; only files are read"),
            };
        }
        self.on_disk(folder, given)
    }

    /// Returns a path of this system, relative to a folder or absolute.
    fn on_disk(&self, folder: Option<&Path>, given: &str) -> Result<PathBuf, &'static str> {
        let (Some(folder), Some(root)) = (folder, &self.root) else {
            return Err("names a file, and no folder was given");
        };
        // MuJoCo's separators on every system.
        let given = given.replace('\\', "/");
        let path = Path::new(&given);
        if path.components().any(|part| matches!(part, Component::RootDir | Component::Prefix(_))) {
            return self.absolute(root, path);
        }
        inside(root, &folder.join(path), path)
    }

    /// Returns an absolute path without links, if it is within the root.
    fn absolute(&self, root: &Path, path: &Path) -> Result<PathBuf, &'static str> {
        let path = lexical(path);
        // An absent file outside has the same error as a present one.
        if ![Some(root), self.spelled.as_deref()].into_iter().flatten().any(|root| path.starts_with(root)) {
            return Err(OUTSIDE);
        }
        let real = path.canonicalize().map_err(|_| "is not there")?;
        if real.starts_with(root) { Ok(real) } else { Err(OUTSIDE) }
    }

    /// Returns the path of a file in a package: in a folder with packages, or in a folder from the model's up to the root.
    fn in_packages(&self, within: &str) -> Result<PathBuf, &'static str> {
        let path = Path::new(within);
        if path.components().any(|part| matches!(part, Component::RootDir | Component::Prefix(_))) {
            return Err("names no package");
        }
        let above = self.start.iter().flat_map(|start| start.ancestors());
        let above = above.take_while(|folder| self.root.as_ref().is_some_and(|root| folder.starts_with(root)));
        let mut fault = "is in none of the folders with packages";
        for folder in self.packages.iter().map(PathBuf::as_path).chain(above) {
            match inside(folder, &folder.join(path), path) {
                Err(OUTSIDE) => fault = OUTSIDE,
                Err(_) => {}
                found => return found,
            }
        }
        Err(if self.packages.is_empty() { "names a package, and no folder with packages was given" } else { fault })
    }
}

/// Checks whether a name does not depend on any folder.
fn is_complete(name: &str) -> bool {
    name.contains("://") || name.starts_with(['/', '\\']) || Path::new(name).is_absolute()
}

/// Joins a folder and a name as the model writes them.
fn joined(folder: &str, name: &str) -> String {
    let folder = folder.strip_suffix(['/', '\\']).filter(|folder| !folder.is_empty()).unwrap_or(folder);
    match folder {
        "" => name.into(),
        _ if is_complete(name) => name.into(),
        "/" | "\\" => format!("/{name}"),
        _ => format!("{folder}/{name}"),
    }
}

/// Returns the path in a `file://` address without the name of this machine.
fn local(address: &str) -> &str {
    let path = address.strip_prefix("localhost").filter(|path| path.starts_with('/')).unwrap_or(address);
    let drive = path.strip_prefix('/').filter(|path| cfg!(windows) && path.as_bytes().get(1) == Some(&b':'));
    drive.unwrap_or(path)
}

/// Replaces the `%20` of an address by its byte.
fn decoded(address: &str) -> String {
    let mut bytes = Vec::with_capacity(address.len());
    let mut rest = address.as_bytes();
    while let [first, tail @ ..] = rest {
        let escaped = tail.get(..2).and_then(|two| u8::from_str_radix(core::str::from_utf8(two).ok()?, 16).ok());
        let (byte, used) = if *first == b'%' { escaped.map_or((b'%', 0), |byte| (byte, 2)) } else { (*first, 0) };
        bytes.push(byte);
        rest = &tail[used..];
    }
    String::from_utf8(bytes).unwrap_or_else(|_| address.into())
}

/// Removes `.` and `..` from an absolute path, without looking at the disk.
fn lexical(path: &Path) -> PathBuf {
    path.components().fold(PathBuf::new(), |mut clean, part| {
        match part {
            Component::ParentDir => drop(clean.pop()),
            Component::CurDir => {}
            part => clean.push(part),
        }
        clean
    })
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

/// Returns `path` without links, if it is within `root`. `given` is the relative part in the model.
fn inside(root: &Path, path: &Path, given: &Path) -> Result<PathBuf, &'static str> {
    // An absent file and one outside have different errors only if the error reveals nothing about the outside.
    let mut depth = 0_i32;
    let base = path.components().count().saturating_sub(given.components().count());
    let within = i32::try_from(base.saturating_sub(root.components().count())).unwrap_or(0);
    for part in given.components() {
        depth += match part {
            Component::ParentDir => -1,
            Component::Normal(_) => 1,
            _ => 0,
        };
        if depth + within < 0 {
            return Err(OUTSIDE);
        }
    }
    let real = path.canonicalize().map_err(|_| "is not there")?;
    if real.starts_with(root) { Ok(real) } else { Err(OUTSIDE) }
}

fn text(path: &Path, bytes: Vec<u8>) -> Result<String, ReadError> {
    String::from_utf8(bytes).map_err(|_| fault(path, &"is no text (UTF-8)"))
}
