//! Clusters and links.

use std::sync::Arc;

use farsa_lab::exports::NetworkExport;
use farsa_lab::{Error, Parameter};
use farsa_nn::block::{Block, BlockLayout, BlockLayoutBuf, BlockNetwork, BlockParameter, Group, Span};
use farsa_nn::{Activation, Controller as _, Leak};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use crate::name::NAME;
use crate::networks::static_layout::static_layout;
use crate::networks::{around, single};
use crate::part::{NetworkEnds, NetworkPart, PartNetwork};

/// Clusters of neurons, and links between sensors, clusters and motors.
///
/// A step computes the clusters in the order of this list, then all outputs together, which drive the motors.
///
/// A link from a later cluster, from the cluster itself or from motors carries the values of the previous step.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
pub(super) struct Blocks {
    /// Clusters of neurons, in the order in which they are computed.
    #[serde(default)]
    clusters: Vec<Cluster>,
    /// Links, in the order in which a sum adds them.
    links: Vec<Link>,
    /// Range of leaks, from the smallest gene to the largest.
    #[serde(default = "leaks")]
    #[schemars(inner(range(min = 0.0, max = 1.0)))]
    leaks: [f64; 2],
    /// Adds a bias to each output.
    #[serde(default = "yes")]
    output_biases: bool,
    /// Makes outputs leaky integrators.
    #[serde(default)]
    output_leaks: bool,
}

/// A group of equal neurons.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
struct Cluster {
    /// Name for links, settings and parameters.
    #[schemars(regex(pattern = NAME))]
    name: String,
    /// Number of neurons.
    #[schemars(range(min = 1, max = 10000))]
    neurons: u32,
    /// Activation function of the neurons.
    #[serde(default)]
    activation: ClusterActivation,
    /// Factor of the net input.
    #[serde(default = "one")]
    #[schemars(range(min = 0.001, max = 1000.0))]
    slope: f64,
    /// Adds a bias to each neuron.
    #[serde(default = "yes")]
    biases: bool,
    /// Makes the neurons leaky integrators.
    #[serde(default)]
    leaks: bool,
}

/// Activation functions, all of them bounded.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
enum ClusterActivation {
    /// The logistic function, 0 to 1.
    #[default]
    Logistic,
    /// The hyperbolic tangent, -1 to 1.
    Tanh,
    /// 1 for a sum of at least 0, and 0 below.
    Step,
}

/// A link with a weight from every neuron of one end to every neuron of the other.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
struct Link {
    /// Name of a sensor, cluster or motor. `sensors` and `motors` refer to all of them.
    from: String,
    /// Name of a cluster or motor. `motors` refers to all motors.
    to: String,
    /// Additional delay [steps].
    #[serde(default)]
    #[schemars(range(min = 0, max = 1000))]
    delay: u32,
}

fn leaks() -> [f64; 2] {
    [0.0, 1.0]
}

fn one() -> f64 {
    1.0
}

fn yes() -> bool {
    true
}

/// A network of blocks.
#[derive(Clone, Debug)]
pub(crate) struct BlocksNetwork {
    pub(crate) network: BlockNetwork<'static, Vec<f32>, Vec<f32>>,
    /// Names of the hidden neurons, if any.
    hidden: Arc<[String]>,
}

around!(BlocksNetwork, network);

impl BlocksNetwork {
    /// Builds a network at rest.
    pub(super) fn new(layout: BlockLayoutBuf, hidden: Vec<String>, ends: &NetworkEnds<'_>) -> Result<Self, Error> {
        ends.text.check_network(layout.layout().parameter_count(), layout.layout().state_len())?;
        let layout = static_layout(layout).layout();
        let (parameters, state) = (vec![0.0; layout.parameter_count()], vec![0.0; layout.state_len()]);
        let network = BlockNetwork::new(layout, Leak::Filter, parameters, state)?;
        Ok(Self { network, hidden: hidden.into() })
    }
}

impl PartNetwork for BlocksNetwork {
    fn copy_parameters(&mut self, parameters: &[f32]) -> bool {
        self.network.copy_parameters(parameters).is_ok()
    }

    fn parameters(&self) -> &[f32] {
        self.network.parameters()
    }

    fn activations(&self) -> &[f32] {
        self.network.activations()
    }

    fn export(&self) -> Option<NetworkExport> {
        let (layout, leak) = (self.network.layout().into(), self.network.leak());
        Some(NetworkExport::Blocks { layout, leak, parameters: self.parameters().to_vec() })
    }

    fn memory(&self) -> usize {
        self.network.layout().state_len()
    }

    fn summary(&self) -> String {
        in_blocks(self)
    }

    fn first_neuron(&self) -> usize {
        self.inputs()
    }

