//! Checksummed files, with a kind, a format version and a length.
//!
//! Layout, little-endian: 8 bytes that name the kind, `u32` format version, `u64` length of the content, the content
//! (postcard), `u32` CRC-32 of everything before it.

use std::fs;
use std::io::{self, Read as _};
use std::path::Path;

use farsa_num::crc32;
use serde::Serialize;
use serde::de::DeserializeOwned;

use crate::error::Error;
use crate::store::bounded::read_regular;
use crate::store::replace::replace;

/// Version of the layout and of all contents.
const FORMAT: u32 = 1;
const HEAD: usize = 8 + 4 + 8;
const CHECKSUM: usize = 4;

/// Content of a checksummed file.
pub(crate) trait Checksummed: Serialize + DeserializeOwned {
    /// First bytes of the file.
    const MAGIC: [u8; 8];
    /// Name of the kind in errors.
    const KIND: &'static str;
    /// Bytes of the largest file.
    const MAX_BYTES: u64;
}

/// Writes a checksummed file by [`replace`].
///
/// # Errors
/// [`Error::Io`], and [`Error::Other`] for a file that is too large to be read back. Nothing is replaced then.
pub(crate) fn write<T: Checksummed>(path: &Path, content: &T) -> Result<(), Error> {
    let bytes = to_bytes(path, content)?;
    let size = bytes.len() as u64;
    if size > T::MAX_BYTES {
        return Err(Error::too_large(path, size, T::MAX_BYTES));
    }
    replace(path, &bytes)
}

/// Builds the bytes of a checksummed file. `path` is for errors.
pub(crate) fn to_bytes<T: Checksummed>(path: &Path, content: &T) -> Result<Vec<u8>, Error> {
    let head = [&T::MAGIC[..], &FORMAT.to_le_bytes(), &[0; 8]].concat();
    let mut bytes = postcard::to_extend(content, head).map_err(|error| Error::Io {
        doing: "write",
        path: path.into(),
        source: io::Error::other(error),
    })?;
    let length = (bytes.len() - HEAD) as u64;
    bytes[HEAD - 8..HEAD].copy_from_slice(&length.to_le_bytes());
    let checksum = crc32(&bytes);
    bytes.extend(checksum.to_le_bytes());
    Ok(bytes)
}

/// Returns the first bytes of a file, which identify its kind. The result is `None` for a shorter file.
pub(crate) fn magic(path: &Path) -> Result<Option<[u8; 8]>, Error> {
    let regular = fs::metadata(path).map_err(Error::io("read", path))?.is_file();
    if !regular {
        return Err(Error::damaged(path, "is no regular file"));
    }
    let mut magic = Vec::new();
    let file = fs::File::open(path).map_err(Error::io("read", path))?;
    file.take(8).read_to_end(&mut magic).map_err(Error::io("read", path))?;
    Ok(magic.try_into().ok())
}

/// Reads a checksummed file.
///
/// # Errors
/// [`Error::Io`], and [`Error::File`] for a changed file.
pub(crate) fn read<T: Checksummed>(path: &Path) -> Result<T, Error> {
    let bytes = read_regular(path, T::MAX_BYTES)?;
    open(&bytes).map_err(|why| Error::damaged(path, why))
}

/// Returns the content of a checksummed part, and the bytes after it.
///
/// # Errors
/// The reason why the part is invalid.
pub(crate) fn open_first<T: Checksummed>(bytes: &[u8]) -> Result<(T, &[u8]), String> {
    let length =
        bytes.get(12..HEAD).and_then(|length| length.first_chunk::<8>()).map(|length| u64::from_le_bytes(*length));
    let end = length.and_then(|length| usize::try_from(length).ok()?.checked_add(HEAD + CHECKSUM));
    let (first, rest) = bytes.split_at_checked(end.unwrap_or(bytes.len())).unwrap_or((bytes, &[]));
    Ok((open(first)?, rest))
}

