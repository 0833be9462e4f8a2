//! Records of searches, kept in memory or written to a file.

/// The checks and encodings shared by a record and a writer.
mod progress;
/// A record in memory.
mod record;
/// The sizes of a record.
mod shape;
/// A record that is handed out generation by generation.
mod writer;

pub use record::Record;
pub use writer::{RecordEntry, RecordWriter};
