//! What the test protocols do to a network.

use farsa_lab::Interventions;
use farsa_nn::{Ablatable, Controller as _, Lesion};

use crate::document::{Network, NetworkKind};
use crate::parts::blocks;
use crate::parts::network::AnyNetwork;
use crate::parts::wiring::Wiring;

/// The protocols of robots: `lesions`, in which each sensor is cut and each neuron silent, unless the network has no neurons,
/// and `noise` on all inputs.
pub(crate) fn interventions(network: &Network, wiring: &Wiring) -> Interventions {
    let Wiring { sensors, inputs, outputs, network: own, .. } = wiring;
    let all = Interventions::default();
    let all = if own.neurons() == 0 {
        all
    } else {
        let sensors = sensors.iter().map(|(name, [first, end])| (name, *first..*end));
        all.with_lesions(sensors, neurons(network, own, inputs.len(), outputs))
    };
    all.with_noise(&Interventions::NOISE)
}

/// The neurons that can be silent, by their names: none that stands for an input, which is cut as one.
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

/// The number of the first of so many output neurons.
pub(crate) fn first_output(network: &AnyNetwork, outputs: usize) -> usize {
    match network {
        AnyNetwork::Ctrnn(ctrnn) => ctrnn.layout().output_neurons().start,
        _ => network.neurons().saturating_sub(outputs),
    }
}

/// Neurons are those of the network that it is; one that is wired by hand has none.
impl Ablatable for AnyNetwork {
    fn neurons(&self) -> usize {
        match self {
            Self::Perceptron(layer, _) => layer.neurons(),
            Self::Leaky(leaky) => leaky.neurons(),
            Self::Ctrnn(ctrnn) => ctrnn.neurons(),
            Self::Block(block) => block.neurons(),
            Self::Wired(_) => 0,
            Self::Evonet(evonet) => evonet.network.neurons(),
        }
    }

    fn step_ablated(&mut self, lesions: &[Lesion], x: &[f32], y: &mut [f32]) {
        match self {
            Self::Perceptron(layer, _) => layer.step_ablated(lesions, x, y),
            Self::Leaky(leaky) => leaky.step_ablated(lesions, x, y),
            Self::Ctrnn(ctrnn) => ctrnn.step_ablated(lesions, x, y),
            Self::Block(block) => block.step_ablated(lesions, x, y),
            Self::Wired(wired) => wired.step(x, y),
            Self::Evonet(evonet) => evonet.network.step_ablated(lesions, x, y),
        }
    }
}
