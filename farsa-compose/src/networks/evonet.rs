//! The network of the 2013 program, with genes in its order.

use std::collections::BTreeMap;
use std::sync::Arc;

use farsa_lab::exports::NetworkExport;
use farsa_lab::{Error, Parameter};
use farsa_nn::block::{Architecture, BlockLayoutBuf, BlockNetwork, BlockParameter, EvonetRanges};
use farsa_nn::{Activation, Controller as _, Leak};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use crate::networks::blocks::in_blocks;
use crate::networks::static_layout::static_layout;
use crate::networks::{around, numbered, single};
use crate::part::{NetworkEnds, NetworkPart, PartNetwork};

/// The network of the 2013 program.
///
/// Logistic neurons connected as in Evonet, the network of the 2013 program, with its order and reading of genes.
/// `.gen` files of that program are genotypes of this network.
///
/// The range of weights begins with the largest, `[5.0, -5.0]`, as in the source. A leak is the magnitude of its
/// gene's value divided by the largest weight, so both ends of the range mean a leak of 1.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[expect(clippy::struct_excessive_bools, reason = "each is a flag of the original's file")]
pub(super) struct Evonet {
    /// Name of a network file of the 2013 program (`.net` or `.phe`) in the same folder. It replaces the keys below
    /// except the largest bias and gain.
    ///
    /// Parameters with a value and a mutation rate of 0 in a `.phe` file are fixed. All others are searched.
    file: Option<String>,
    /// Hidden neurons.
    #[serde(default)]
    #[schemars(range(min = 0, max = 1000))]
    hidden: u32,
    /// Kind of the hidden neurons.
    #[serde(default)]
    hidden_neurons: EvonetNeurons,
    /// Adds biases to hidden neurons.
    #[serde(default = "yes")]
    hidden_biases: bool,
    /// Adds biases to outputs.
    #[serde(default = "yes")]
    output_biases: bool,
    /// Links hidden neurons to each other with a delay of one step.
    #[serde(default)]
    recurrent_hidden: bool,
    /// Links outputs to each other with a delay of one step.
    #[serde(default)]
    recurrent_outputs: bool,
    /// Links inputs to outputs in addition to the hidden neurons. Always true without hidden neurons.
    #[serde(default)]
    direct: bool,
    /// Adds leaks to outputs.
    #[serde(default)]
    output_leaks: bool,
    /// Largest bias.
    #[serde(default = "five")]
    #[schemars(range(min = 0.0, max = 1e6))]
    largest_bias: f64,
    /// Largest gain of neurons with gains in a file.
    #[serde(default = "five")]
    #[schemars(range(min = 0.0, max = 1e6))]
    largest_gain: f64,
}

/// Kinds of hidden neurons of the 2013 program.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
enum EvonetNeurons {
    /// Logistic.
    #[default]
    Logistic,
    /// Logistic, each with a leak.
    Leaky,
    /// 1 for a net input of at least 0, and 0 below.
    Binary,
}

fn five() -> f64 {
    5.0
}

fn yes() -> bool {
    true
}

/// A network of blocks whose searched parameters are those of the 2013 program.
#[derive(Clone, Debug)]
pub(super) struct EvonetNetwork {
    network: BlockNetwork<'static, Vec<f32>, Vec<f32>>,
    ranges: EvonetRanges,
    /// Index and kind of the parameter of each number of that program.
    order: Arc<[(usize, BlockParameter)]>,
    /// Numbers that a file fixes, in the order of that program.
    given: Arc<[Option<f32>]>,
}

/// Most neurons of a file, as in the 2013 program, and most blocks.
const MAX_LINES: usize = 1000;

impl EvonetNetwork {
    /// Builds a network at rest, from flags or from a file.
    fn new(evonet: &Evonet, ends: &NetworkEnds<'_>) -> Result<Self, Error> {
        let ([inputs, outputs], weights) = (ends.shape(), ends.weights);
        let weight = weights[0].abs().max(weights[1].abs()) as f32;
        // The search has one range for all numbers, that of the weights. Biases and leaks are scaled from it.
        if weight <= 0.0 {
            return Err(Error::Other("weights are all 0, so that biases and leaks have no size".into()));
        }
        let ranges = EvonetRanges { weight, bias: evonet.largest_bias as f32, gain: evonet.largest_gain as f32 };
        let Some(name) = &evonet.file else {
            return Self::from_layout(from_flags(evonet, [inputs, outputs]), Vec::new(), ranges, ends);
        };
        if let Some(flag) = flags(evonet).into_iter().find_map(|(flag, set)| set.then_some(flag)) {
            return Err(ends.error_at(flag, format!("has no effect with `file`: {name} defines it")));
        }
        let wrong = |why: &dyn std::fmt::Display| ends.error_at("file", format!("{name}: {why}"));
        let text = ends.files.get(name).map(String::as_str).unwrap_or_default();
        let farsa_nn::block::Evonet { layout, numbers, mutations } = text.parse().map_err(|error| wrong(&error))?;
        if [layout.inputs, layout.outputs] != [inputs, outputs] {
            let why = format!(
                "has {} sensors and {} motors where the experiment's have {inputs} and {outputs} channels",
                layout.inputs, layout.outputs
            );
            return Err(wrong(&why));
        }
        for (what, count) in [("neurons", layout.layout().neurons()), ("blocks", layout.blocks.len())] {
            if count > MAX_LINES {
                return Err(wrong(&format!("has {count} {what}; at most {MAX_LINES}")));
            }
        }
        // A number with a mutation rate of 0 is fixed. The 2013 program draws all others.
        let fixed = numbers.iter().zip(mutations).map(|(number, rate)| number.filter(|_| rate == Some(0.0)));
        let made = Self::from_layout(layout, fixed.collect(), ranges, ends);
        made.map_err(|error| if let Error::Other(why) = error { wrong(&why) } else { error })
    }

