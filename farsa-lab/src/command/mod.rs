//! The command `farsa` for any set of experiments.
//!
//! - `arguments`: the words of the command line
//! - `cli`: the command: `main` for any set of experiments
//! - `info`: `farsa list` and `farsa info`: what there is and what it is made of
//! - `interrupt`: signals that ask a run to stop, and the exit code that asks a scheduler to start it again
//! - `strategies`: `farsa strategies`: what a run can search with
//! - `manual`: what the command says about itself: help with examples, completions, and pages of the manual

mod arguments;
pub mod cli;
mod info;
mod interrupt;
mod manual;
mod strategies;
