//! `farsa test --protocol`: the champion in every case of a table.
//!
//! - `chosen`: a champion in the cases that were chosen, for `draw` and `replay`
//! - `files`: the files of a protocol's results in a run's directory
//! - `found`: what the trials of each case say together
//! - `replay`: `farsa replay --protocol`: a trial of each of some cases, step by step
//! - `sheet`: `farsa draw --protocol`: how a trial of each case ends, side by side
//! - `states`: `protocols/NAME.states.csv`: what the neurons of the first trials were like, step by step
//! - `table`: `protocols/NAME.csv`: a line per trial, case after case
//! - `test`: the command
//! - `trial`: a single trial of a protocol's case, step by step

pub(crate) mod chosen;
pub(crate) mod files;
pub(crate) mod found;
pub(crate) mod replay;
pub(crate) mod sheet;
pub(crate) mod states;
pub(crate) mod table;
pub(crate) mod test;
mod trial;
