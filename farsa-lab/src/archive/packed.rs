//! File of an archive: a checksummed file whose content is compressed by deflate.

use std::collections::BTreeMap;
use std::fs;
use std::io::{Read as _, Write as _};
use std::path::Path;

use flate2::Compression;
use flate2::read::DeflateDecoder;
use flate2::write::DeflateEncoder;
use serde::{Deserialize, Serialize};

use crate::error::{Error, FileFault};
use crate::store::checksummed::{self, Checksummed};
use crate::store::directory::ARCHIVE;
use crate::store::replace::{create_results, replace};

/// Bytes of the largest archive and of its largest content.
const MAX_BYTES: u64 = 1 << 28;
const MAX_CONTENT: u64 = 1 << 30;
/// Largest depth of a name and its most bytes.
const MAX_DEPTH: usize = 8;
const MAX_NAME_BYTES: usize = 1000;

/// Files of a run by their names.
pub(crate) type Files = BTreeMap<String, Vec<u8>>;

/// Runs by their names, which are paths below a common directory.
#[derive(Debug, Default, PartialEq, Eq)]
pub(crate) struct Archive {
    pub(crate) runs: BTreeMap<String, Files>,
}

/// Layout of the file.
#[derive(Serialize, Deserialize)]
struct Packed {
    deflated: Vec<u8>,
}

impl Checksummed for Packed {
    const MAGIC: [u8; 8] = ARCHIVE;
    const KIND: &'static str = "set of archived runs";
    const MAX_BYTES: u64 = MAX_BYTES;
}

/// Uncompressed content. Files of one name follow each other, because they are alike.
#[derive(Serialize, Deserialize)]
struct Content {
    runs: Vec<String>,
    files: Vec<PackedFile>,
}

#[derive(Serialize, Deserialize)]
struct PackedFile {
    name: String,
    run: u32,
    bytes: Vec<u8>,
}

impl Archive {
    /// Reads an archive.
    ///
    /// # Errors
    /// [`Error::Io`], and [`Error::File`] for another or a damaged file.
    pub(crate) fn read(path: &Path) -> Result<Self, Error> {
        let Packed { deflated } = checksummed::read(path)?;
        let content = inflated(&deflated).and_then(|content| Self::from_content(&content));
        content.map_err(|why| Error::damaged(path, why))
    }

    fn from_content(content: &[u8]) -> Result<Self, String> {
        let Content { runs, files } = postcard::from_bytes(content).map_err(|error| error.to_string())?;
        let mut archive = Self { runs: runs.iter().map(|run| (run.clone(), Files::new())).collect() };
        for PackedFile { name, run, bytes } in files {
            let run = usize::try_from(run).ok().and_then(|run| runs.get(run));
            let files = run.and_then(|run| archive.runs.get_mut(run)).ok_or("holds a file of no run")?;
            files.insert(name, bytes);
        }
        let mut names = archive.runs.iter().flat_map(|(run, files)| std::iter::once(run).chain(files.keys()));
        match names.find(|name| !is_name(name)) {
            Some(name) => Err(format!("holds the name {name:?}")),
            None => Ok(archive),
        }
    }

    fn to_content(&self) -> Result<Vec<u8>, postcard::Error> {
        let mut files: Vec<PackedFile> = Vec::new();
        for (run, own) in (0..).zip(self.runs.values()) {
            files.extend(own.iter().map(|(name, bytes)| PackedFile { name: name.clone(), run, bytes: bytes.clone() }));
        }
        files.sort_by(|a, b| (&a.name, a.run).cmp(&(&b.name, b.run)));
        postcard::to_stdvec(&Content { runs: self.runs.keys().cloned().collect(), files })
    }

