//! Parts of a controller that a test can change, by name.

use std::ops::Range;

use farsa_nn::Lesion;
use farsa_view::{Channel, Links, NodeParameters, Schema};

use crate::error::Error;
use crate::escaped::Quoted;
use crate::experiment::intervention::{Intervention, input_ranges};
use crate::experiment::outcome::Description;

/// Named parts of a controller that a test can change. Their names can be used in `farsa test --lesion`.
///
/// A list such as `neuron:3,link:2-5,sensor:touch` names what is changed together:
///
/// | change | what it does |
/// |---|---|
/// | `neuron:NAME` or `output:NAME` | the neuron is silent; `=VALUE` holds it at an activation |
/// | `sensor:NAME` | an input, or a group of them, is 0; `=VALUE` holds it there |
/// | `link:FROM-TO` | all links from one node or group of inputs to a node are cut; `=VALUE` sets their weights |
/// | `bias:NAME=VALUE` | another parameter of a node, by the name that it has in the schema |
/// | `noise:LEVEL` | every input changes at every step by up to this |
///
/// ```
/// use farsa_lab::advanced::{Anatomy, ChannelGroup, Description, Intervention};
/// use farsa_nn::{LeakyLayout, LeakyParameter, Lesion};
/// use farsa_view::Schema;
///
/// let layout = LeakyLayout::new(3, 2, 1);
/// let schema = Schema::default().with_sensors(["left", "right", "skin"]).with_outputs(["wheel"]).with_network(&layout);
/// let groups = vec![ChannelGroup::new("eyes", 2, ""), ChannelGroup::new("touch", 1, "")];
/// let anatomy = Anatomy::new(&schema, &Description { sensors: groups, ..Description::default() });
/// let change = anatomy.intervention("neuron:2,link:left-1,sensor:touch=0.5")?;
/// assert_eq!(change.lesions, [Lesion::new(1)]);
/// assert_eq!(change.inputs, [(2..3, 0.5)]);
/// assert_eq!(change.parameters, [(layout.range(LeakyParameter::SensorWeight).start, 0.0)]);
/// let error = anatomy.intervention("sensor:tuch").unwrap_err();
/// assert_eq!(error.to_string(), "--lesion: unknown sensor `tuch`; the nearest is `touch`");
/// # Ok::<(), farsa_lab::Error>(())
/// ```
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Anatomy {
    groups: Vec<(String, Range<usize>)>,
    sensors: Vec<String>,
    neurons: Vec<String>,
    outputs: Vec<String>,
    links: Vec<Links>,
    node_parameters: Vec<NodeParameters>,
    /// Numbers of the first neuron and of the first output among those that can be held.
    first: [usize; 2],
    /// Number that each parameter of the schema has in the network, where that is not the same.
    order: Option<Vec<usize>>,
}

/// A kind of change, together with its valid names.
#[derive(Clone, Debug, PartialEq, Eq, serde::Serialize)]
pub struct PartNames {
    /// Word before the colon, such as `sensor`, `neuron` or `bias`.
    pub kind: String,
    /// All valid words after the colon.
    pub names: Vec<String>,
}

impl Anatomy {
    /// Creates the parts of a network from a schema. It must name all nodes, links and parameters. Inputs are
    /// grouped in the same way as in the description.
    ///
    /// This assumes that neurons are numbered from 0, followed by the outputs, and that parameters have the order of
    /// the schema. If this is not the case, also use [`with_first`](Self::with_first) or
    /// [`with_parameter_order`](Self::with_parameter_order).
    pub fn new(schema: &Schema, description: &Description) -> Self {
        let names = |channels: &[Channel]| channels.iter().map(|channel| channel.name.clone()).collect::<Vec<_>>();
        let sensors = names(&schema.sensors);
        let groups = input_ranges(&description.sensors).filter(|(_, inputs)| inputs.end <= sensors.len());
        Self {
            groups: groups.collect(),
            sensors,
            neurons: names(&schema.neurons),
            outputs: names(&schema.outputs),
            links: schema.links.clone(),
            node_parameters: schema.node_parameters.clone(),
            first: [0, schema.neurons.len()],
            order: None,
        }
    }

