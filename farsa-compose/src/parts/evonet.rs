//! Network of the 2013 program, with genes in its order.

use std::collections::BTreeMap;
use std::sync::Arc;

use farsa_lab::Error;
use farsa_nn::block::{Architecture, BlockLayoutBuf, BlockNetwork, BlockParameter, EvonetRanges};
use farsa_nn::{Activation, Leak};

use crate::check::source::Source;
use crate::document::{Evonet, EvonetNeurons};
use crate::parts::static_layout::static_layout;

/// A network of blocks whose searched parameters are those of the 2013 program.
#[derive(Clone, Debug)]
pub(crate) struct EvonetNetwork {
    pub(crate) network: BlockNetwork<'static, Vec<f32>, Vec<f32>>,
    ranges: EvonetRanges,
    /// Index and kind of the parameter of each number of that program.
    order: Arc<[(usize, BlockParameter)]>,
    /// Numbers that a file fixes, in the order of that program.
    given: Arc<[Option<f32>]>,
}

/// Most neurons of a file, as in the 2013 program, and most blocks.
const MAX_LINES: usize = 1000;

impl EvonetNetwork {
    /// Builds a network at rest between the given numbers of inputs and outputs, from flags or from a file.
    pub(crate) fn new(
        evonet: &Evonet,
        shape: [usize; 2],
        weights: [f64; 2],
        files: &BTreeMap<String, String>,
        source: &Source,
    ) -> Result<Self, Error> {
        let weight = weights[0].abs().max(weights[1].abs()) as f32;
        // The search has one range for all numbers, that of the weights. Biases and leaks are scaled from it.
        if weight <= 0.0 {
            return Err(Error::Other("weights are all 0, so that biases and leaks have no size".into()));
        }
        let ranges = EvonetRanges { weight, bias: evonet.largest_bias as f32, gain: evonet.largest_gain as f32 };
        let Some(name) = &evonet.file else {
            return Self::from_layout(from_flags(evonet, shape), Vec::new(), ranges, source);
        };
        if let Some(flag) = flags(evonet).into_iter().find_map(|(flag, set)| set.then_some(flag)) {
            return Err(
                source.wrong(&format!("/network/{flag}"), format!("has no effect with `file`: {name} defines it"))
            );
        }
        let wrong = |why: &dyn std::fmt::Display| source.wrong("/network/file", format!("{name}: {why}"));
        let text = files.get(name).map(String::as_str).unwrap_or_default();
        let farsa_nn::block::Evonet { layout, numbers, mutations } = text.parse().map_err(|error| wrong(&error))?;
        let [inputs, outputs] = shape;
        if [layout.inputs, layout.outputs] != shape {
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
        let made = Self::from_layout(layout, fixed.collect(), ranges, source);
        made.map_err(|error| if let Error::Other(why) = error { wrong(&why) } else { error })
    }

    fn from_layout(
        layout: BlockLayoutBuf,
        given: Vec<Option<f32>>,
        ranges: EvonetRanges,
        source: &Source,
    ) -> Result<Self, Error> {
        let count = layout.layout().parameter_count();
        source.limits.check_network(count, layout.layout().state_len())?;
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
    pub(crate) fn kinds(&self) -> impl Iterator<Item = &'static str> + '_ {
        self.order.iter().map(|(_, kind)| match kind {
            BlockParameter::Leak => "leak",
            BlockParameter::Bias => "bias",
            BlockParameter::Gain => "gain",
            _ => "weight",
        })
    }

    /// Gets the numbers that a file fixes.
    pub(crate) fn given(&self) -> &[Option<f32>] {
        &self.given
    }

    /// Computes the network's parameters from those of a search, or `None` for another number.
    pub(crate) fn decode(&self, parameters: &[f32]) -> Option<Vec<f32>> {
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
    use farsa_nn::Controller as _;

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
        EvonetNetwork::new(evonet, [3, 2], weights, &BTreeMap::new(), &Source::new("own.toml"))
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
