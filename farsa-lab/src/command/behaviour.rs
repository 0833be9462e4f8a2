//! What is said of an individual beside its fitness, in words and as JSON.

use std::fmt::Write as _;

use serde::Serialize;

use crate::experiment::behaviour::Behaviour;
use crate::experiment::parameter::Parameter;

/// The objectives and descriptors of an experiment; the JSON form has these names.
#[derive(Serialize)]
pub(crate) struct BehaviourInfo {
    /// For strategies of several objectives, the fitness first.
    objectives: Vec<String>,
    /// What behaviour is described by.
    descriptors: Vec<DescriptorInfo>,
}

/// A value that describes a behaviour, and its range.
#[derive(Serialize)]
struct DescriptorInfo {
    name: String,
    range: [f64; 2],
}

impl BehaviourInfo {
    /// Those of an experiment, which may have none.
    pub(crate) fn new(behaviour: Option<&dyn Behaviour>) -> Self {
        let others = behaviour.map(Behaviour::objectives).unwrap_or_default();
        let descriptors = behaviour.map(Behaviour::descriptors).unwrap_or_default();
        let descriptor = |Parameter { name, ends }| DescriptorInfo { name, range: ends };
        Self {
            objectives: ["fitness".into()].into_iter().chain(others).collect(),
            descriptors: descriptors.into_iter().map(descriptor).collect(),
        }
    }

    /// A line for each of the two, where there are any.
    pub(crate) fn text(&self) -> String {
        let mut text = String::new();
        // Writing into a string cannot fail.
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
