//! Fitness, objectives and behavior of an experiment, as text and JSON.

use std::fmt::Write as _;

use serde::Serialize;

use crate::experiment::behavior::Behavior;
use crate::experiment::evaluator::TaskInfo;
use crate::experiment::outcome::{Combination, NO_CRITERION};
use crate::experiment::parameter::Parameter;
use crate::figures::significant::remark;

/// Success, objectives and measures of an experiment, with the names of its JSON.
#[derive(Serialize)]
pub(crate) struct BehaviourInfo {
    /// Combination of the trials into the fitness.
    combination: Option<Combination>,
    #[serde(skip)]
    combined: String,
    /// False without a criterion of success.
    has_success: bool,
    /// Objectives of multi-objective strategies, the fitness first.
    objectives: Vec<String>,
    /// Measures of behavior.
    #[serde(rename = "descriptors")]
    measures: Vec<MeasureInfo>,
}

/// A measure of behavior and its range.
#[derive(Serialize)]
struct MeasureInfo {
    name: String,
    range: [f64; 2],
}

impl BehaviourInfo {
    /// Describes the fitness of a task with its objectives and measures, if any.
    pub(crate) fn new(task: &TaskInfo, behaviour: Option<&dyn Behavior>) -> Self {
        let others = behaviour.map(Behavior::objectives).unwrap_or_default();
        let measures = behaviour.map(Behavior::measures).unwrap_or_default();
        let measure = |Parameter { name, ends }| MeasureInfo { name, range: ends };
        Self {
            combination: task.combination,
            combined: task.combined(),
            has_success: task.has_success,
            objectives: ["fitness".into()].into_iter().chain(others).collect(),
            measures: measures.into_iter().map(measure).collect(),
        }
    }

    /// Returns a line for the terms of the fitness with their combination, and lines for an absent criterion of success,
    /// objectives and measures.
    pub(crate) fn text(&self, terms: &[String]) -> String {
        let mut text = format!("fitness: {}{}\n", terms.join(", "), remark(&self.combined));
        if !self.has_success {
            let _ = writeln!(text, "success: {NO_CRITERION}");
        }
        // Writing to a string cannot fail.
        if self.objectives.len() > 1 {
            let _ = writeln!(text, "objectives: {}", self.objectives.join(", "));
        }
        if !self.measures.is_empty() {
            let named = self
                .measures
                .iter()
                .map(|MeasureInfo { name, range: [low, high] }| format!("{name} {low:?} to {high:?}"));
            let _ = writeln!(text, "behaviour: {}", named.collect::<Vec<_>>().join(", "));
        }
        text
    }
}