    fn hidden_names(&self) -> Vec<String> {
        self.hidden.to_vec()
    }
}

/// Describes a network of blocks in one line.
pub(super) fn in_blocks(network: &impl PartNetwork) -> String {
    let [inputs, outputs] = [network.inputs(), network.outputs()];
    format!("{inputs}-{outputs}, {} neurons in blocks", network.activations().len().saturating_sub(inputs))
}

impl NetworkPart for Blocks {
    type Network = BlocksNetwork;

    fn network(&self, ends: &NetworkEnds<'_>) -> Result<BlocksNetwork, Error> {
        BlocksNetwork::new(layout(self, ends)?, cluster_neurons(self), ends)
    }

    fn parameters(&self, network: &BlocksNetwork, ends: &NetworkEnds<'_>) -> Vec<Parameter> {
        parameters(self, network.network.layout(), ends, [ends.weights, self.leaks].map(single))
    }
}

/// A possible end of a link, with its neurons.
struct LinkEnd {
    /// Kind of the end, for messages.
    what: &'static str,
    name: String,
    span: Span,
}

/// A link between neurons.
#[derive(Clone, Copy)]
struct ResolvedLink {
    from: Span,
    to: Span,
    delay: usize,
}

/// Builds the layout of a document. It updates the inputs, then links and updates each cluster, then the outputs.
fn layout(blocks: &Blocks, ends: &NetworkEnds<'_>) -> Result<BlockLayoutBuf, Error> {
    let link_ends = link_ends(blocks, ends)?;
    let mut links: Vec<(usize, ResolvedLink)> = Vec::new();
    for (number, link) in blocks.links.iter().enumerate() {
        let path = format!("links/{number}");
        let Some(found) = resolved(link, &link_ends, ends, &path)? else { continue };
        // Spans [a, b) overlap if each begins before the other ends.
        let overlap = |a: Span, b: Span| a.first < b.end() && b.first < a.end();
        let same = |other: ResolvedLink| {
            overlap(other.from, found.from) && overlap(other.to, found.to) && other.delay == found.delay
        };
        if let Some((other, _)) = links.iter().find(|(_, other)| same(*other)) {
            let Link { from, to, .. } = link;
            let why = format!("links `{from}` with `{to}`, as link {} does with the same delay", other + 1);
            return Err(ends.error_at(&path, why));
        }
        links.push((number, found));
    }
    let [inputs, outputs] = [ends.inputs.len(), ends.outputs.len()];
    let mut groups = vec![Group::new(inputs, Activation::Linear)];
    groups.extend(blocks.clusters.iter().map(group));
    let biased = Group { bias: blocks.output_biases, ..Group::new(outputs, Activation::Logistic) };
    groups.push(Group { leak: blocks.output_leaks, ..biased });
    let (mut list, mut first) = (Vec::new(), 0);
    for group in &groups {
        let span = Span::new(first, group.neurons);
        first = span.end();
        // A link to this group adds to its net inputs before the update. Sources of later groups are one step old.
        let to_own = links.iter().map(|(_, link)| link).filter(|link| span.contains(link.to.first));
        list.extend(to_own.map(|link| Block::connect(link.from, link.to).delayed(link.delay)));
        list.push(Block::Update(span));
    }
    Ok(BlockLayoutBuf { inputs, outputs, groups, blocks: list })
}

fn group(cluster: &Cluster) -> Group {
    let activation = match cluster.activation {
        ClusterActivation::Logistic => Activation::Logistic,
        ClusterActivation::Tanh => Activation::Tanh,
        ClusterActivation::Step => Activation::Step,
    };
    let group = Group::new(cluster.neurons as usize, activation).with_slope(cluster.slope as f32);
    Group { bias: cluster.biases, leak: cluster.leaks, ..group }
}

/// Returns all ends of links: sensors, clusters, motors, all sensors and all motors.
fn link_ends(blocks: &Blocks, ends: &NetworkEnds<'_>) -> Result<Vec<LinkEnd>, Error> {
    let part = |what, (name, [first, end]): &(String, [usize; 2]), before: usize| {
        let span = Span::new(before + first, end - first);
        LinkEnd { what, name: name.clone(), span }
    };
    let mut link_ends =
        vec![LinkEnd { what: "all sensors", name: "sensors".into(), span: Span::new(0, ends.inputs.len()) }];
    link_ends.extend(ends.sensors.iter().map(|sensor| part("a sensor", sensor, 0)));
    let mut next = ends.inputs.len();
    for (number, cluster) in blocks.clusters.iter().enumerate() {
        let name = &cluster.name;
        let before = link_ends.iter().map(|end| &end.name);
        let mut taken = before.chain(ends.motors.iter().map(|(name, _)| name));
        if name == "motors" || taken.any(|other| other == name) {
            let path = format!("clusters/{number}/name");
            return Err(ends.error_at(&path, format!("`{name}` names something else already")));
        }
        let span = Span::new(next, cluster.neurons as usize);
        next = span.end();
        link_ends.push(LinkEnd { what: "a cluster", name: name.clone(), span });
    }
    link_ends.push(LinkEnd { what: "all motors", name: "motors".into(), span: Span::new(next, ends.outputs.len()) });
    link_ends.extend(ends.motors.iter().map(|motor| part("a motor", motor, next)));
    Ok(link_ends)
}

