//! Lesions and noise of the test protocols.

use farsa_lab::advanced::{Intervention, Interventions, Protocol};
use farsa_nn::Ablatable as _;

use crate::document::{Document, Lesions, TestProtocol};
use crate::parts::network::AnyNetwork;
use crate::parts::network_spec::NetworkSpec;

/// Returns the protocols: those of the document, `lesions` of each sensor and neuron, unless the network has no
/// neurons, and `noise` on all inputs.
pub(crate) fn interventions(document: &Document, spec: &NetworkSpec, robots: usize) -> Interventions {
    let NetworkSpec { sensors, inputs, outputs, network, .. } = spec;
    let with = |protocols: Interventions, protocol: &TestProtocol| match protocol {
        TestProtocol::TeamSize => {
            let summary = "fewer robots than evolved together, without the others";
            let sizes = Protocol::from_list(TEAM_SIZE, summary, team_sizes(robots).iter().map(ToString::to_string));
            let all = robots.to_string();
            protocols.with_protocol(sizes.with_axes("robots", "").with_held_out(|robots, _| robots != all), Vec::new())
        }
        TestProtocol::Senses => {
            let cut =
                |(name, [first, end]): &(String, [usize; 2])| (format!("no {name}"), Intervention::cut(*first..*end));
            protocols.with_cases("senses", "one of the senses is cut", sensors.iter().map(cut))
        }
    };
    let protocols = document.protocols.iter().fold(Interventions::default(), with);
    let protocols = if document.lesions == Some(Lesions::Channels) {
        protocols.with_lesions(inputs.iter().enumerate().map(|(number, name)| (name, number..number + 1)), [])
    } else if network.neurons() == 0 {
        protocols
    } else {
        let sensors = sensors.iter().map(|(name, [first, end])| (name, *first..*end));
        protocols.with_lesions(sensors, neurons(network, outputs))
    };
    protocols.with_noise(&Interventions::NOISE)
}

/// Name of the protocol with fewer robots.
pub(crate) const TEAM_SIZE: &str = "team-size";

/// Returns the tested sizes of a team: 1, 2, 4 and so on up to all robots.
pub(crate) fn team_sizes(robots: usize) -> Vec<usize> {
    let doubled = std::iter::successors(Some(1_usize), |size| size.checked_mul(2));
    doubled.take_while(|size| *size < robots).chain([robots]).collect()
}

/// Names the neurons that can be silenced. Neurons of inputs are excluded, because a cut sensor silences them.
fn neurons(network: &AnyNetwork, outputs: &[String]) -> Vec<(String, usize)> {
    let (first, last) = (network.part().first_neuron(), network.part().first_output());
    let mut hidden = network.part().hidden_names().into_iter();
    let name = |neuron: usize| match neuron.checked_sub(last).and_then(|output| outputs.get(output)) {
        Some(output) => format!("output of {output}"),
        None => hidden.next().unwrap_or_else(|| format!("neuron {}", neuron + 1)),
    };
    (first..network.neurons()).map(name).zip(first..).collect()
}