    /// Sets the numbers of the first neuron and the first output, as used by [`Lesion::neuron`].
    #[must_use]
    pub fn with_first(self, neuron: usize, output: usize) -> Self {
        Self { first: [neuron, output], ..self }
    }

    /// Sets the order of the network's own parameters, if it differs from the schema.
    ///
    /// The closure `in_schema_order` receives all `count` parameters of the network, and arranges them in the order
    /// of the schema.
    #[must_use]
    pub fn with_parameter_order(self, count: usize, in_schema_order: impl Fn(&[f32]) -> Vec<f32>) -> Self {
        // Numbers of parameters are exact in single precision: networks are far smaller than 2^24.
        let numbers: Vec<f32> = (0..count).map(|number| number as f32).collect();
        let order = in_schema_order(&numbers).into_iter().map(|number| number as usize).collect();
        Self { order: Some(order), ..self }
    }

    /// Lists all kinds of changes with their valid names. Kinds without any names are left out.
    ///
    /// Since a link is named by two nodes, its only entry is the pattern `FROM-TO`.
    pub fn names(&self) -> Vec<PartNames> {
        let groups = self.groups.iter().map(|(group, _)| group);
        let single = self.sensors.iter().filter(|&name| self.groups.iter().all(|(group, _)| group != name));
        let links = if self.links.is_empty() { Vec::new() } else { vec!["FROM-TO".to_owned()] };
        let lists = [
            PartNames { kind: "sensor".into(), names: groups.chain(single).cloned().collect() },
            PartNames { kind: "neuron".into(), names: self.neurons.clone() },
            PartNames { kind: "output".into(), names: self.outputs.clone() },
            PartNames { kind: "link".into(), names: links },
        ];
        let rows = self.node_parameters.iter().map(|NodeParameters { name, nodes: [first, end], .. }| {
            let nodes = self.sensors.iter().chain(&self.neurons).chain(&self.outputs).skip(*first);
            PartNames { kind: name.clone(), names: nodes.take(end.saturating_sub(*first)).cloned().collect() }
        });
        lists.into_iter().chain(rows).filter(|part| !part.names.is_empty()).collect()
    }

    /// Parses a list of changes, separated by commas.
    ///
    /// # Errors
    /// Returns [`Error::Setting`] with the nearest name if a name is unknown. [`Error::Usage`] is for invalid
    /// changes, and for missing or invalid numbers.
    pub fn intervention(&self, list: &str) -> Result<Intervention, Error> {
        let mut sum = Intervention::default();
        for change in list.split(',') {
            self.add(change.trim(), &mut sum)?;
        }
        Ok(sum)
    }

    fn add(&self, change: &str, all: &mut Intervention) -> Result<(), Error> {
        let Some((kind, name)) = change.split_once(':') else {
            let why = format!("{} is no change such as neuron:3, link:2-5 or sensor:touch", Quoted(change));
            return Err(Error::Usage(format!("--lesion: {why}")));
        };
        let (name, value) = match name.rsplit_once('=') {
            Some((name, value)) => (name.trim(), Some(number(value)?)),
            None => (name.trim(), None),
        };
        let held = value.unwrap_or(0.0);
        match kind.trim() {
            "neuron" => {
                let neuron = self.first[0] + find("neuron", name, &self.neurons)?;
                all.lesions.push(Lesion { neuron, activation: held });
            }
            "output" => {
                let neuron = self.first[1] + find("output", name, &self.outputs)?;
                all.lesions.push(Lesion { neuron, activation: held });
            }
            "sensor" => all.inputs.push((self.inputs(name)?, held)),
            "noise" => {
                let level = number(name)?;
                if value.is_some() || level < 0.0 {
                    return Err(Error::Usage(format!("--lesion: {}: noise is a number from 0", Quoted(change))));
                }
                all.noise = level;
            }
            "link" => {
                let weights = self.links_between(name)?;
                all.parameters.extend(weights.into_iter().map(|weight| (self.own(weight), held)));
            }
            kind => {
                let parameter = self.node_parameter(kind, name)?;
                let why = || Error::Usage(format!("--lesion: {} has no value: {change}=VALUE", Quoted(change)));
                all.parameters.push((self.own(parameter), value.ok_or_else(why)?));
            }
        }
        Ok(())
    }

