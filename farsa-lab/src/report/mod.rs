//! A page about one or several runs.

/// Curves of a single run, or the median and quartiles of several.
mod curves;
/// Number of runs that generalize to held-out cases.
mod generalisation;
/// Moment at which runs are compared.
mod moment;
/// Medians, successes and comparisons of groups of runs.
pub(crate) mod outcome;
/// A page of headings, texts, tables and figures, as HTML or Markdown.
mod page;
/// Results of test protocols.
mod protocols;
/// A run as a report reads it.
mod run;
/// Curves of the tests of every n-th generation.
mod sampled;
/// Section about one experiment.
mod section;
/// Differences, complete tables and commands of configurations.
mod settings;
/// Success of the champions by kind of trial.
mod starts;
/// Internal states on their first two principal components.
mod states;
/// Values that strategies report, and the archives that they keep.
mod strategies;
/// A test protocol with its results in a run.
mod tested_protocol;
/// `farsa report`.
pub(crate) mod write;
