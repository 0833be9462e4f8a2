//! A page about one or many runs.
//!
//! - `curves`: the curves of a report: one run as it was, many as median and quartiles
//! - `generalisation`: how many runs follow what was held out of their evolution
//! - `moment`: when runs are compared: at a generation, or after as many evaluations where their generations differ in size
//! - `outcome`: what came of groups of runs: medians, how many succeeded, and whether the groups differ
//! - `page`: a page of headings, texts, tables and pictures, written as HTML or as Markdown
//! - `protocols`: what test protocols found: a table and a picture of each
//! - `run`: a run as a report reads it, and runs that differ in their seeds alone
//! - `section`: what a report says about the runs of one experiment
//! - `settings`: the configurations of the runs in a report: what differs, everything, and the commands that say it again
//! - `states`: the internal states of a test protocol on their first two principal components
//! - `strategies`: what strategies say of their generations beside the fitness, and what they keep
//! - `tested_protocol`: a test protocol as a run was tested by it
//! - `write`: `farsa report`: a page about one or many runs

mod curves;
mod generalisation;
mod moment;
pub(crate) mod outcome;
mod page;
mod protocols;
mod run;
mod section;
mod settings;
mod states;
mod strategies;
mod tested_protocol;
pub(crate) mod write;
