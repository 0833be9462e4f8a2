//! Networks.

use std::collections::BTreeMap;

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use crate::document::registered::NetworkKind;

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

fn weights() -> [f64; 2] {
    [-5.0, 5.0]
}
