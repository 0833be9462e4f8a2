//! The command `farsa` for any set of experiments.
//!
//! - `arguments`: the words of the command line
//! - `behaviour`: what is said of an individual beside its fitness
//! - `cli`: the command: `main` for any set of experiments
//! - `connections`: what is connected to what: sensors with inputs, outputs with motors, terms with the fitness
//! - `export`: `farsa export`: of what, and where to
//! - `files`: `farsa new` and `farsa check`: files that describe experiments
//! - `import`: `farsa import`: genotypes and configurations of the original FARSA
//! - `info`: `farsa list` and `farsa info`: what there is and what it is made of
//! - `interrupt`: signals that ask a run to stop, and the exit code that asks a scheduler to start it again
//! - `invocation`: the command as it was called
//! - `live`: `farsa live` and `farsa serve`
//! - `manual`: what the command says about itself: help with examples, completions, and pages of the manual
//! - `on_ranks`: the command on several ranks: what all do before and around what rank 0 does
//! - `replay`: `farsa replay`: trials of a run, or of a protocol's cases
//! - `strategies`: `farsa strategies`: what a run can search with

mod arguments;
mod behaviour;
pub mod cli;
mod connections;
mod export;
mod files;
mod import;
mod info;
mod interrupt;
mod invocation;
mod live;
pub(crate) mod manual;
mod on_ranks;
mod replay;
mod strategies;
