//! Runs from several directories combined: `farsa merge`.

/// Complete copies of runs.
mod copy;
/// Distinct runs below directories.
mod gather;
/// `farsa merge`: copies runs and makes a table.
mod merged;
/// A table of runs.
mod run_table;

pub(crate) use merged::Merge;