    /// Gets the number in the network of a parameter of the schema.
    fn own(&self, parameter: usize) -> usize {
        self.order.as_ref().map_or(parameter, |order| order.get(parameter).copied().unwrap_or(usize::MAX))
    }

    /// Gets the inputs of a group or a single one.
    fn inputs(&self, name: &str) -> Result<Range<usize>, Error> {
        let group = self.groups.iter().find(|(group, _)| group == name).map(|(_, inputs)| inputs.clone());
        let single = || place("sensor", name, &self.sensors).map(|sensor| sensor..sensor + 1);
        group.or_else(single).ok_or_else(|| {
            let groups = self.groups.iter().map(|(group, _)| group.as_str());
            Error::unknown("--lesion", "sensor", name, groups.chain(self.sensors.iter().map(String::as_str)))
        })
    }

    /// Finds the nodes of a name, numbered through sensors, neurons and outputs: a neuron before others of its name.
    fn nodes(&self, name: &str) -> Option<Range<usize>> {
        let [sensors, neurons] = [self.sensors.len(), self.neurons.len()];
        let span = |node: usize| node..node + 1;
        let neuron = || place("neuron", name, &self.neurons).map(|neuron| span(sensors + neuron));
        let output = || place("output", name, &self.outputs).map(|output| span(sensors + neurons + output));
        neuron().or_else(|| self.inputs(name).ok()).or_else(output)
    }

    /// Gets the weights of the links that `FROM-TO` means.
    fn links_between(&self, name: &str) -> Result<Vec<usize>, Error> {
        let hyphens = name.match_indices('-').map(|(at, _)| (name[..at].trim(), name[at + 1..].trim()));
        // Names may have hyphens themselves.
        let mut nodes = hyphens.clone().filter_map(|(from, to)| Some((self.nodes(from)?, self.nodes(to)?)));
        let Some((from, to)) = nodes.next() else {
            let Some((from, to)) = hyphens.clone().next() else {
                return Err(Error::Usage(format!("--lesion: link:{name} is not of the form link:FROM-TO")));
            };
            let wrong = if self.nodes(from).is_none() { from } else { to };
            return Err(Error::unknown("--lesion", "node", wrong, self.all_nodes()));
        };
        let weights: Vec<usize> = self.links.iter().flat_map(|links| weights(links, &from, &to)).collect();
        if weights.is_empty() {
            let why = if self.links.is_empty() { "the schema names no links" } else { "there is none" };
            return Err(Error::Usage(format!("--lesion: no link {name}: {why}")));
        }
        Ok(weights)
    }

    /// Gets the parameter of this kind of a node.
    fn node_parameter(&self, kind: &str, name: &str) -> Result<usize, Error> {
        let kinds = ["neuron", "output", "sensor", "link", "noise"].into_iter();
        let names = self.node_parameters.iter().map(|parameters| parameters.name.as_str());
        let mut of_kind = self.node_parameters.iter().filter(|parameters| parameters.name == kind).peekable();
        if of_kind.peek().is_none() {
            return Err(Error::unknown("--lesion", "kind of change", kind, kinds.chain(names)));
        }
        let Some(node) = self.nodes(name) else {
            return Err(Error::unknown("--lesion", "node", name, self.all_nodes()));
        };
        let has = |parameters: &&NodeParameters| (parameters.nodes[0]..parameters.nodes[1]).contains(&node.start);
        let parameter = of_kind.find(has).filter(|_| node.len() == 1);
        let parameter = parameter.map(|parameters| parameters.first + node.start - parameters.nodes[0]);
        parameter.ok_or_else(|| Error::Usage(format!("--lesion: {} has no {kind}", Quoted(name))))
    }

