//! The network of the original FARSA.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use crate::document::yes;

/// Logistic neurons as the original's Evonet connects them, with genes in its order and with its meaning: `.gen` files of the
/// original are genotypes of it.
///
/// The range of weights goes from the largest down, `[5.0, -5.0]`, as there. A leak is the size of its gene's number as a share
/// of the largest weight, so that both ends of the range are a leak of 1.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[expect(clippy::struct_excessive_bools, reason = "each is a flag of the original's file")]
pub struct Evonet {
    /// A file in which the original keeps a network, `.net` or `.phe`, beside this one; it says what the keys below say, but for
    /// the largest bias and gain.
    ///
    /// All parameters are searched for but those to which a `.phe` file gives a number with a mutation rate of 0, which keep it.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub file: Option<String>,
    /// Hidden neurons.
    #[serde(default)]
    #[schemars(range(min = 0, max = 1000))]
    pub hidden: u32,
    /// What hidden neurons are.
    #[serde(default)]
    pub hidden_neurons: EvonetNeurons,
    /// Whether hidden neurons have biases.
    #[serde(default = "yes")]
    pub hidden_biases: bool,
    /// Whether outputs have biases.
    #[serde(default = "yes")]
    pub output_biases: bool,
    /// Whether hidden neurons hear each other a step later.
    #[serde(default)]
    pub recurrent_hidden: bool,
    /// Whether outputs hear each other a step later.
    #[serde(default)]
    pub recurrent_outputs: bool,
    /// Whether outputs hear the inputs beside the hidden neurons; without hidden neurons they do.
    #[serde(default)]
    pub direct: bool,
    /// Whether outputs have leaks.
    #[serde(default)]
    pub output_leaks: bool,
    /// The largest bias.
    #[serde(default = "largest_bias")]
    #[schemars(range(min = 0.0, max = 1e6))]
    pub largest_bias: f64,
    /// The largest gain, of neurons that have gains in a file.
    #[serde(default = "largest_gain")]
    #[schemars(range(min = 0.0, max = 1e6))]
    pub largest_gain: f64,
}

/// What the hidden neurons of the original's network are.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub enum EvonetNeurons {
    /// Logistic.
    #[default]
    Logistic,
    /// Logistic, with a leak each.
    Leaky,
    /// 1 for a net input of at least 0, and 0 below.
    Binary,
}

fn largest_bias() -> f64 {
    5.0
}

fn largest_gain() -> f64 {
    5.0
}