    /// Checks that an archive can hold these runs, and that its file is missing or an archive whose runs are all among these.
    ///
    /// # Errors
    /// [`Error::Usage`].
    pub(crate) fn replaceable<'n>(path: &Path, names: impl IntoIterator<Item = &'n str>) -> Result<(), Error> {
        let refused = |why: String| Error::Usage(format!("{}: {why}", path.display()));
        let names: Vec<&str> = names.into_iter().collect();
        if let Some(name) = names.iter().find(|name| !is_name(name)) {
            return Err(refused(format!("an archive cannot hold the name {name:?}")));
        }
        if fs::symlink_metadata(path).is_err() {
            return Ok(());
        }
        let there = Self::read(path).map_err(|error| match error {
            Error::File { why, fault: FileFault::Damaged, .. } => {
                refused(format!("there is one already, which is no archive: {why}"))
            }
            other => other,
        })?;
        match there.runs.keys().find(|name| !names.contains(&name.as_str())) {
            Some(name) => Err(refused(format!("there is one already with the run {name:?}, which is not among these"))),
            None => Ok(()),
        }
    }

    /// Writes the file, over an archive whose runs are all in this one, and returns its bytes.
    ///
    /// # Errors
    /// The errors of [`replaceable`](Self::replaceable), [`Error::Io`], and [`Error::Other`] above the largest size.
    pub(crate) fn write(&self, path: &Path) -> Result<u64, Error> {
        Self::replaceable(path, self.runs.keys().map(String::as_str))?;
        let failed = |error: &dyn std::fmt::Display| Error::Other(format!("{}: {error}", path.display()));
        if let Some(name) = self.runs.values().flat_map(BTreeMap::keys).find(|name| !is_name(name)) {
            return Err(failed(&format!("an archive cannot hold the name {name:?}")));
        }
        let content = self.to_content().map_err(|error| failed(&error))?;
        let mut encoder = DeflateEncoder::new(Vec::new(), Compression::best());
        let deflated = encoder.write_all(&content).and_then(|()| encoder.finish()).map_err(|error| failed(&error))?;
        let bytes = checksummed::to_bytes(path, &Packed { deflated })?;
        for (size, most) in [(content.len(), MAX_CONTENT), (bytes.len(), MAX_BYTES)] {
            if size as u64 > most {
                return Err(Error::too_large(path, size as u64, most));
            }
        }
        let size = bytes.len() as u64;
        if path.is_file() {
            replace(path, &bytes)?;
        } else {
            create_results(&[(path.to_path_buf(), bytes)])?;
        }
        Ok(size)
    }

    /// Writes all files below a directory.
    ///
    /// # Errors
    /// [`Error::Io`].
    pub(crate) fn unpack(&self, root: &Path) -> Result<(), Error> {
        for (run, files) in &self.runs {
            for (name, bytes) in files {
                let path = root.join(run).join(name);
                let folder = path.parent().unwrap_or(root);
                fs::create_dir_all(folder).map_err(Error::io("make", folder))?;
                fs::write(&path, bytes).map_err(Error::io("write", &path))?;
            }
        }
        Ok(())
    }
}

/// Checks that a name is a path below a directory.
fn is_name(name: &str) -> bool {
    let is_part = |part: &str| {
        let valid = |letter: char| !letter.is_control() && !"\\:".contains(letter);
        !part.is_empty() && !part.starts_with('.') && part.chars().all(valid)
    };
    name.len() <= MAX_NAME_BYTES && name.split('/').count() <= MAX_DEPTH && name.split('/').all(is_part)
}

