//! Objectives and behavior of an experiment, as text and JSON.

use std::fmt::Write as _;

use serde::Serialize;

use crate::experiment::behavior::Behavior;
use crate::experiment::parameter::Parameter;

/// The objectives and measures of an experiment, with the names of its JSON.
#[derive(Serialize)]
pub(crate) struct BehaviourInfo {
    /// The objectives of multi-objective strategies, the fitness first.
    objectives: Vec<String>,
    /// The measures of behavior.
    descriptors: Vec<DescriptorInfo>,
}

/// A measure of behavior and its range.
#[derive(Serialize)]
struct DescriptorInfo {
    name: String,
    range: [f64; 2],
}

impl BehaviourInfo {
    /// Returns the objectives and measures of an experiment, if any.
    pub(crate) fn new(behaviour: Option<&dyn Behavior>) -> Self {
        let others = behaviour.map(Behavior::objectives).unwrap_or_default();
        let descriptors = behaviour.map(Behavior::descriptors).unwrap_or_default();
        let descriptor = |Parameter { name, ends }| DescriptorInfo { name, range: ends };
        Self {
            objectives: ["fitness".into()].into_iter().chain(others).collect(),
            descriptors: descriptors.into_iter().map(descriptor).collect(),
        }
    }

    /// Returns a line for objectives and one for measures, where there are any.
    pub(crate) fn text(&self) -> String {
        let mut text = String::new();
        // Writing to a string cannot fail.
        if self.objectives.len() > 1 {
            let _ = writeln!(text, "objectives: {}", self.objectives.join(", "));
        }
        if !self.descriptors.is_empty() {
            let named = self
                .descriptors
                .iter()
                .map(|DescriptorInfo { name, range: [low, high] }| format!("{name} {low:?} to {high:?}"));
            let _ = writeln!(text, "behaviour: {}", named.collect::<Vec<_>>().join(", "));
        }
        text
    }
}
