//! The files of a run.
//!
//! - `bounded`: files that are read with a bound on bytes and on waiting
//! - `directory`: the files of a run by name, and how a run's directory is made
//! - `draft`: files and directories before they have their names, and what processes that died have left of them
//! - `failures`: `failures.csv`: the evaluations that failed
//! - `growing`: files that grow at their end as a run goes on
//! - `identity`: what a run is: all that its results depend on
//! - `lineage`: `lineage.csv`: the parents of every individual, appended generation by generation
//! - `lock`: locks that keep processes out of each other's files
//! - `log`: `fitness.csv`: one line per finished generation
//! - `manifest`: `manifest.json`: what made a run, when and how fast; nothing in it changes a result
//! - `replace`: how files are written without ever being half written
//! - `sealed`: Files that tell whether they are whole: a kind, a format version, a length, the content and a checksum
//! - `toml_tokens`: how many tokens a TOML text has, and how many are read

pub(crate) mod bounded;
pub(crate) mod directory;
pub(crate) mod draft;
pub(crate) mod failures;
pub(crate) mod growing;
pub(crate) mod identity;
pub(crate) mod lineage;
pub(crate) mod lock;
pub(crate) mod log;
pub(crate) mod manifest;
pub(crate) mod replace;
pub(crate) mod sealed;
pub(crate) mod toml_tokens;

pub use bounded::read_text_file;
pub use identity::VALUES_VERSION;
pub use toml_tokens::limit_toml_tokens;