    fn from_layout(
        layout: BlockLayoutBuf,
        given: Vec<Option<f32>>,
        ranges: EvonetRanges,
        ends: &NetworkEnds<'_>,
    ) -> Result<Self, Error> {
        let count = layout.layout().parameter_count();
        ends.text.check_network(count, layout.layout().state_len())?;
        let layout = static_layout(layout).layout();
        let kinds: Vec<BlockParameter> = layout.kinds().collect();
        let mut seen = vec![false; count];
        let mut order = Vec::new();
        for index in layout.evonet_order() {
            // A repeated index belongs to a second update of a neuron in one step.
            if std::mem::replace(&mut seen[index], true) {
                return Err(Error::Other("updates a neuron with a leak twice in a step".into()));
            }
            order.push((index, kinds[index]));
        }
        if order.len() < count {
            return Err(Error::Other("has a neuron with a leak that is never updated".into()));
        }
        let given = if given.is_empty() { vec![None; count] } else { given };
        let (parameters, state) = (vec![0.0; count], vec![0.0; layout.state_len()]);
        let network = BlockNetwork::new(layout, Leak::Evonet, parameters, state)?;
        Ok(Self { network, ranges, order: order.into(), given: given.into() })
    }

    /// Iterates over the kinds of the searched parameters. All have the range of the weights.
    fn kinds(&self) -> impl Iterator<Item = &'static str> + '_ {
        self.order.iter().map(|(_, kind)| match kind {
            BlockParameter::Leak => "leak",
            BlockParameter::Bias => "bias",
            BlockParameter::Gain => "gain",
            _ => "weight",
        })
    }

    /// Computes the network's parameters from those of a search, or `None` for another number.
    fn decode(&self, parameters: &[f32]) -> Option<Vec<f32>> {
        if parameters.len() != self.order.len() {
            return None;
        }
        let mut decoded = vec![0.0; parameters.len()];
        for ((index, kind), p) in self.order.iter().zip(parameters) {
            decoded[*index] = self.ranges.decode(*kind, *p);
        }
        Some(decoded)
    }
}

around!(EvonetNetwork, network);

impl PartNetwork for EvonetNetwork {
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

    fn load(&mut self, searched: &[f32]) -> bool {
        self.decode(searched).is_some_and(|parameters| self.copy_parameters(&parameters))
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
}

impl NetworkPart for Evonet {
    type Network = EvonetNetwork;

    fn network(&self, ends: &NetworkEnds<'_>) -> Result<EvonetNetwork, Error> {
        EvonetNetwork::new(self, ends)
    }

    fn parameters(&self, network: &EvonetNetwork, ends: &NetworkEnds<'_>) -> Vec<Parameter> {
        let weights = single(ends.weights);
        numbered(network.kinds().map(|kind| (kind, weights)))
    }

    fn given(&self, network: &EvonetNetwork, ends: &NetworkEnds<'_>) -> BTreeMap<String, f64> {
        let parameters = self.parameters(network, ends);
        let given = parameters.into_iter().zip(&*network.given);
        given.filter_map(|(known, value)| Some((known.name, f64::from((*value)?)))).collect()
    }

