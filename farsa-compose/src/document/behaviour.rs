//! Objectives and measures of an individual in addition to its fitness.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// Objectives and measures for strategies that use more than the fitness: means over the trials of the terms, before
/// their weights.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(default)]
pub struct BehaviourOfTerms {
    /// Objectives in addition to the fitness, in this order.
    pub objectives: Vec<ObjectiveTerm>,
    /// Terms that describe a behavior.
    pub descriptors: Vec<DescriptorTerm>,
}

/// A term that is an objective.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct ObjectiveTerm {
    /// Name of the term.
    pub term: String,
    /// Lower values are better.
    #[serde(default)]
    pub less: bool,
}

/// A term that describes a behaviour.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct DescriptorTerm {
    /// Name of the term.
    pub term: String,
    /// The range that an archive divides. Values beyond it count as the nearest end.
    #[schemars(inner(range(min = -1e9, max = 1e9)))]
    pub range: [f64; 2],
}
