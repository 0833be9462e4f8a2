//! The network of the 2013 program.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use crate::document::yes;

/// Logistic neurons connected as in Evonet, the network of the 2013 program, with its order and reading of genes.
/// `.gen` files of that program are genotypes of this network.
///
/// The range of weights begins with the largest, `[5.0, -5.0]`, as in the source. A leak is the magnitude of its
/// gene's value divided by the largest weight, so both ends of the range mean a leak of 1.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[expect(clippy::struct_excessive_bools, reason = "each is a flag of the original's file")]
pub struct Evonet {
    /// Name of a network file of the 2013 program (`.net` or `.phe`) in the same folder. It replaces the keys below
    /// except the largest bias and gain.
    ///
    /// Parameters with a value and a mutation rate of 0 in a `.phe` file are fixed. All others are searched.
    pub file: Option<String>,
    /// Hidden neurons.
    #[serde(default)]
    #[schemars(range(min = 0, max = 1000))]
    pub hidden: u32,
    /// Kind of the hidden neurons.
    #[serde(default)]
    pub hidden_neurons: EvonetNeurons,
    /// Adds biases to hidden neurons.
    #[serde(default = "yes")]
    pub hidden_biases: bool,
    /// Adds biases to outputs.
    #[serde(default = "yes")]
    pub output_biases: bool,
    /// Links hidden neurons to each other with a delay of one step.
    #[serde(default)]
    pub recurrent_hidden: bool,
    /// Links outputs to each other with a delay of one step.
    #[serde(default)]
    pub recurrent_outputs: bool,
    /// Links inputs to outputs in addition to the hidden neurons. Always true without hidden neurons.
    #[serde(default)]
    pub direct: bool,
    /// Adds leaks to outputs.
    #[serde(default)]
    pub output_leaks: bool,
    /// Largest bias.
    #[serde(default = "five")]
    #[schemars(range(min = 0.0, max = 1e6))]
    pub largest_bias: f64,
    /// Largest gain of neurons with gains in a file.
    #[serde(default = "five")]
    #[schemars(range(min = 0.0, max = 1e6))]
    pub largest_gain: f64,
}

/// Kinds of hidden neurons of the 2013 program.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub enum EvonetNeurons {
    /// Logistic.
    #[default]
    Logistic,
    /// Logistic, each with a leak.
    Leaky,
    /// 1 for a net input of at least 0, and 0 below.
    Binary,
}

fn five() -> f64 {
    5.0
}