    fn all_nodes(&self) -> impl Iterator<Item = &str> {
        let groups = self.groups.iter().map(|(group, _)| group);
        self.neurons.iter().chain(groups).chain(&self.sensors).chain(&self.outputs).map(String::as_str)
    }
}

/// Gets the weights of some links that lead from these nodes to those.
fn weights(links: &Links, from: &Range<usize>, to: &Range<usize>) -> Vec<usize> {
    let Links { from: [first_source, last_source], to: [first_target, last_target], first } = *links;
    let within = |nodes: &Range<usize>, first: usize, last: usize| nodes.start.max(first)..nodes.end.min(last);
    let (sources, targets) = (within(from, first_source, last_source), within(to, first_target, last_target));
    let width = last_target - first_target;
    let weight = |source: usize, target: usize| first + (source - first_source) * width + target - first_target;
    sources.flat_map(|source| targets.clone().map(move |target| weight(source, target))).collect()
}

/// Where a name is, with or without the word for its kind before it.
fn place(kind: &str, name: &str, names: &[String]) -> Option<usize> {
    let at = |name: &str| names.iter().position(|other| other == name);
    at(name).or_else(|| at(name.strip_prefix(kind)?.strip_prefix(' ')?))
}

fn find(kind: &'static str, name: &str, names: &[String]) -> Result<usize, Error> {
    let unknown = || Error::unknown("--lesion", kind, name, names.iter().map(String::as_str));
    place(kind, name, names).ok_or_else(unknown)
}

