//! Table of a test and its record, two files that belong together.

use std::path::Path;
use std::thread;
use std::time::Duration;

use farsa_num::crc32;
use serde::Serialize;
use serde::de::DeserializeOwned;

use crate::error::Error;
use crate::store::bounded::read_regular_text;
use crate::store::lock::Lock;
use crate::store::replace::replace;
use crate::store::temporary_file;

/// Bytes of the largest table and of the largest record that are read.
const MAX_BYTES: [u64; 2] = [1 << 30, 1 << 20];
/// Number of attempts and the pause between them, while another process writes the two files.
const ATTEMPTS: usize = 20;
const PAUSE: Duration = Duration::from_millis(25);

/// Record of a test.
pub(crate) trait TableRecord: DeserializeOwned {
    /// CRC-32 of the table: a process that was killed between the two files leaves another.
    fn table_crc(&self) -> u32;
}

/// Reads the text of a table with its record. Returns none without a table. The record is missing if the table is older
/// than records, or if its process was killed.
///
/// # Errors
/// [`Error::Io`], [`Error::File`].
pub(crate) fn read<R: TableRecord>(table: &Path, record: &Path) -> Result<Option<(String, Option<R>)>, Error> {
    if !table.is_file() {
        return Ok(None);
    }
    for attempt in 1..=ATTEMPTS {
        let text = read_regular_text(table, MAX_BYTES[0])?;
        let stored: Option<R> = if record.is_file() {
            let text = read_regular_text(record, MAX_BYTES[1])?;
            Some(serde_json::from_str(&text).map_err(|error| Error::damaged(record, error))?)
        } else {
            None
        };
        let own = stored.filter(|record| record.table_crc() == crc32(text.as_bytes()));
        if own.is_some() || attempt == ATTEMPTS || !record.is_file() {
            return Ok(Some((text, own)));
        }
        // One file is of a test that is just being written.
        thread::sleep(PAUSE);
    }
    Ok(None)
}

/// Writes both files of a test under the lock of the directory. `make` receives the CRC-32 of the table.
///
/// # Errors
/// [`Error::Io`], and [`Error::File`] while another process writes a test.
pub(crate) fn write<R: Serialize>(
    directory: &Path,
    table: (&Path, &[u8]),
    path: &Path,
    make: impl FnOnce(u32) -> R,
) -> Result<(), Error> {
    let (place, bytes) = table;
    let text = serde_json::to_string_pretty(&make(crc32(bytes))).map_err(|error| Error::Other(error.to_string()))?;
    let _lock = Lock::of_tests(directory)?;
    temporary_file::sweep_of(place);
    temporary_file::sweep_of(path);
    replace(place, bytes)?;
    replace(path, format!("{text}\n").as_bytes())
}
