//! What a strategy was told: records of searches, kept or written elsewhere.

mod entry;
mod progress;
mod record;
mod shape;
mod writer;

pub use entry::RecordEntry;
pub use record::Record;
pub use writer::RecordWriter;
