//! Networks of clusters and links.

use farsa_lab::{Error, Parameter};
use farsa_nn::Activation;
use farsa_nn::block::{Block, BlockLayout, BlockLayoutBuf, BlockParameter, Group, Span};

use crate::check::source::Source;
use crate::document::{Blocks, Cluster, ClusterActivation, Link};
use crate::parts::ends::Ends;

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
pub(crate) fn layout(blocks: &Blocks, ends: Ends<'_>, source: &Source) -> Result<BlockLayoutBuf, Error> {
    let link_ends = link_ends(blocks, ends, source)?;
    let mut links: Vec<(usize, ResolvedLink)> = Vec::new();
    for (number, link) in blocks.links.iter().enumerate() {
        let path = format!("/network/links/{number}");
        let Some(found) = resolved(link, &link_ends, ends, &path, source)? else { continue };
        // Spans [a, b) overlap if each begins before the other ends.
        let overlap = |a: Span, b: Span| a.first < b.end() && b.first < a.end();
        let same = |other: ResolvedLink| {
            overlap(other.from, found.from) && overlap(other.to, found.to) && other.delay == found.delay
        };
        if let Some((other, _)) = links.iter().find(|(_, other)| same(*other)) {
            let Link { from, to, .. } = link;
            let why = format!("links `{from}` with `{to}`, as link {} does with the same delay", other + 1);
            return Err(source.wrong(&path, why));
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
fn link_ends(blocks: &Blocks, ends: Ends<'_>, source: &Source) -> Result<Vec<LinkEnd>, Error> {
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
            let path = format!("/network/clusters/{number}/name");
            return Err(source.wrong(&path, format!("`{name}` names something else already")));
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
    ends: Ends<'_>,
    path: &str,
    source: &Source,
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
                Err(source.wrong(&path, why))
            }
            (None, _) if link_ends.iter().any(|end| end.name == name) => {
                Err(source.wrong(&path, format!("`{name}` is what is sensed: links lead to clusters and motors")))
            }
            (None, _) => {
                let names = valid().map(|end| end.name.as_str());
                Err(Error::unknown(&source.of(&path), "end of a link", name, names))
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
        return Err(source.wrong(&format!("{path}/from"), why));
    }
    Ok(Some(ResolvedLink { from, to, delay: link.delay as usize }))
}

/// Names the neurons of clusters.
pub(crate) fn cluster_neurons(blocks: &Blocks) -> Vec<String> {
    let of_cluster = |cluster: &Cluster| match cluster.neurons {
        1 => vec![cluster.name.clone()],
        count => (1..=count).map(|number| format!("{} {number}", cluster.name)).collect(),
    };
    blocks.clusters.iter().flat_map(of_cluster).collect()
}

/// Names all parameters of a layout.
pub(crate) fn parameters(
    blocks: &Blocks,
    layout: BlockLayout<'_>,
    ends: Ends<'_>,
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
