//! A network of clusters of neurons and links between them.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use crate::document::{one, yes};
use crate::name::NAME;

/// Clusters of neurons, and links between sensors, clusters and motors.
///
/// A step computes the clusters in the order of this list, then all outputs together, which drive the motors.
///
/// A link from a later cluster, from the cluster itself or from motors carries the values of the previous step.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct Blocks {
    /// Clusters of neurons, in the order in which they are computed.
    #[serde(default)]
    pub clusters: Vec<Cluster>,
    /// Links, in the order in which a sum adds them.
    pub links: Vec<Link>,
    /// Range of leaks, from the smallest gene to the largest.
    #[serde(default = "leaks")]
    #[schemars(inner(range(min = 0.0, max = 1.0)))]
    pub leaks: [f64; 2],
    /// Adds a bias to each output.
    #[serde(default = "yes")]
    pub output_biases: bool,
    /// Makes outputs leaky integrators.
    #[serde(default)]
    pub output_leaks: bool,
}

/// A group of equal neurons.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct Cluster {
    /// Name for links, settings and parameters.
    #[schemars(regex(pattern = NAME))]
    pub name: String,
    /// Number of neurons.
    #[schemars(range(min = 1, max = 10000))]
    pub neurons: u32,
    /// Activation function of the neurons.
    #[serde(default)]
    pub activation: ClusterActivation,
    /// Factor of the net input.
    #[serde(default = "one")]
    #[schemars(range(min = 0.001, max = 1000.0))]
    pub slope: f64,
    /// Adds a bias to each neuron.
    #[serde(default = "yes")]
    pub biases: bool,
    /// Makes the neurons leaky integrators.
    #[serde(default)]
    pub leaks: bool,
}

/// Activation functions, all of them bounded.
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

/// A link with a weight from every neuron of one end to every neuron of the other.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct Link {
    /// Name of a sensor, cluster or motor. `sensors` and `motors` refer to all of them.
    pub from: String,
    /// Name of a cluster or motor. `motors` refers to all motors.
    pub to: String,
    /// Additional delay [steps].
    #[serde(default)]
    #[schemars(range(min = 0, max = 1000))]
    pub delay: u32,
}

pub(super) fn leaks() -> [f64; 2] {
    [0.0, 1.0]
}