/// Decompresses the content of an archive.
fn inflated(deflated: &[u8]) -> Result<Vec<u8>, String> {
    let mut content = Vec::new();
    let read = DeflateDecoder::new(deflated).take(MAX_CONTENT + 1).read_to_end(&mut content);
    read.map_err(|error| error.to_string())?;
    if content.len() as u64 > MAX_CONTENT {
        return Err(format!("holds more than {MAX_CONTENT} bytes"));
    }
    Ok(content)
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    fn archive(runs: &[&str]) -> Archive {
        let files = |run: &str| {
            let file = |name: &str| (name.to_owned(), format!("{name} of {run}").into_bytes());
            ["config.toml", "protocols/labels.csv"].map(file).into()
        };
        Archive { runs: runs.iter().map(|&run| (run.to_owned(), files(run))).collect() }
    }

    #[test]
    fn a_written_archive_is_read_back_and_only_grows() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("a.farsa");
        let (one, two) = (archive(&["x=1/a-1"]), archive(&["x=1/a-1", "x=2/a-1"]));
        let bytes = one.write(&path).unwrap();
        assert_eq!((fs::metadata(&path).unwrap().len(), Archive::read(&path).unwrap() == one), (bytes, true));
        two.write(&path).unwrap();
        let first = fs::read(&path).unwrap();
        let refused = one.write(&path).unwrap_err().to_string();
        assert!(refused.ends_with("with the run \"x=2/a-1\", which is not among these"), "{refused}");
        two.write(&path).unwrap();
        assert!(fs::read(&path).unwrap() == first && Archive::read(&path).unwrap() == two);
        two.unpack(folder.path()).unwrap();
        let text = fs::read_to_string(folder.path().join("x=2/a-1/protocols/labels.csv")).unwrap();
        assert_eq!(text, "protocols/labels.csv of x=2/a-1");
        let mine = folder.path().join("mine.txt");
        fs::write(&mine, "mine").unwrap();
        let refused = one.write(&mine).unwrap_err().to_string();
        assert!(refused.contains("mine.txt: there is one already, which is no archive"), "{refused}");
        assert_eq!(fs::read(&mine).unwrap(), b"mine");
    }

    #[test]
    fn every_flipped_bit_and_every_truncation_is_refused() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("a.farsa");
        archive(&["x=1/a-1", "x=2/a-1"]).write(&path).unwrap();
        let bytes = fs::read(&path).unwrap();
        let refused = |bytes: &[u8]| {
            fs::write(&path, bytes).unwrap();
            let error = Archive::read(&path).unwrap_err().to_string();
            assert!(error.starts_with(&format!("{}: ", path.display())), "{error}");
        };
        for bit in 0..8 * bytes.len() {
            let mut altered = bytes.clone();
            altered[bit / 8] ^= 1 << (bit % 8);
            refused(&altered);
        }
        for length in 0..bytes.len() {
            refused(&bytes[..length]);
        }
    }

    #[test]
    fn names_stay_below_the_directory() {
        for name in ["a", "condition=labels/run-1", "protocols/a b.csv", "größe=1"] {
            assert!(is_name(name), "{name}");
        }
        let deep = ["a"; 9].join("/");
        for name in ["", "/a", "a/", "a//b", "..", "a/../b", ".hidden", "c:a", "a\\b", "a\nb", &deep, &"x".repeat(1001)]
        {
            assert!(!is_name(name), "{name}");
            let refused = archive(&[name]).write(Path::new("none/new.farsa")).unwrap_err().to_string();
            assert_eq!(refused, format!("none/new.farsa: an archive cannot hold the name {name:?}"));
            let content = archive(&[name]).to_content().unwrap();
            assert_eq!(Archive::from_content(&content).unwrap_err(), format!("holds the name {name:?}"));
        }
        let file = PackedFile { name: "a".into(), run: 1, bytes: Vec::new() };
        let content = postcard::to_stdvec(&Content { runs: vec!["a".into()], files: vec![file] }).unwrap();
        assert_eq!(Archive::from_content(&content).unwrap_err(), "holds a file of no run");
    }
    proptest! {
        #[test]
        fn any_content_is_read_or_refused(bytes in prop::collection::vec(0_u8..8, 0..60)) {
            if let Ok(Archive { runs }) = Archive::from_content(&bytes) {
                prop_assert!(runs.iter().all(|(run, files)| is_name(run) && files.keys().all(|name| is_name(name))));
            }
        }
    }
}
