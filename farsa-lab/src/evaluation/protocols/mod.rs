//! `farsa test --protocol`: the champion in every case of a table.
//!
//! - `files`: the files of a protocol's results in a run's directory
//! - `found`: what the trials of each case say together
//! - `sheet`: `farsa draw --protocol`: how a trial of each case ends, side by side
//! - `states`: `protocols/NAME.states.csv`: what the neurons of the first trials were like, step by step
//! - `table`: `protocols/NAME.csv`: a line per trial, case after case
//! - `test`: the command
//! - `trial`: a single trial of a protocol's case, step by step

pub(crate) mod files;
pub(crate) mod found;
pub(crate) mod sheet;
pub(crate) mod states;
pub(crate) mod table;
pub(crate) mod test;
mod trial;
