//! Objectives and behavior of an experiment, as text and JSON.

use std::fmt::Write as _;

use serde::Serialize;

use crate::experiment::behavior::Behavior;
use crate::experiment::parameter::Parameter;

/// Objectives and measures of an experiment, with the names of its JSON.
#[derive(Serialize)]
pub(crate) struct BehaviourInfo {
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
    /// Creates the objectives and measures of an experiment, if any.
    pub(crate) fn new(behaviour: Option<&dyn Behavior>) -> Self {
        let others = behaviour.map(Behavior::objectives).unwrap_or_default();
        let measures = behaviour.map(Behavior::measures).unwrap_or_default();
        let measure = |Parameter { name, ends }| MeasureInfo { name, range: ends };
        Self {
            objectives: ["fitness".into()].into_iter().chain(others).collect(),
            measures: measures.into_iter().map(measure).collect(),
        }
    }

    /// Returns a line for objectives and one for measures, where there are any.
    pub(crate) fn text(&self) -> String {
        let mut text = String::new();
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