/// Resolves the link at a path. Returns `None` if a sensor or motor at its end is disabled.
fn resolved(
    link: &Link,
    link_ends: &[LinkEnd],
    ends: &NetworkEnds<'_>,
    path: &str,
) -> Result<Option<ResolvedLink>, Error> {
    let inputs = ends.inputs.len();
    let end = |key: &str, name: &str| {
        let path = format!("{path}/{key}");
        // No link leads to a sensor.
        let valid = || link_ends.iter().filter(|end| key == "from" || end.span.first >= inputs);
        let mut found = valid().filter(|end| end.name == name);
        match (found.next(), found.next()) {
            (Some(one), None) => Ok(one.span),
            (Some(one), Some(other)) => {
                let why = format!("`{name}` is {} and {}: give one of them another `name`", one.what, other.what);
                Err(ends.error_at(&path, why))
            }
            (None, _) if link_ends.iter().any(|end| end.name == name) => {
                Err(ends.error_at(&path, format!("`{name}` is what is sensed: links lead to clusters and motors")))
            }
            (None, _) => {
                let names: Vec<&str> = valid().map(|end| end.name.as_str()).collect();
                Err(ends.text.unknown(&path, ("end of a link", name), &names))
            }
        }
    };
    let off = |name: &String| ends.absent.contains(name) && link_ends.iter().all(|end| end.name != *name);
    if off(&link.from) || off(&link.to) {
        return Ok(None);
    }
    let (from, to) = (end("from", &link.from)?, end("to", &link.to)?);
    // Names of channels must be unique, because parameters are named after them.
    let outputs = link_ends.iter().find(|end| end.name == "motors").map_or(0, |end| end.span.first);
    let sources = ends.outputs.iter().enumerate().filter(|(output, _)| from.contains(outputs + output));
    if let Some((_, name)) = sources.into_iter().find(|(_, name)| ends.inputs.contains(name)) {
        let why = format!("`{name}` is a sensor and a motor: give one of them another `name`");
        return Err(ends.error_at(&format!("{path}/from"), why));
    }
    Ok(Some(ResolvedLink { from, to, delay: link.delay as usize }))
}

/// Names the neurons of clusters.
fn cluster_neurons(blocks: &Blocks) -> Vec<String> {
    let of_cluster = |cluster: &Cluster| match cluster.neurons {
        1 => vec![cluster.name.clone()],
        count => (1..=count).map(|number| format!("{} {number}", cluster.name)).collect(),
    };
    blocks.clusters.iter().flat_map(of_cluster).collect()
}

/// Names all parameters of a layout.
fn parameters(
    blocks: &Blocks,
    layout: BlockLayout<'_>,
    ends: &NetworkEnds<'_>,
    [weights, leaks]: [[f64; 2]; 2],
) -> Vec<Parameter> {
    let clusters = cluster_neurons(blocks);
    let names: Vec<String> = ends.inputs.iter().cloned().chain(clusters).chain(ends.outputs.iter().cloned()).collect();
    let mut parameters = Vec::new();
    for block in layout.blocks() {
        let Block::Connect { from, to, delay } = *block else { continue };
        let later = match delay {
            0 => String::new(),
            1 => " a step later".into(),
            steps => format!(" {steps} steps later"),
        };
        for source in &names[from.first..from.end()] {
            let weight = |target| Parameter::new(format!("weight of {source} on {target}{later}"), weights);
            parameters.extend(names[to.first..to.end()].iter().map(weight));
        }
    }
    for (word, kind, range) in [("bias", BlockParameter::Bias, weights), ("leak", BlockParameter::Leak, leaks)] {
        let mut first = 0;
        for group in layout.groups() {
            let names_of_group = &names[first..first + group.neurons];
            first += group.neurons;
            let has = if kind == BlockParameter::Bias { group.bias } else { group.leak };
            let named = names_of_group.iter().filter(|_| has);
            parameters.extend(named.map(|name| Parameter::new(format!("{word} of {name}"), range)));
        }
    }
    parameters
}
