//! The files of a run.
//!
//! - `bounded`: files read with a bound on their bytes and on the time waited for them
//! - `directory`: the files of a run, and how they are replaced without ever being half written
//! - `identity`: what a run is: all that its results depend on
//! - `lineage`: `lineage.csv`: the parents of every individual, appended generation by generation
//! - `log`: `fitness.csv`: one line per finished generation, appended and never rewritten
//! - `manifest`: `manifest.json`: what made a run, when and how fast; nothing in it changes a result
//! - `sealed`: Files that tell whether they are whole: a kind, a format version, a length, the content and a checksum

pub(crate) mod bounded;
pub(crate) mod directory;
pub(crate) mod identity;
pub(crate) mod lineage;
pub(crate) mod log;
pub(crate) mod manifest;
pub(crate) mod sealed;

pub use bounded::read_text_file;
pub use identity::VALUES_VERSION;
