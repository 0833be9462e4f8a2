//! What there is to say of an individual beside its fitness.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// What strategies with several objectives or with an archive look at beside the fitness: means over the trials of what terms
/// measure, before their weights.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(default)]
pub struct BehaviourOfTerms {
    /// Objectives beside the fitness, in their order.
    pub objectives: Vec<ObjectiveTerm>,
    /// What tells behaviours apart.
    pub descriptors: Vec<DescriptorTerm>,
}

/// A term that is an objective.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct ObjectiveTerm {
    /// Its name.
    pub term: String,
    /// Whether less is better.
    #[serde(default)]
    pub less: bool,
}

/// A term that describes a behaviour.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct DescriptorTerm {
    /// Its name.
    pub term: String,
    /// The range that an archive divides; a value beyond it counts as the nearest end.
    #[schemars(inner(range(min = -1e9, max = 1e9)))]
    pub range: [f64; 2],
}
