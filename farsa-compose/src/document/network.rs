//! Networks.

use std::collections::BTreeMap;

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};
use serde_json::{Map, Value};

use crate::document::blocks::{Blocks, leaks};
use crate::document::evonet::Evonet;
use crate::document::one;
use crate::name::NAME;

/// A network, whose numbers of inputs and outputs follow from sensors and motors.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct Network {
    /// Range of weights and biases, from the smallest gene to the largest.
    #[serde(default = "weights")]
    #[schemars(inner(range(min = -1e6, max = 1e6)))]
    pub weights: [f64; 2],
    /// Fixed parameters, by name and value.
    #[serde(default)]
    pub fixed: BTreeMap<String, f64>,
    /// Lists of parameters with one common value.
    #[serde(default)]
    pub shared: Vec<Vec<String>>,
    /// The kind of network.
    #[serde(flatten)]
    pub kind: NetworkKind,
}

/// The kinds of networks. Neurons are logistic with slope 1 unless a key changes it.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(tag = "kind", rename_all = "kebab-case")]
pub enum NetworkKind {
    /// One layer without memory.
    Perceptron {
        /// Order of the genes.
        #[serde(default)]
        order: WeightOrder,
    },
    /// A fully connected hidden layer of leaky integrators.
    Leaky {
        /// Hidden neurons.
        #[schemars(range(min = 1, max = 10000))]
        hidden: u32,
        /// Range of leaks, from the smallest gene to the largest.
        #[serde(default = "leaks")]
        #[schemars(inner(range(min = 0.0, max = 1.0)))]
        leaks: [f64; 2],
        /// Slope of the logistic function.
        #[serde(default = "one")]
        #[schemars(range(min = 0.001, max = 1000.0))]
        slope: f64,
    },
    /// Wires from inputs to outputs.
    Wired {
        /// Biases of the outputs, in their order.
        #[schemars(inner(range(min = -1e6, max = 1e6)))]
        bias: Vec<f64>,
        /// Searches other biases.
        #[serde(default)]
        search_bias: bool,
        /// Activation function of the outputs.
        #[serde(default)]
        activation: Activation,
        /// Wires in the order of their addition.
        wires: Vec<Wire>,
    },
    /// A fully connected continuous-time recurrent network. The last neurons are the outputs.
    Ctrnn {
        /// Neurons including outputs.
        #[schemars(range(min = 1, max = 10000))]
        neurons: u32,
        /// Range of time constants, from the smallest gene to the largest [s].
        #[schemars(inner(range(min = 0.0001, max = 10000.0)))]
        time_constants: [f64; 2],
    },
    /// Feed-forward hidden layers without memory.
    FeedForward {
        /// Hidden neurons.
        #[serde(default)]
        #[schemars(range(min = 0, max = 10000))]
        hidden: u32,
    },
    /// A hidden layer with links to itself, delayed by one step.
    Elman {
        /// Hidden neurons.
        #[schemars(range(min = 1, max = 10000))]
        hidden: u32,
    },
    /// A hidden layer with links from the outputs, delayed by one step.
    Jordan {
        /// Hidden neurons.
        #[schemars(range(min = 1, max = 10000))]
        hidden: u32,
    },
    /// Hidden neurons and outputs with links among all of them, delayed by one step.
    FullyRecurrent {
        /// Hidden neurons.
        #[serde(default)]
        #[schemars(range(min = 0, max = 10000))]
        hidden: u32,
    },
    /// Clusters of neurons, and links between sensors, clusters and motors.
    Blocks(Blocks),
    /// The network of the 2013 program.
    Evonet(Evonet),
    /// A network of the user's program, with its keys.
    #[serde(untagged)]
    #[schemars(skip)]
    Registered {
        /// Registered name.
        kind: String,
        /// Keys.
        #[serde(flatten)]
        keys: Map<String, Value>,
    },
}

/// A wire that adds to an output the weighted sum of some inputs.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct Wire {
    /// Name for settings and parameters, by default the number.
    #[schemars(regex(pattern = NAME))]
    pub name: Option<String>,
    /// Names of inputs, such as `light 1`, in the order of addition.
    pub from: Vec<String>,
    /// Name of an output, such as `wheels left`.
    pub to: String,
    /// Factor of the inputs.
    #[schemars(range(min = -1e6, max = 1e6))]
    pub weight: f64,
    /// Searches another weight between the ends of `weights`.
    #[serde(default)]
    pub searched: bool,
}

/// Activation functions of outputs.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub enum Activation {
    /// Identity, clamped to 0 and 1.
    #[default]
    Clamp,
    /// Logistic function.
    Logistic,
}

/// Orders of the genes of a perceptron.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub enum WeightOrder {
    /// Weights input by input, then biases.
    #[default]
    Inputs,
    /// Biases, then weights output by output.
    Outputs,
}

fn weights() -> [f64; 2] {
    [-5.0, 5.0]
}
