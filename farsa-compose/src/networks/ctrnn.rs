//! Networks in continuous time.

use farsa_lab::exports::NetworkExport;
use farsa_lab::{Error, Parameter};
use farsa_nn::{Controller as _, Ctrnn, CtrnnLayout, CtrnnParameter};
use farsa_view::{Channel, Links, NodeParameters, Schema};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use crate::networks::{around, numbered, single};
use crate::part::{NetworkEnds, NetworkPart, PartNetwork};

/// A fully connected continuous-time recurrent network. The last neurons are the outputs.
#[derive(Clone, Debug, Serialize, Deserialize, JsonSchema)]
pub(super) struct CtrnnPart {
    /// Neurons including outputs.
    #[schemars(range(min = 1, max = 10000))]
    neurons: u32,
    /// Range of time constants, from the smallest gene to the largest [s].
    #[schemars(inner(range(min = 0.0001, max = 10000.0)))]
    time_constants: [f64; 2],
}

/// A network in continuous time, whose gains are 1.
#[derive(Clone, Debug)]
pub(crate) struct CtrnnNetwork {
    pub(crate) network: Ctrnn<Vec<f32>, Vec<f32>>,
    /// Control step [s].
    time_step: f32,
}

around!(CtrnnNetwork, network);

impl PartNetwork for CtrnnNetwork {
    fn copy_parameters(&mut self, parameters: &[f32]) -> bool {
        self.network.copy_parameters(parameters).is_ok()
    }

    fn parameters(&self) -> &[f32] {
        self.network.parameters()
    }

    fn activations(&self) -> &[f32] {
        self.network.neuron_outputs()
    }

    fn export(&self) -> Option<NetworkExport> {
        let (layout, time_step) = (self.network.layout(), self.time_step);
        Some(NetworkExport::Ctrnn { layout, time_step, parameters: self.parameters().to_vec() })
    }

    fn load(&mut self, searched: &[f32]) -> bool {
        let layout = self.network.layout();
        searched.len() == count_searched(&layout) && self.copy_parameters(&with_gains(&layout, searched))
    }

    fn searched(&self, all: &[f64]) -> Vec<f64> {
        let kinds = self.network.layout().kinds().zip(all);
        kinds.filter(|(kind, _)| *kind != CtrnnParameter::Gain).map(|(_, value)| *value).collect()
    }

    fn memory(&self) -> usize {
        self.network.layout().state_len()
    }

    fn summary(&self) -> String {
        let neurons = self.network.layout().neurons();
        format!("{}-{}, {neurons} neurons in continuous time, all linked to all", self.inputs(), self.outputs())
    }

    fn first_output(&self) -> usize {
        self.network.layout().output_neurons().start
    }

    fn drawn(&self, schema: Schema) -> Schema {
        with_ctrnn(schema, &self.network.layout())
    }
}

impl NetworkPart for CtrnnPart {
    type Network = CtrnnNetwork;

    fn network(&self, ends: &NetworkEnds<'_>) -> Result<CtrnnNetwork, Error> {
        let ([inputs, outputs], neurons) = (ends.shape(), self.neurons as usize);
        if neurons < outputs {
            return Err(Error::Other(format!("{neurons} neurons where the motors want {outputs} outputs")));
        }
        let layout = CtrnnLayout::new(inputs, neurons, outputs);
        ends.text.check_network(layout.parameter_count(), layout.state_len())?;
        let time_step = ends.time_step as f32;
        let with = |time_constant: f64| {
            let parameters = with_gains(&layout, &vec![time_constant as f32; count_searched(&layout)]);
            Ctrnn::new(layout, time_step, parameters, vec![0.0; layout.state_len()])
        };
        // Both ends of the range must be valid.
        with(self.time_constants[1])?;
        Ok(CtrnnNetwork { network: with(self.time_constants[0])?, time_step })
    }

