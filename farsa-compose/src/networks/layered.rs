//! Layers and delayed links.

use farsa_lab::{Error, Parameter};
use farsa_nn::block::{Architecture, BlockParameter};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use crate::networks::blocks::BlocksNetwork;
use crate::networks::{numbered, single};
use crate::part::{NetworkEnds, NetworkPart};

/// Feed-forward hidden layers without memory.
#[derive(Clone, Debug, Serialize, Deserialize, JsonSchema)]
pub(super) struct FeedForward {
    /// Hidden neurons.
    #[serde(default)]
    #[schemars(range(min = 0, max = 10000))]
    hidden: u32,
}

/// A hidden layer with links to itself, delayed by one step.
#[derive(Clone, Debug, Serialize, Deserialize, JsonSchema)]
pub(super) struct Elman {
    /// Hidden neurons.
    #[schemars(range(min = 1, max = 10000))]
    hidden: u32,
}

/// A hidden layer with links from the outputs, delayed by one step.
#[derive(Clone, Debug, Serialize, Deserialize, JsonSchema)]
pub(super) struct Jordan {
    /// Hidden neurons.
    #[schemars(range(min = 1, max = 10000))]
    hidden: u32,
}

/// Hidden neurons and outputs with links among all of them, delayed by one step.
#[derive(Clone, Debug, Serialize, Deserialize, JsonSchema)]
pub(super) struct FullyRecurrent {
    /// Hidden neurons.
    #[serde(default)]
    #[schemars(range(min = 0, max = 10000))]
    hidden: u32,
}

macro_rules! layered {
    ($($name:ident, $architecture:ident;)*) => {
        $(impl NetworkPart for $name {
            type Network = BlocksNetwork;

            fn network(&self, ends: &NetworkEnds<'_>) -> Result<BlocksNetwork, Error> {
                let [inputs, outputs] = ends.shape();
                let architecture = Architecture::$architecture(inputs, self.hidden as usize, outputs);
                BlocksNetwork::new(architecture.plan().into(), Vec::new(), ends)
            }

            fn parameters(&self, network: &BlocksNetwork, ends: &NetworkEnds<'_>) -> Vec<Parameter> {
                parameters(network, single(ends.weights))
            }
        })*
    };
}
layered! {
    FeedForward, feed_forward;
    Elman, elman;
    Jordan, jordan;
    FullyRecurrent, fully_recurrent;
}

fn parameters(network: &BlocksNetwork, weights: [f64; 2]) -> Vec<Parameter> {
    numbered(network.network.layout().kinds().map(|kind| match kind {
        BlockParameter::Leak => ("leak", [0.0, 1.0]),
        BlockParameter::Bias => ("bias", weights),
        BlockParameter::Gain => ("gain", weights),
        _ => ("weight", weights),
    }))
}