/// Returns the content of a checksummed file.
///
/// # Errors
/// The reason why the file is invalid.
pub(crate) fn open<T: Checksummed>(bytes: &[u8]) -> Result<T, String> {
    let truncated = |expected: u64| format!("truncated: {} bytes of {expected}", bytes.len());
    let Some((magic, rest)) = bytes.split_first_chunk::<8>() else {
        return Err(truncated((HEAD + CHECKSUM) as u64));
    };
    if *magic != T::MAGIC {
        return Err(format!("is not a {} of FARSA", T::KIND));
    }
    let Some((version, rest)) = rest.split_first_chunk::<4>() else {
        return Err(truncated((HEAD + CHECKSUM) as u64));
    };
    let version = u32::from_le_bytes(*version);
    if version != FORMAT {
        return Err(format!("has format version {version}, this program reads version {FORMAT}"));
    }
    let Some((length, rest)) = rest.split_first_chunk::<8>() else {
        return Err(truncated((HEAD + CHECKSUM) as u64));
    };
    let expected = u64::from_le_bytes(*length).saturating_add((HEAD + CHECKSUM) as u64);
    let found = bytes.len() as u64;
    if found < expected {
        return Err(truncated(expected));
    }
    let Some((content, checksum)) = rest.split_last_chunk::<CHECKSUM>().filter(|_| found == expected) else {
        return Err(format!("altered: {found} bytes where {expected} were written"));
    };
    let computed = crc32(&bytes[..bytes.len() - CHECKSUM]);
    let written = u32::from_le_bytes(*checksum);
    if computed != written {
        return Err(format!("altered: its checksum is {computed:08x}, {written:08x} was written"));
    }
    match postcard::take_from_bytes(content) {
        Ok((value, [])) => Ok(value),
        Ok((_, rest)) => Err(format!("holds {} bytes more than a {}", rest.len(), T::KIND)),
        Err(error) => Err(format!("holds no {}: {error}", T::KIND)),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[derive(Debug, PartialEq, serde::Serialize, serde::Deserialize)]
    struct Thing(Vec<u16>);

    impl Checksummed for Thing {
        const MAGIC: [u8; 8] = *b"farsathg";
        const KIND: &'static str = "thing";
        const MAX_BYTES: u64 = 1000;
    }

    fn sealed() -> Vec<u8> {
        let directory = tempfile();
        let path = directory.join("thing.bin");
        write(&path, &Thing(vec![1, 2, 3])).unwrap();
        assert_eq!(read::<Thing>(&path).unwrap(), Thing(vec![1, 2, 3]));
        let bytes = fs::read(&path).unwrap();
        fs::remove_dir_all(directory).unwrap();
        bytes
    }

    fn tempfile() -> std::path::PathBuf {
        let directory =
            std::env::temp_dir().join(format!("farsa-sealed-{}-{:?}", std::process::id(), std::thread::current().id()));
        fs::create_dir_all(&directory).unwrap();
        directory
    }

    #[test]
    fn what_would_not_be_read_replaces_nothing() {
        let directory = tempfile();
        let path = directory.join("thing.bin");
        // In postcard the length has two bytes here, and each of these numbers three.
        let largest = |count: usize| Thing(vec![u16::MAX; count]);
        let most = (Thing::MAX_BYTES as usize - HEAD - CHECKSUM - 2) / 3;
        write(&path, &largest(most)).unwrap();
        let message = write(&path, &largest(most + 1)).unwrap_err().to_string();
        assert!(message.ends_with("bytes, more than the 1000 that are read of it"), "{message}");
        assert_eq!(read::<Thing>(&path).unwrap(), largest(most));
        fs::remove_dir_all(directory).unwrap();
    }

    #[test]
    fn every_truncation_and_every_flipped_bit_is_found() {
        let bytes = sealed();
        for length in 0..bytes.len() {
            let why = open::<Thing>(&bytes[..length]).unwrap_err();
            assert!(why.starts_with("truncated"), "{length}: {why}");
        }
        for bit in 0..bytes.len() * 8 {
            let mut altered = bytes.clone();
            altered[bit / 8] ^= 1 << (bit % 8);
            assert!(open::<Thing>(&altered).is_err(), "bit {bit}");
        }
        let longer = [bytes.as_slice(), &[0]].concat();
        assert_eq!(open::<Thing>(&longer).unwrap_err(), "altered: 29 bytes where 28 were written");
    }

    #[test]
    fn what_follows_a_sealed_part_is_left() {
        let bytes = sealed();
        let longer = [bytes.as_slice(), &[7, 8]].concat();
        assert_eq!(open_first::<Thing>(&longer).unwrap(), (Thing(vec![1, 2, 3]), &[7, 8][..]));
        assert!(open_first::<Thing>(&bytes).unwrap().1.is_empty());
        for length in 0..bytes.len() {
            assert!(open_first::<Thing>(&bytes[..length]).is_err(), "{length}");
        }
        let mut endless = longer;
        endless[12..20].fill(0xff);
        assert!(open_first::<Thing>(&endless).is_err());
    }

    #[test]
    fn other_files_are_told_apart() {
        let mut bytes = sealed();
        bytes[8] = 2;
        assert_eq!(open::<Thing>(&bytes).unwrap_err(), "has format version 2, this program reads version 1");
        bytes[0] = b'F';
        assert_eq!(open::<Thing>(&bytes).unwrap_err(), "is not a thing of FARSA");
    }
}