    fn parameters(&self, network: &CtrnnNetwork, ends: &NetworkEnds<'_>) -> Vec<Parameter> {
        let [weights, time_constants] = [ends.weights, self.time_constants].map(single);
        let layout = network.network.layout();
        let kinds = layout.kinds().filter(|kind| *kind != CtrnnParameter::Gain);
        numbered(kinds.map(|kind| match kind {
            CtrnnParameter::TimeConstant => ("time constant", time_constants),
            CtrnnParameter::Bias => ("bias", weights),
            CtrnnParameter::InputWeight => ("weight of an input", weights),
            _ => ("weight", weights),
        }))
    }
}

/// Counts the searched parameters: all except the gains.
fn count_searched(layout: &CtrnnLayout) -> usize {
    layout.parameter_count() - layout.neurons()
}

/// Returns all parameters from the searched ones, with gains of 1.
fn with_gains(layout: &CtrnnLayout, searched: &[f32]) -> Vec<f32> {
    let mut searched = searched.iter().copied();
    let parameter = |kind| if kind == CtrnnParameter::Gain { 1.0 } else { searched.next().unwrap_or(0.0) };
    layout.kinds().map(parameter).collect()
}

/// Sets the neurons and links of a network in continuous time. Every output is also a neuron.
fn with_ctrnn(schema: Schema, layout: &CtrnnLayout) -> Schema {
    let (inputs, neurons) = (layout.inputs(), layout.neurons());
    let nodes = [inputs, inputs + neurons];
    let first = |kind| layout.range(kind).start;
    let weighted = Links { from: [0, inputs], to: nodes, first: first(CtrnnParameter::InputWeight) };
    let recurrent = Links { from: nodes, to: nodes, first: first(CtrnnParameter::Weight) };
    let direct = layout.direct_inputs().into_iter().flatten().enumerate();
    let direct = direct.map(|(input, neuron)| [input, inputs + neuron]);
    let passed = layout.output_neurons().enumerate();
    let passed = passed.map(|(output, neuron)| [inputs + neuron, inputs + neurons + output]);
    let of_neurons = |name: &str, kind| NodeParameters { name: name.into(), nodes, first: first(kind) };
    let named = (1..=neurons).map(|neuron| Channel::new(&neuron.to_string()).group("neuron"));
    Schema {
        neurons: named.collect(),
        links: if layout.direct_inputs().is_some() { vec![recurrent] } else { vec![weighted, recurrent] },
        direct_links: direct.chain(passed).collect(),
        node_parameters: vec![
            of_neurons("bias", CtrnnParameter::Bias),
            of_neurons("gain", CtrnnParameter::Gain),
            of_neurons("time constant", CtrnnParameter::TimeConstant),
        ],
        ..schema
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn links_of_a_continuous_network_meet_every_parameter_once() {
        let plain = CtrnnLayout::new(3, 5, 2);
        for (layout, direct) in [(plain, 0), (plain.with_direct_inputs(1), 3)] {
            let bare = Schema::default().with_sensors(["a", "b", "c"]).with_outputs(["x", "y"]);
            let Schema { links, direct_links, node_parameters, neurons, .. } = with_ctrnn(bare, &layout);
            let mut seen = vec![0; layout.parameter_count()];
            for Links { from, to, first } in &links {
                (0..(from[1] - from[0]) * (to[1] - to[0])).for_each(|weight| seen[first + weight] += 1);
            }
            for NodeParameters { nodes, first, .. } in &node_parameters {
                (0..nodes[1] - nodes[0]).for_each(|node| seen[first + node] += 1);
            }
            assert_eq!((seen, neurons.len()), (vec![1; layout.parameter_count()], 5));
            // Inputs 0 to 2 go to the neurons 1 to 3, nodes 4 to 6. Outputs, nodes 8 and 9, are the last neurons.
            let inputs = [[0, 4], [1, 5], [2, 6]].into_iter().take(direct);
            assert_eq!(direct_links, inputs.chain([[6, 8], [7, 9]]).collect::<Vec<_>>());
        }
    }
}
