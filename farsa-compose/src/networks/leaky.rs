//! Hidden layers of leaky integrators.

use farsa_lab::advanced::{OwnedNetwork, resting_network};
use farsa_lab::exports::NetworkExport;
use farsa_lab::{Error, Parameter};
use farsa_nn::{Controller as _, Leak, LeakyLayout, LeakyParameter};
use farsa_view::Schema;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use crate::networks::single;
use crate::part::{NetworkEnds, NetworkPart, PartNetwork};

/// A fully connected hidden layer of leaky integrators.
#[derive(Clone, Debug, Serialize, Deserialize, JsonSchema)]
pub(super) struct Leaky {
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
}

fn leaks() -> [f64; 2] {
    [0.0, 1.0]
}

fn one() -> f64 {
    1.0
}

impl PartNetwork for OwnedNetwork {
    fn copy_parameters(&mut self, parameters: &[f32]) -> bool {
        Self::copy_parameters(self, parameters).is_ok()
    }

    fn parameters(&self) -> &[f32] {
        Self::parameters(self)
    }

    /// Gets the activations of hidden neurons only.
    fn activations(&self) -> &[f32] {
        self.hidden()
    }

    fn export(&self) -> Option<NetworkExport> {
        Some(NetworkExport::leaky(&self.layout(), Leak::Filter, Self::parameters(self)))
    }

    fn memory(&self) -> usize {
        self.layout().state_len()
    }

    fn summary(&self) -> String {
        let [inputs, hidden, outputs] = [self.inputs(), self.layout().hidden(), self.outputs()];
        format!("{inputs}-{hidden}-{outputs}, recurrent hidden layer, leaks as filters")
    }

    fn drawn(&self, schema: Schema) -> Schema {
        schema.with_network(&self.layout())
    }
}

impl NetworkPart for Leaky {
    type Network = OwnedNetwork;

    fn network(&self, ends: &NetworkEnds<'_>) -> Result<OwnedNetwork, Error> {
        let [inputs, outputs] = ends.shape();
        let layout = LeakyLayout::new(inputs, self.hidden as usize, outputs).with_slope(self.slope as f32);
        ends.text.check_network(layout.parameter_count(), layout.state_len())?;
        resting_network(&layout)
    }

    fn parameters(&self, network: &OwnedNetwork, ends: &NetworkEnds<'_>) -> Vec<Parameter> {
        let layout = network.layout();
        let (hidden, outputs) = (layout.hidden().max(1), layout.outputs().max(1));
        let [weights, leaks] = [ends.weights, self.leaks].map(single);
        let of_kind = |kind: LeakyParameter| {
            let name = move |index: usize| match kind {
                LeakyParameter::SensorWeight => {
                    format!("weight of {} on neuron {}", ends.inputs[index / hidden], index % hidden + 1)
                }
                LeakyParameter::RecurrentWeight => {
                    format!("weight of neuron {} on neuron {}", index / hidden + 1, index % hidden + 1)
                }
                LeakyParameter::OutputWeight => {
                    format!("weight of neuron {} on {}", index / outputs + 1, ends.outputs[index % outputs])
                }
                LeakyParameter::Bias => format!("bias of neuron {}", index + 1),
                _ => format!("leak of neuron {}", index + 1),
            };
            let range = if kind == LeakyParameter::Leak { leaks } else { weights };
            (0..layout.range(kind).len()).map(move |index| Parameter::new(name(index), range))
        };
        LeakyParameter::ALL.into_iter().flat_map(of_kind).collect()
    }
}
