//! Command `farsa` for any set of experiments.

/// Arguments of the command line.
mod arguments;
/// Objectives and behavior of an experiment, as text and JSON.
mod behaviour;
/// `--test` of `farsa run` and `farsa sweep`.
mod champion_test;
/// `farsa sweep` with a file of checks.
mod checks;
/// `main` for any set of experiments.
pub mod cli;
/// Connections of an experiment.
mod connections;
/// `farsa export`.
mod export;
/// `farsa new` and `farsa check`.
mod files;
/// `farsa run --from`.
mod from_page;
/// `farsa import`.
mod import;
/// `farsa list` and `farsa info`.
mod info;
/// Signals that stop a run, and the exit code with which a scheduler restarts it.
mod interrupt;
/// Name, experiments and ranks of a call of the command.
mod invocation;
/// `farsa lab`.
mod lab;
/// `farsa live` and `farsa serve`.
mod live;
/// Help with examples, completions and manual pages.
pub(crate) mod manual;
/// `farsa merge`.
mod merge;
/// Commands that continue after the end of a run.
mod next;
/// Command on several ranks.
mod on_ranks;
/// Generates docs/command.md.
#[cfg(test)]
mod reference;
/// `farsa replay`.
mod replay;
/// `farsa strategies`.
mod strategies;
/// `farsa sweep`.
mod sweep;
