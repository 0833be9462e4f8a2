//! `farsa test --protocol`: the champion in every case of a table.
//!
//! - `files`: the files of a protocol's results in a run's directory
//! - `found`: what the trials of each case say together
//! - `table`: `protocols/NAME.csv`: a line per trial, case after case
//! - `test`: the command

pub(crate) mod files;
pub(crate) mod found;
pub(crate) mod table;
pub(crate) mod test;
