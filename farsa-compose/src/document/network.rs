//! What connects sensors with motors.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// A network; its numbers of inputs and outputs follow from sensors and motors.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct Network {
    /// Weights and biases, from what the smallest gene stands for to what the largest does.
    #[serde(default = "weights")]
    #[schemars(inner(range(min = -1e6, max = 1e6)))]
    pub weights: [f64; 2],
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

fn leaks() -> [f64; 2] {
    [0.0, 1.0]
}

fn slope() -> f64 {
    1.0
}
