//! Lesions and noise of the test protocols.

use farsa_lab::advanced::Interventions;
use farsa_nn::Ablatable as _;

use crate::document::{Document, Lesions, Network, NetworkKind};
use crate::parts::blocks;
use crate::parts::network::AnyNetwork;
use crate::parts::network_spec::NetworkSpec;

/// Returns the protocols: `lesions` of each sensor and neuron, unless the network has no neurons, and `noise` on all
/// inputs.
pub(crate) fn interventions(document: &Document, spec: &NetworkSpec) -> Interventions {
    let NetworkSpec { sensors, inputs, outputs, network, .. } = spec;
    let protocols = Interventions::default();
    let protocols = if document.lesions == Some(Lesions::Channels) {
        protocols.with_lesions(inputs.iter().enumerate().map(|(number, name)| (name, number..number + 1)), [])
    } else if network.neurons() == 0 {
        protocols
    } else {
        let sensors = sensors.iter().map(|(name, [first, end])| (name, *first..*end));
        protocols.with_lesions(sensors, neurons(&document.network, network, inputs.len(), outputs))
    };
    protocols.with_noise(&Interventions::NOISE)
}

/// Names the neurons that can be silenced. Neurons of inputs are excluded, because a cut sensor silences them.
fn neurons(network: &Network, own: &AnyNetwork, inputs: usize, outputs: &[String]) -> Vec<(String, usize)> {
    let first = match own {
        AnyNetwork::Block(_) | AnyNetwork::Evonet(_) => inputs,
        _ => 0,
    };
    let last = first_output(own, outputs.len());
    let mut clusters = match &network.kind {
        NetworkKind::Blocks(blocks) => blocks::cluster_neurons(blocks),
        _ => Vec::new(),
    }
    .into_iter();
    let name = |neuron: usize| match neuron.checked_sub(last).and_then(|output| outputs.get(output)) {
        Some(output) => format!("output of {output}"),
        None => clusters.next().unwrap_or_else(|| format!("neuron {}", neuron + 1)),
    };
    (first..own.neurons()).map(name).zip(first..).collect()
}

/// Returns the number of the first output neuron.
pub(crate) fn first_output(network: &AnyNetwork, outputs: usize) -> usize {
    match network {
        AnyNetwork::Ctrnn(ctrnn) => ctrnn.layout().output_neurons().start,
        _ => network.neurons().saturating_sub(outputs),
    }
}
