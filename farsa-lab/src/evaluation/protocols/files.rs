//! Files of a protocol's results in a run's directory: `protocols/NAME.csv` and `protocols/NAME.json`.

use std::fs;
use std::io;
use std::path::PathBuf;

use serde::{Deserialize, Serialize};

use crate::error::Error;
use crate::evaluation::protocols::case_summary::CaseSummary;
use crate::evaluation::protocols::table::ProtocolTable;
use crate::evaluation::recorded::{self, TableRecord};
use crate::store::directory::Directory;

/// `protocols/NAME.json`: which champion `protocols/NAME.csv` is about, and how to make it again.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
pub(crate) struct ProtocolRecord {
    pub(crate) protocol: String,
    pub(crate) generation: u32,
    pub(crate) individual: u32,
    /// Trials per case.
    pub(crate) trials: usize,
    pub(crate) seed: u64,
    pub(crate) table_crc: u32,
}

impl ProtocolRecord {
    /// Checks whether both describe the same test, whatever their tables hold.
    pub(crate) fn same_test(&self, other: &Self) -> bool {
        *self == Self { table_crc: self.table_crc, ..other.clone() }
    }
}

/// Content of `protocols/NAME.json`: a record with the results of its test.
#[derive(Serialize)]
struct Recorded<'r> {
    #[serde(flatten)]
    record: ProtocolRecord,
    cases: &'r [CaseSummary],
}

impl TableRecord for ProtocolRecord {
    fn table_crc(&self) -> u32 {
        self.table_crc
    }
}

/// Where the files of a protocol are: its table and its record.
fn places(directory: &Directory, name: &str) -> [PathBuf; 2] {
    let folder = directory.protocols();
    ["csv", "json"].map(|end| folder.join(format!("{name}.{end}")))
}

/// Reads the table and record of a protocol, see [`recorded::read`].
///
/// # Errors
/// [`Error::Io`], [`Error::File`].
pub(crate) fn read(
    directory: &Directory,
    name: &str,
) -> Result<Option<(ProtocolTable, Option<ProtocolRecord>)>, Error> {
    let [table, record] = places(directory, name);
    let Some((text, found)) = recorded::read(&table, &record)? else { return Ok(None) };
    let found: Option<ProtocolRecord> = found;
    match &found {
        Some(other) if other.protocol != name => {
            Err(Error::damaged(&record, format!("is about the protocol {}", other.protocol)))
        }
        _ => Ok(Some((ProtocolTable::from_text(&table, &text)?, found))),
    }
}

/// Makes sure that the folder of the files is there, and is one.
///
/// # Errors
/// [`Error::Io`], and [`Error::File`] if the name is taken by something else.
pub(crate) fn make_folder(directory: &Directory) -> Result<(), Error> {
    let folder = directory.protocols();
    match fs::create_dir(&folder) {
        Err(error) if error.kind() == io::ErrorKind::AlreadyExists => {
            // A link would lead to another place.
            let is_folder = fs::symlink_metadata(&folder).map_err(Error::io("read", &folder))?.is_dir();
            if is_folder { Ok(()) } else { Err(Error::damaged(&folder, "is not a directory")) }
        }
        made => made.map_err(Error::io("make", &folder)),
    }
}

/// Writes both files of a protocol.
///
/// # Errors
/// As for [`recorded::write`] and [`make_folder`].
pub(crate) fn write(
    directory: &Directory,
    name: &str,
    (table, cases): (&ProtocolTable, &[CaseSummary]),
    record: impl FnOnce(u32) -> ProtocolRecord,
) -> Result<(), Error> {
    make_folder(directory)?;
    let [path, json] = places(directory, name);
    let bytes = table.csv(&path)?;
    recorded::write(directory.path(), (&path, &bytes), &json, |crc| Recorded { record: record(crc), cases })
}
