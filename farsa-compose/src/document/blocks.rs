//! A network of clusters of neurons and links between them.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use crate::document::yes;
use crate::name::NAME;

/// Clusters of neurons, and links between sensors, clusters and motors.
///
/// In a step the clusters are computed in the order in which they stand here, then the outputs, which drive the motors, together.
/// A link from a cluster further down, from the cluster itself or from motors brings what they were after the step before.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct Blocks {
    /// Clusters of neurons, in the order in which they are computed.
    #[serde(default)]
    pub clusters: Vec<Cluster>,
    /// Links, in the order in which a sum adds them.
    pub links: Vec<Link>,
    /// Leaks, from what the smallest gene stands for to what the largest does.
    #[serde(default = "leaks")]
    #[schemars(inner(range(min = 0.0, max = 1.0)))]
    pub leaks: [f64; 2],
    /// Whether outputs have biases.
    #[serde(default = "yes")]
    pub output_biases: bool,
    /// Whether outputs are leaky integrators.
    #[serde(default)]
    pub output_leaks: bool,
}

/// Neurons that are alike.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct Cluster {
    /// What links, settings and parameters call it.
    #[schemars(regex(pattern = NAME))]
    pub name: String,
    /// How many neurons there are.
    #[schemars(range(min = 1, max = 10000))]
    pub neurons: u32,
    /// What the neurons make of their sums.
    #[serde(default)]
    pub activation: ClusterActivation,
    /// What a sum is multiplied by before.
    #[serde(default = "slope")]
    #[schemars(range(min = 0.001, max = 1000.0))]
    pub slope: f64,
    /// Whether each neuron has a bias.
    #[serde(default = "yes")]
    pub biases: bool,
    /// Whether the neurons are leaky integrators.
    #[serde(default)]
    pub leaks: bool,
}

/// What the neurons of a cluster make of their sums; all are bounded.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub enum ClusterActivation {
    /// The logistic function, 0 to 1.
    #[default]
    Logistic,
    /// The hyperbolic tangent, -1 to 1.
    Tanh,
    /// 1 for a sum of at least 0, and 0 below.
    Step,
}

/// A link: a weight from every neuron of one end to every neuron of the other.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct Link {
    /// The name of a sensor, cluster or motor; `sensors` and `motors` are all of these.
    pub from: String,
    /// The name of a cluster or motor; `motors` are all of these.
    pub to: String,
    /// So many steps later than without [steps].
    #[serde(default)]
    #[schemars(range(min = 0, max = 1000))]
    pub delay: u32,
}

/// The default range of leaks.
pub(super) fn leaks() -> [f64; 2] {
    [0.0, 1.0]
}

/// The default slope.
pub(super) fn slope() -> f64 {
    1.0
}
