//! What connects sensors with motors.

use std::collections::BTreeMap;

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use crate::document::blocks::{Blocks, leaks, slope};
use crate::document::evonet::Evonet;
use crate::name::NAME;

/// A network; its numbers of inputs and outputs follow from sensors and motors.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct Network {
    /// Weights and biases, from what the smallest gene stands for to what the largest does.
    #[serde(default = "weights")]
    #[schemars(inner(range(min = -1e6, max = 1e6)))]
    pub weights: [f64; 2],
    /// Parameters by their names that nothing searches for, with their values.
    #[serde(default)]
    pub fixed: BTreeMap<String, f64>,
    /// Lists of names of parameters that are always equal: one is searched for in the place of all.
    #[serde(default)]
    pub shared: Vec<Vec<String>>,
    /// What it is.
    #[serde(flatten)]
    pub kind: NetworkKind,
}

/// The kinds of networks. Neurons are logistic, with slope 1 where there is no other.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(tag = "kind", rename_all = "kebab-case")]
pub enum NetworkKind {
    /// One layer, without memory.
    Perceptron {
        /// In which order the genes are.
        #[serde(default)]
        order: WeightOrder,
    },
    /// A hidden layer, all linked to all, of neurons that are leaky integrators.
    Leaky {
        /// Hidden neurons.
        #[schemars(range(min = 1, max = 10000))]
        hidden: u32,
        /// Leaks, from what the smallest gene stands for to what the largest does.
        #[serde(default = "leaks")]
        #[schemars(inner(range(min = 0.0, max = 1.0)))]
        leaks: [f64; 2],
        /// Slope of the logistic function.
        #[serde(default = "slope")]
        #[schemars(range(min = 0.001, max = 1000.0))]
        slope: f64,
    },
    /// Wires from inputs to outputs, as they stand.
    Wired {
        /// What each output's sum begins with, in the order of the outputs.
        #[schemars(inner(range(min = -1e6, max = 1e6)))]
        bias: Vec<f64>,
        /// Whether other biases are searched for.
        #[serde(default)]
        search_bias: bool,
        /// What the sums become.
        #[serde(default)]
        activation: Activation,
        /// The wires, in the order in which they are added.
        wires: Vec<Wire>,
    },
    /// A continuous-time recurrent network, all linked to all; the last neurons are the outputs.
    Ctrnn {
        /// Neurons, outputs among them.
        #[schemars(range(min = 1, max = 10000))]
        neurons: u32,
        /// Time constants, from what the smallest gene stands for to what the largest does [s].
        #[schemars(inner(range(min = 0.0001, max = 10000.0)))]
        time_constants: [f64; 2],
    },
    /// Hidden layers one after the other, without memory.
    FeedForward {
        /// Hidden neurons.
        #[serde(default)]
        #[schemars(range(min = 0, max = 10000))]
        hidden: u32,
    },
    /// A hidden layer that hears itself a step later.
    Elman {
        /// Hidden neurons.
        #[schemars(range(min = 1, max = 10000))]
        hidden: u32,
    },
    /// A hidden layer that hears the outputs a step later.
    Jordan {
        /// Hidden neurons.
        #[schemars(range(min = 1, max = 10000))]
        hidden: u32,
    },
    /// Hidden neurons and outputs, which all hear each other a step later.
    FullyRecurrent {
        /// Hidden neurons.
        #[serde(default)]
        #[schemars(range(min = 0, max = 10000))]
        hidden: u32,
    },
    /// Clusters of neurons, and links between sensors, clusters and motors.
    Blocks(Blocks),
    /// The network of the original FARSA.
    Evonet(Evonet),
}

/// A wire of a network that is wired by hand: it adds to an output so many times the sum of some inputs.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct Wire {
    /// What settings and parameters call it; by default its number.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    #[schemars(regex(pattern = NAME))]
    pub name: Option<String>,
    /// Names of inputs, such as `light 1`, in the order in which they are added.
    pub from: Vec<String>,
    /// The name of an output, such as `wheels left`.
    pub to: String,
    /// What each input is multiplied by.
    #[schemars(range(min = -1e6, max = 1e6))]
    pub weight: f64,
    /// Whether another weight is searched for, between the ends of `weights`.
    #[serde(default)]
    pub searched: bool,
}

/// What the sum of an output becomes.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub enum Activation {
    /// Itself, cut at 0 and 1.
    #[default]
    Clamp,
    /// Its logistic function.
    Logistic,
}

/// In which order the genes of a perceptron are.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub enum WeightOrder {
    /// The weights input by input, then the biases.
    #[default]
    Inputs,
    /// The biases, then the weights output by output.
    Outputs,
}

fn weights() -> [f64; 2] {
    [-5.0, 5.0]
}