fn number(text: &str) -> Result<f32, Error> {
    let number = text.trim().parse().ok().filter(|number: &f32| number.is_finite());
    number.ok_or_else(|| Error::Usage(format!("--lesion: {} is not a finite number", Quoted(text))))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::experiment::outcome::ChannelGroup;
    use farsa_nn::{LeakyLayout, LeakyParameter};

    fn layout() -> LeakyLayout {
        LeakyLayout::new(4, 3, 2)
    }

    fn anatomy() -> Anatomy {
        let schema = Schema::default().with_sensors(["a", "b", "low-left", "1"]).with_outputs(["up", "3"]);
        let groups = vec![ChannelGroup::new("eyes", 2, ""), ChannelGroup::new("skin", 2, "")];
        let description = Description { sensors: groups, ..Description::default() };
        Anatomy::new(&schema.with_network(&layout()), &description)
    }

    fn weight(kind: LeakyParameter, at: usize) -> usize {
        layout().range(kind).start + at
    }

    #[test]
    fn names_become_what_they_stand_for() {
        let parameters = |list: &str| anatomy().intervention(list).unwrap().parameters;
        // Without a kind, a neuron takes precedence over a sensor or an output of the same name.
        assert_eq!(parameters("link:1-3"), [(weight(LeakyParameter::RecurrentWeight, 2), 0.0)]);
        assert_eq!(parameters("link:sensor 1-3=0.5"), [(weight(LeakyParameter::SensorWeight, 11), 0.5)]);
        assert_eq!(parameters("link: 2 - output 3 "), [(weight(LeakyParameter::OutputWeight, 3), 0.0)]);
        assert_eq!(parameters("link:low-left-2"), [(weight(LeakyParameter::SensorWeight, 7), 0.0)]);
        // All links of a group.
        let weights = [1, 4].map(|at| (weight(LeakyParameter::SensorWeight, at), 0.0));
        assert_eq!(parameters("link:eyes-2"), weights);
        let [bias, leak] = [LeakyParameter::Bias, LeakyParameter::Leak].map(|kind| weight(kind, 2));
        assert_eq!(parameters("bias:3=-1,leak:neuron 3=1"), [(bias, -1.0), (leak, 1.0)]);

        let change = anatomy().intervention("neuron:1, output:up=1,sensor:eyes,sensor:b=-0.5,noise:0.1").unwrap();
        let lesions = vec![Lesion::new(0), Lesion { neuron: 3, activation: 1.0 }];
        let inputs = vec![(0..2, 0.0), (1..2, -0.5)];
        assert_eq!(change, Intervention { lesions, inputs, noise: 0.1, parameters: vec![] });
        let elsewhere = anatomy().with_first(10, 20).intervention("neuron:2,output:output up").unwrap();
        assert_eq!(elsewhere.lesions, [Lesion::new(11), Lesion::new(20)]);
    }

    #[test]
    fn every_name_that_is_told_is_understood() {
        let anatomy = anatomy();
        let names = anatomy.names();
        let kinds: Vec<&str> = names.iter().map(|part| part.kind.as_str()).collect();
        assert_eq!(kinds, ["sensor", "neuron", "output", "link", "bias", "leak"]);
        assert_eq!(names[0].names, ["eyes", "skin", "a", "b", "low-left", "1"]);
        assert_eq!(names[3].names, ["FROM-TO"]);
        assert_eq!(names[5].names, ["1", "2", "3"]);
        for PartNames { kind, names } in names.into_iter().filter(|part| part.kind != "link") {
            for name in names {
                anatomy.intervention(&format!("{kind}:{name}=0.5")).unwrap();
            }
        }
    }

    #[test]
    fn parameters_have_the_numbers_of_the_network() {
        let count = layout().parameter_count();
        let reversed = |own: &[f32]| own.iter().rev().copied().collect();
        let [plain, turned] = [anatomy(), anatomy().with_parameter_order(count, reversed)]
            .map(|anatomy| anatomy.intervention("link:a-1,bias:2=1").unwrap().parameters);
        assert_eq!(plain.len(), 2);
        for ((plain, _), (turned, _)) in plain.into_iter().zip(turned) {
            assert_eq!(plain + turned, count - 1);
        }
    }

    #[test]
    fn what_is_none_is_refused_with_the_nearest() {
        for (list, why) in [
            ("", "`` is no change such as neuron:3"),
            ("neuron:1,", "`` is no change"),
            ("neuron 3", "`neuron 3` is no change"),
            ("nuron:3", "unknown kind of change `nuron`; the nearest is `neuron`"),
            ("bia:3=1", "unknown kind of change `bia`; the nearest is `bias`"),
            ("neuron:4", "unknown neuron `4`; there are `1`, `2` and `3`"),
            ("output:upp", "unknown output `upp`; the nearest is `up`"),
            ("sensor:skins", "unknown sensor `skins`; the nearest is `skin`"),
            ("link:a", "link:a is not of the form link:FROM-TO"),
            ("link:a-upp", "unknown node `upp`; the nearest is `up`"),
            ("link:aa-up", "unknown node `aa`; the nearest is `a`"),
            ("link:a-up", "no link a-up: there is none"),
            ("link:up-1", "no link up-1: there is none"),
            ("neuron:1=x", "`x` is not a finite number"),
            ("sensor:a=inf", "`inf` is not a finite number"),
            ("bias:3", "`bias:3` has no value: bias:3=VALUE"),
            ("bias:a=1", "`a` has no bias"),
            ("bias:eyes=1", "`eyes` has no bias"),
            ("noise:-1", "noise is a number from 0"),
            ("noise:0.1=2", "noise is a number from 0"),
            ("noise:much", "`much` is not a finite number"),
        ] {
            let error = anatomy().intervention(list).unwrap_err().to_string();
            assert!(error.starts_with("--lesion: ") && error.contains(why), "{list}: {error}");
        }
        let without = Anatomy { links: vec![], ..anatomy() }.intervention("link:a-1").unwrap_err().to_string();
        assert_eq!(without, "--lesion: no link a-1: the schema names no links");
    }
}
