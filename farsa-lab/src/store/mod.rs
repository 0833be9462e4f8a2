//! Files of a run.

/// Files that grow at their end.
pub(crate) mod append_log;
/// Reads with a limit on bytes.
pub(crate) mod bounded;
/// Files with a kind, a format version, a length and a checksum.
pub(crate) mod checksummed;
/// Directory of a run and the names of its files.
pub(crate) mod directory;
/// `failures.csv`: the failed evaluations.
pub(crate) mod failures;
/// Everything that the results of a run depend on.
pub(crate) mod identity;
/// `lineage.csv`: the parents of every individual.
pub(crate) mod lineage;
/// Locks between processes.
pub(crate) mod lock;
/// `fitness.csv`: one line for each finished generation.
pub(crate) mod log;
/// `manifest.json`: program version, machine and timings. No result depends on it.
pub(crate) mod manifest;
/// Pictures and reports that replace their earlier versions.
pub(crate) mod own_output;
/// Atomic replacement of files.
pub(crate) mod replace;
/// Locked temporary files and directories.
pub(crate) mod temporary_file;

pub use bounded::read_text_file;
pub use identity::VALUES_VERSION;
