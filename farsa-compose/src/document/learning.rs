//! Learning from demonstrations.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// Learning from demonstrations by back-propagation through time, for the strategy `learning`. Gradients with a norm
/// above 1 are scaled down to 1, and no weight or bias exceeds the largest magnitude of `network.weights`.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct Learning {
    /// CSV files in the folder of the experiment's file, as `farsa replay RUN --out FILE` writes them. The columns
    /// `sensor.NAME` and `output.NAME` are the channels, and each `trial` is a demonstration. The log counts one as a
    /// success before an iteration if its root mean squared error of motor values is at most 0.1.
    #[schemars(length(min = 1, max = 16))]
    pub demonstrations: Vec<String>,
    /// Cost of a motor value.
    #[serde(default)]
    pub loss: LossName,
    /// Number of times that a generation uses each demonstration.
    #[serde(default = "epochs")]
    #[schemars(range(min = 1, max = 10000))]
    pub epochs: u32,
    /// Demonstrations in a gradient step.
    #[serde(default = "batch")]
    #[schemars(range(min = 1, max = 10000))]
    pub batch: u32,
    /// Learning rate of Adam.
    #[serde(default = "rate")]
    #[schemars(range(min = 1e-9, max = 1.0))]
    pub rate: f64,
    /// Largest magnitude of first weights and biases.
    #[serde(default = "first")]
    #[schemars(range(min = 0.0, max = 100.0))]
    pub first: f64,
}

/// Costs of a motor value `O` with target `T`.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub enum LossName {
    /// Squared error `(O - T)^2`.
    #[default]
    SquaredError,
    /// Cross entropy, for logistic outputs.
    CrossEntropy,
}

fn epochs() -> u32 {
    10
}

fn batch() -> u32 {
    1
}

fn rate() -> f64 {
    0.01
}

fn first() -> f64 {
    0.5
}
