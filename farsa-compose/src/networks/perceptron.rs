//! One layer.

use farsa_lab::exports::NetworkExport;
use farsa_lab::{Error, Parameter};
use farsa_nn::{Controller as _, Perceptron};
use farsa_view::{Links, NodeParameters, Schema};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use crate::networks::{around, single};
use crate::part::{NetworkEnds, NetworkPart, PartNetwork};

/// One layer without memory.
#[derive(Clone, Debug, Serialize, Deserialize, JsonSchema)]
pub(super) struct PerceptronPart {
    /// Order of the genes.
    #[serde(default)]
    order: WeightOrder,
}

/// Orders of the genes of a perceptron.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
enum WeightOrder {
    /// Weights input by input, then biases.
    #[default]
    Inputs,
    /// Biases, then weights output by output.
    Outputs,
}

/// A perceptron with the order in which a search has its parameters.
#[derive(Clone, Debug)]
pub(crate) struct PerceptronNetwork {
    pub(crate) layer: Perceptron<Vec<f32>>,
    order: WeightOrder,
}

around!(PerceptronNetwork, layer);

impl PerceptronNetwork {
    /// Returns the index of each searched parameter among all.
    fn order(&self) -> impl Iterator<Item = usize> + use<> {
        let (inputs, outputs, order) = (self.layer.inputs(), self.layer.outputs(), self.order);
        let count = Perceptron::parameter_count(inputs, outputs);
        // Biases are the last parameters.
        let by_output = move |number: usize| match number.checked_sub(outputs) {
            None => inputs * outputs + number,
            Some(weight) => weight % inputs.max(1) * outputs + weight / inputs.max(1),
        };
        (0..count).map(move |number| if order == WeightOrder::Inputs { number } else { by_output(number) })
    }
}

impl PartNetwork for Perceptron<Vec<f32>> {
    fn copy_parameters(&mut self, parameters: &[f32]) -> bool {
        let made = Perceptron::new(self.inputs(), self.outputs(), self.slope(), parameters.to_vec());
        made.map(|made| *self = made).is_ok()
    }

    fn parameters(&self) -> &[f32] {
        Self::parameters(self)
    }

    fn activations(&self) -> &[f32] {
        &[]
    }

    fn export(&self) -> Option<NetworkExport> {
        Some(NetworkExport::Perceptron {
            inputs: self.inputs(),
            outputs: self.outputs(),
            slope: self.slope(),
            parameters: Self::parameters(self).to_vec(),
        })
    }

    fn memory(&self) -> usize {
        0
    }

    fn summary(&self) -> String {
        format!("{}-{}, one layer of logistic units without memory", self.inputs(), self.outputs())
    }

    fn drawn(&self, schema: Schema) -> Schema {
        let (x, y) = (self.inputs(), self.inputs() + self.outputs());
        Schema {
            links: vec![Links { from: [0, x], to: [x, y], first: 0 }],
            node_parameters: vec![NodeParameters { name: "bias".into(), nodes: [x, y], first: x * (y - x) }],
            ..schema
        }
    }
}

impl PartNetwork for PerceptronNetwork {
    fn copy_parameters(&mut self, parameters: &[f32]) -> bool {
        PartNetwork::copy_parameters(&mut self.layer, parameters)
    }

    fn parameters(&self) -> &[f32] {
        self.layer.parameters()
    }

    fn activations(&self) -> &[f32] {
        self.layer.activations()
    }

    fn export(&self) -> Option<NetworkExport> {
        self.layer.export()
    }

    fn load(&mut self, searched: &[f32]) -> bool {
        if searched.len() != self.parameters().len() {
            return false;
        }
        let mut all = vec![0.0; searched.len()];
        self.order().zip(searched).for_each(|(index, value)| all[index] = *value);
        self.copy_parameters(&all)
    }

    fn searched(&self, all: &[f64]) -> Vec<f64> {
        self.order().filter_map(|index| all.get(index).copied()).collect()
    }

    fn memory(&self) -> usize {
        self.layer.memory()
    }

    fn summary(&self) -> String {
        self.layer.summary()
    }

    fn drawn(&self, schema: Schema) -> Schema {
        self.layer.drawn(schema)
    }
}

impl NetworkPart for PerceptronPart {
    type Network = PerceptronNetwork;

    fn network(&self, ends: &NetworkEnds<'_>) -> Result<PerceptronNetwork, Error> {
        let [inputs, outputs] = ends.shape();
        let count = Perceptron::parameter_count(inputs, outputs);
        ends.text.check_network(count, 0)?;
        Ok(PerceptronNetwork { layer: Perceptron::new(inputs, outputs, 1.0, vec![0.0; count])?, order: self.order })
    }

    fn parameters(&self, _: &PerceptronNetwork, ends: &NetworkEnds<'_>) -> Vec<Parameter> {
        let (NetworkEnds { inputs, outputs, .. }, range) = (ends, single(ends.weights));
        let weight = |input: &String, output: &String| Parameter::new(format!("weight of {input} on {output}"), range);
        let biases = outputs.iter().map(|output| Parameter::new(format!("bias of {output}"), range));
        match self.order {
            WeightOrder::Inputs => {
                inputs.iter().flat_map(|x| outputs.iter().map(move |y| weight(x, y))).chain(biases).collect()
            }
            WeightOrder::Outputs => {
                biases.chain(outputs.iter().flat_map(|y| inputs.iter().map(move |x| weight(x, y)))).collect()
            }
        }
    }
}
