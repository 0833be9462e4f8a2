//! Pictures, pages and reports that replace their earlier versions.
//!
//! Such a file has a mark with the checksum of its other bytes. A file without a mark, or one that was changed, stays.

use std::fs;
use std::path::{Path, PathBuf};

use farsa_num::crc32;

use crate::error::Error;
use crate::store::replace::{create_results, refuse_lost, replace};
use crate::store::temporary_file;

/// First bytes of a PNG file.
const PNG: &[u8] = b"\x89PNG\r\n\x1a\n";
/// Length of the last chunk of PNG, which must remain the last.
const PNG_END: usize = 12;
/// Bytes of the largest file that is read.
const MAX_BYTES: u64 = 1_000_000_000;

/// Returns the mark of a file with a checksum: a comment of HTML, SVG and Markdown, or a chunk of text of PNG.
fn mark(is_png: bool, crc: u32) -> Vec<u8> {
    if !is_png {
        return format!("<!-- FARSA {crc:08x} -->\n").into_bytes();
    }
    let chunk = format!("tEXtSoftware\0FARSA {crc:08x}").into_bytes();
    let length = (chunk.len() - 4) as u32;
    [&length.to_be_bytes(), chunk.as_slice(), &crc32(&chunk).to_be_bytes()].concat()
}

/// Returns the place of a mark: the end of the file, or of its chunks before the last.
fn place(bytes: &[u8]) -> usize {
    bytes.len() - if bytes.starts_with(PNG) { PNG_END.min(bytes.len()) } else { 0 }
}

/// Adds the mark to a file.
fn marked(bytes: &[u8]) -> Vec<u8> {
    let (start, end) = bytes.split_at(place(bytes));
    [start, &mark(bytes.starts_with(PNG), crc32(bytes)), end].concat()
}

/// Checks if the mark of a file fits its other bytes.
fn is_marked(bytes: &[u8]) -> bool {
    let (start, end) = bytes.split_at(place(bytes));
    let is_png = bytes.starts_with(PNG);
    let Some(length) = start.len().checked_sub(mark(is_png, 0).len()) else { return false };
    let (start, stored) = start.split_at(length);
    stored == mark(is_png, crc32(&[start, end].concat()))
}

/// Checks if a file is an unchanged output.
fn is_own(path: &Path) -> bool {
    let is_small = fs::symlink_metadata(path).is_ok_and(|file| file.is_file() && file.len() <= MAX_BYTES);
    is_small && fs::read(path).is_ok_and(|bytes| is_marked(&bytes))
}

/// Refuses a name without its folder and that of an existing file, except of an unchanged output, before the new one takes time
/// to compute.
///
/// # Errors
/// [`Error::Usage`].
pub(crate) fn refuse_other(path: &Path) -> Result<(), Error> {
    replaces(path).map(drop)
}

/// Checks if an output replaces its earlier version, or refuses its name.
fn replaces(path: &Path) -> Result<bool, Error> {
    refuse_lost(path)?;
    let is_own = is_own(path);
    if !is_own && fs::metadata(path).is_ok_and(|metadata| metadata.is_file() || metadata.is_dir()) {
        let why = "there is one already, without an intact mark of FARSA";
        return Err(Error::Usage(format!("{}: {why}", path.display())));
    }
    Ok(is_own)
}

/// Writes pictures, pages and reports to new files, or over their earlier versions. Returns the number of bytes.
///
/// # Errors
/// The errors of [`refuse_other`] and [`create_results`]. No file is changed if one is refused.
pub(crate) fn write_outputs(outputs: &[(PathBuf, impl AsRef<[u8]>)]) -> Result<usize, Error> {
    let (mut old, mut new) = (Vec::new(), Vec::new());
    for (path, bytes) in outputs {
        let files = if replaces(path)? { &mut old } else { &mut new };
        files.push((path.clone(), marked(bytes.as_ref())));
    }
    create_results(&new)?;
    for (path, bytes) in &old {
        temporary_file::sweep_of(path);
        replace(path, bytes)?;
    }
    Ok(old.iter().chain(&new).map(|(_, bytes)| bytes.len()).sum())
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Smallest PNG: a signature, a header that is not checked here, and the last chunk.
    fn png() -> Vec<u8> {
        [PNG, b"header", b"\0\0\0\0IEND\xae\x42\x60\x82"].concat()
    }

    #[test]
    fn a_mark_fits_its_file_alone() {
        for bytes in [b"<svg></svg>".to_vec(), Vec::new(), png()] {
            let whole = marked(&bytes);
            assert!(is_marked(&whole) && !is_marked(&bytes));
            for at in 0..whole.len() {
                let mut changed = whole.clone();
                changed[at] ^= 1;
                assert!(!is_marked(&changed), "byte {at}");
                assert!(!is_marked(&whole[..at]), "{at} bytes");
            }
        }
    }

    /// The chunk by hand: 23 bytes, keyword, zero, text, and the CRC of PNG.
    #[test]
    fn a_png_remains_one() {
        let whole = marked(&png());
        let chunk = &whole[PNG.len() + 6..whole.len() - PNG_END];
        let text = format!("tEXtSoftware\0FARSA {:08x}", crc32(&png()));
        assert_eq!(chunk, [b"\0\0\0\x17", text.as_bytes(), &crc32(text.as_bytes()).to_be_bytes()].concat());
        assert!(whole.ends_with(b"\0\0\0\0IEND\xae\x42\x60\x82"));
    }

    #[test]
    fn only_own_files_are_replaced() {
        let folder = tempfile::tempdir().unwrap();
        let path = |name: &str| folder.path().join(name);
        let write = |text: &str, names: &[&str]| {
            write_outputs(&names.iter().map(|name| (path(name), text.to_owned())).collect::<Vec<_>>())
        };
        write("first", &["a.md", "b.svg"]).unwrap();
        write("second", &["a.md", "c.svg"]).unwrap();
        let text = |name: &str| fs::read_to_string(path(name)).unwrap();
        assert!(text("a.md").starts_with("second<!-- FARSA ") && text("b.svg").starts_with("first<!-- "));
        fs::write(path("mine.svg"), "mine").unwrap();
        fs::write(path("b.svg"), text("b.svg").replace("first", "First")).unwrap();
        for (names, refused) in [(["a.md", "mine.svg"], "mine.svg"), (["a.md", "b.svg"], "b.svg")] {
            let error = write("third", &names).unwrap_err().to_string();
            assert!(error.contains(&format!("{refused}: there is one already, without an intact mark")), "{error}");
        }
        assert_eq!(text("mine.svg"), "mine");
        assert!(text("a.md").starts_with("second") && text("b.svg").starts_with("First"));
        assert!(refuse_other(folder.path()).is_err() && refuse_other(&path("new.md")).is_ok());
        let lost = refuse_other(&path("none/new.md")).unwrap_err().to_string();
        assert!(lost.contains("there is no folder "), "{lost}");
        assert_eq!(fs::read_dir(folder.path()).unwrap().count(), 4);
    }
}