    fn files(&self) -> Vec<(String, String)> {
        self.file.iter().map(|name| ("file".into(), name.clone())).collect()
    }
}

/// Returns the keys that a file replaces, with true for those that differ from their default.
fn flags(evonet: &Evonet) -> [(&'static str, bool); 8] {
    [
        ("hidden", evonet.hidden > 0),
        ("hidden_neurons", evonet.hidden_neurons != EvonetNeurons::Logistic),
        ("hidden_biases", !evonet.hidden_biases),
        ("output_biases", !evonet.output_biases),
        ("recurrent_hidden", evonet.recurrent_hidden),
        ("recurrent_outputs", evonet.recurrent_outputs),
        ("direct", evonet.direct),
        ("output_leaks", evonet.output_leaks),
    ]
}

/// Builds the layout of flags.
fn from_flags(evonet: &Evonet, [inputs, outputs]: [usize; 2]) -> BlockLayoutBuf {
    let hidden = evonet.hidden as usize;
    let mut plan = if evonet.recurrent_hidden && hidden > 0 {
        Architecture::elman(inputs, hidden, outputs)
    } else {
        Architecture::feed_forward(inputs, hidden, outputs)
    };
    plan = match evonet.hidden_neurons {
        EvonetNeurons::Logistic => plan,
        EvonetNeurons::Leaky => plan.with_leaks(),
        EvonetNeurons::Binary => plan.with_activations(Activation::Step, Activation::Logistic),
    };
    for (wanted, change) in [
        (!evonet.hidden_biases, Architecture::without_hidden_biases as fn(Architecture) -> Architecture),
        (!evonet.output_biases, Architecture::without_output_biases),
        (evonet.recurrent_outputs, Architecture::with_recurrent_outputs),
        (evonet.direct, Architecture::with_inputs_to_outputs),
        (evonet.output_leaks, Architecture::with_output_leaks),
    ] {
        plan = if wanted { change(plan) } else { plan };
    }
    plan.plan().into()
}

#[cfg(test)]
mod tests {
    use crate::check::source::Source;

    use super::*;

    fn evonet(hidden: u32) -> Evonet {
        Evonet {
            file: None,
            hidden,
            hidden_neurons: EvonetNeurons::Logistic,
            hidden_biases: false,
            output_biases: false,
            recurrent_hidden: false,
            recurrent_outputs: false,
            direct: false,
            output_leaks: false,
            largest_bias: 5.0,
            largest_gain: 5.0,
        }
    }

    fn new(evonet: &Evonet, weights: [f64; 2]) -> Result<EvonetNetwork, Error> {
        let [inputs, outputs] = [3, 2].map(|count| vec![String::new(); count]);
        let ends = NetworkEnds {
            inputs: &inputs,
            outputs: &outputs,
            time_step: 0.1,
            weights,
            sensors: &[],
            motors: &[],
            absent: &[],
            files: &BTreeMap::new(),
            text: &Source::new("own.toml"),
        };
        EvonetNetwork::new(evonet, &ends)
    }

    fn logistic(x: f32) -> f32 {
        farsa_num::logistic(x)
    }

    /// Transcribes the 2013 program for leaky hidden neurons with links among them, direct links and recurrent
    /// outputs.
    #[test]
    fn steps_are_those_of_the_original() {
        let evonet = Evonet {
            hidden_neurons: EvonetNeurons::Leaky,
            hidden_biases: true,
            output_biases: true,
            recurrent_hidden: true,
            recurrent_outputs: true,
            direct: true,
            largest_bias: 2.5,
            ..evonet(2)
        };
        let mut made = new(&evonet, [5.0, -5.0]).unwrap();
        let count = 4 + 6 + 4 + 2 + 6 + 4 + 4;
        assert_eq!(made.kinds().count(), count);
        let p: Vec<f32> = (0..count).map(|n| 5.0 - (n * 37 % 256) as f32 / 255.0 * 10.0).collect();
        let decoded = made.decode(&p).unwrap();
        assert!(made.network.copy_parameters(&decoded).is_ok() && made.decode(&p[1..]).is_none());
        let x = [0.2, 0.9, 0.4];
        let (mut h, mut o, mut y) = ([0.0f32; 2], [0.0f32; 2], [0.0; 2]);
        for _ in 0..5 {
            let mut next = p.iter().copied();
            let mut net: Vec<f32> = (0..4).map(|_| next.next().unwrap() / 5.0 * 2.5).collect();
            for net in &mut net[..2] {
                *net += x.iter().map(|x| x * next.next().unwrap()).sum::<f32>();
            }
            for net in &mut net[..2] {
                *net += h.iter().map(|h| h * next.next().unwrap()).sum::<f32>();
            }
            for (h, net) in h.iter_mut().zip(&net) {
                let leak = next.next().unwrap().abs() / 5.0;
                *h = *h * leak + logistic(*net) * (1.0 - leak);
            }
            for from in [&x[..], &h, &o] {
                for net in &mut net[2..] {
                    *net += from.iter().map(|a| a * next.next().unwrap()).sum::<f32>();
                }
            }
            o = [logistic(net[2]), logistic(net[3])];
            assert_eq!(next.next(), None);
            made.network.step(&x, &mut y);
            assert!(o.iter().zip(y).all(|(o, y)| (o - y).abs() < 1e-5), "{o:?} {y:?}");
        }
    }

    #[test]
    fn counts_are_those_of_the_flags() {
        for (evonet, expected) in [
            (evonet(0), 6),
            (Evonet { direct: true, recurrent_hidden: true, ..evonet(0) }, 6),
            (Evonet { recurrent_outputs: true, output_biases: true, ..evonet(0) }, 12),
            (Evonet { output_leaks: true, ..evonet(0) }, 8),
            (evonet(4), 20),
            (Evonet { hidden_biases: true, hidden_neurons: EvonetNeurons::Binary, ..evonet(4) }, 24),
        ] {
            let made = new(&evonet, [5.0, -5.0]).unwrap();
            assert_eq!(made.kinds().count(), expected, "{evonet:?}");
        }
        assert!(new(&evonet(0), [0.0; 2]).is_err());
    }
}
