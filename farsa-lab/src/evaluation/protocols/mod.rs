//! `farsa test --protocol`: the champion in every case of a table.

/// Summaries of the trials of each case.
pub(crate) mod case_summary;
/// Files of a protocol's results in a run's directory.
pub(crate) mod files;
/// `farsa replay --protocol`: a trial of a case, step by step.
pub(crate) mod replay;
/// A champion in selected cases, for `draw` and `replay`.
pub(crate) mod selected_cases;
/// `farsa draw --protocol`: the end of a trial of each case, side by side.
pub(crate) mod sheet;
/// `protocols/NAME.states.csv`: neuron states of the first trials, step by step.
pub(crate) mod states;
/// `protocols/NAME.csv`: one line per trial, case after case.
pub(crate) mod table;
/// Command.
pub(crate) mod test;
/// A single trial of a protocol's case, step by step.
mod trial;
