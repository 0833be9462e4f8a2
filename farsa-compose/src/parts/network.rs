//! A network of any kind.

use std::borrow::Cow;
use std::collections::BTreeMap;

use farsa_lab::advanced::{Intervention, OwnedNetwork, resting_network};
use farsa_lab::{Error, Parameter};
use farsa_nn::block::{Architecture, BlockLayoutBuf, BlockNetwork, BlockParameter};
use farsa_nn::{
    Ablatable, Controller, Ctrnn, CtrnnLayout, CtrnnParameter, Leak, LeakyLayout, LeakyParameter, Lesion, Perceptron,
};

use crate::check::source::Source;
use crate::document::{Document, NetworkKind, WeightOrder, Wire};
use crate::part::definition::Build;
use crate::part::network::{AnyPartNetwork, Built};
use crate::parts::blocks;
use crate::parts::ends::Ends;
use crate::parts::evonet::EvonetNetwork;
use crate::parts::hand_wired::HandWired;
use crate::parts::reflex::ReflexController;
use crate::parts::static_layout::static_layout;

type Blocks = BlockNetwork<'static, Vec<f32>, Vec<f32>>;

/// A network, with the order in which a search has its parameters.
#[derive(Clone, Debug)]
pub(crate) enum AnyNetwork {
    Perceptron(Perceptron<Vec<f32>>, WeightOrder),
    Leaky(OwnedNetwork),
    Ctrnn(Ctrnn<Vec<f32>, Vec<f32>>),
    Block(Blocks),
    HandWired(HandWired),
    Evonet(EvonetNetwork),
    Reflex(ReflexController),
    Registered(Box<dyn AnyPartNetwork>),
}

/// Parameters of a network in the order of a search.
pub(crate) struct Named {
    pub(crate) parameters: Vec<Parameter>,
    /// Values that are fixed unless the document searches them.
    pub(crate) given: BTreeMap<String, f64>,
}

impl From<Vec<Parameter>> for Named {
    fn from(parameters: Vec<Parameter>) -> Self {
        Self { parameters, given: BTreeMap::new() }
    }
}

impl AnyNetwork {
    /// Builds the network of a document at rest, with its named parameters.
    pub(crate) fn new(document: &Document, ends: Ends<'_>, source: &Source) -> Result<(Self, Named), Error> {
        let made = Self::between(document, ends, source);
        made.map_err(|error| if let Error::Other(why) = error { source.wrong("/network", why) } else { error })
    }

    fn between(document: &Document, ends: Ends<'_>, source: &Source) -> Result<(Self, Named), Error> {
        let Document { network, files, .. } = document;
        let [inputs, outputs] = [ends.inputs.len(), ends.outputs.len()];
        let weights = single(network.weights);
        let architecture = match &network.kind {
            NetworkKind::Wired { bias, activation, wires, search_bias } => {
                let names = wire_names(wires);
                let parameters = HandWired::named(wires, &names, ends.outputs, weights);
                let fixed = wires.iter().zip(names).filter(|(wire, _)| !wire.searched);
                let fixed = fixed.map(|(wire, name)| (format!("weight of {name}"), wire.weight));
                let biases = ends.outputs.iter().zip(bias).filter(|_| !search_bias);
                let given = fixed.chain(biases.map(|(output, bias)| (format!("bias of {output}"), *bias))).collect();
                let wired = HandWired::new(wires, bias, *activation, ends, source)?;
                return Ok((Self::HandWired(wired), Named { parameters, given }));
            }
            NetworkKind::Evonet(evonet) => {
                let made = EvonetNetwork::new(evonet, [inputs, outputs], network.weights, files, source)?;
                let parameters = numbered(made.kinds().map(|kind| (kind, weights)));
                let given = parameters.iter().zip(made.given());
                let given =
                    given.filter_map(|(known, value)| Some((known.name.clone(), f64::from((*value)?)))).collect();
                return Ok((Self::Evonet(made), Named { parameters, given }));
            }
            NetworkKind::Blocks(blocks) => {
                let block = from_blocks(blocks::layout(blocks, ends, source)?, source)?;
                let parameters = blocks::parameters(blocks, block.layout(), ends, [weights, single(blocks.leaks)]);
                return Ok((Self::Block(block), parameters.into()));
            }
            &NetworkKind::Perceptron { order } => {
                source.limits.check_network(Perceptron::parameter_count(inputs, outputs), 0)?;
                let parameters = vec![0.0; Perceptron::parameter_count(inputs, outputs)];
                let layer = Perceptron::new(inputs, outputs, 1.0, parameters)?;
                return Ok((Self::Perceptron(layer, order), perceptron_parameters(ends, order, weights).into()));
            }
            &NetworkKind::Leaky { hidden, slope, leaks } => {
                let layout = LeakyLayout::new(inputs, hidden as usize, outputs).with_slope(slope as f32);
                source.limits.check_network(layout.parameter_count(), layout.state_len())?;
                let parameters = leaky_parameters(layout, ends, weights, single(leaks));
                return Ok((Self::Leaky(resting_network(&layout)?), parameters.into()));
            }
            &NetworkKind::Ctrnn { neurons, time_constants } => {
                let neurons = neurons as usize;
                if neurons < outputs {
                    return Err(Error::Other(format!("{neurons} neurons where the motors want {outputs} outputs")));
                }
                let layout = CtrnnLayout::new(inputs, neurons, outputs);
                source.limits.check_network(layout.parameter_count(), layout.state_len())?;
                let with = |time_constant: f64| {
                    let parameters = ctrnn_parameters(&layout, &vec![time_constant as f32; searched(&layout)]);
                    let time_step = document.world.time_step as f32;
                    Ctrnn::new(layout, time_step, parameters, vec![0.0; layout.state_len()])
                };
                // Both ends of the range must be valid.
                with(time_constants[1])?;
                let kinds = layout.kinds().filter(|kind| *kind != CtrnnParameter::Gain);
                let parameters = numbered(kinds.map(|kind| match kind {
                    CtrnnParameter::TimeConstant => ("time constant", single(time_constants)),
                    CtrnnParameter::Bias => ("bias", weights),
                    CtrnnParameter::InputWeight => ("weight of an input", weights),
                    _ => ("weight", weights),
                }));
                return Ok((Self::Ctrnn(with(time_constants[0])?), parameters.into()));
            }
            NetworkKind::Registered { kind, keys } => {
                let build = source.registry.find(kind, |build| match build {
                    Build::Network(build) => Some(*build),
                    _ => None,
                });
                let build = build.ok_or_else(|| Error::Other(format!("`{kind}` is no network")))?;
                let Built { network, parameters } = build(keys, [inputs, outputs], document.world.time_step)?;
                source.limits.check_network(parameters.len(), network.neurons())?;
                return Ok((Self::Registered(network), parameters.into()));
            }
            &NetworkKind::FeedForward { hidden } => Architecture::feed_forward(inputs, hidden as usize, outputs),
            &NetworkKind::Elman { hidden } => Architecture::elman(inputs, hidden as usize, outputs),
            &NetworkKind::Jordan { hidden } => Architecture::jordan(inputs, hidden as usize, outputs),
            &NetworkKind::FullyRecurrent { hidden } => Architecture::fully_recurrent(inputs, hidden as usize, outputs),
        };
        let block = from_blocks(architecture.plan().into(), source)?;
        let parameters = numbered(block.layout().kinds().map(|kind| match kind {
            BlockParameter::Leak => ("leak", [0.0, 1.0]),
            BlockParameter::Bias => ("bias", weights),
            BlockParameter::Gain => ("gain", weights),
            _ => ("weight", weights),
        }));
        Ok((Self::Block(block), parameters.into()))
    }

    /// Loads the parameters of a search. Returns false for another number of them or for values out of range.
    pub(crate) fn load(&mut self, parameters: &[f32]) -> bool {
        let ordered = match self {
            Self::Perceptron(layer, WeightOrder::Outputs) => {
                let shape = [layer.inputs(), layer.outputs()];
                let fits = parameters.len() == Perceptron::parameter_count(shape[0], shape[1]);
                fits.then(|| by_outputs(parameters, shape).into())
            }
            Self::Ctrnn(ctrnn) => {
                let layout = ctrnn.layout();
                (parameters.len() == searched(&layout)).then(|| ctrnn_parameters(&layout, parameters).into())
            }
            Self::Evonet(evonet) => evonet.decode(parameters).map(Cow::from),
            _ => Some(parameters.into()),
        };
        ordered.is_some_and(|ordered: Cow<'_, [f32]>| self.copy_parameters(&ordered))
    }

    /// Edits the network's parameters for a test. Returns false for values out of range.
    pub(crate) fn edit(&mut self, change: &Intervention) -> bool {
        change.parameters.is_empty() || {
            let edited = change.edited(self.own_parameters()).into_owned();
            self.copy_parameters(&edited)
        }
    }

    /// Copies parameters in the network's own order.
    fn copy_parameters(&mut self, parameters: &[f32]) -> bool {
        match self {
            Self::Perceptron(layer, _) => {
                let made = Perceptron::new(layer.inputs(), layer.outputs(), 1.0, parameters.to_vec());
                made.map(|made| *layer = made).is_ok()
            }
            Self::Leaky(leaky) => leaky.copy_parameters(parameters).is_ok(),
            Self::Ctrnn(ctrnn) => ctrnn.copy_parameters(parameters).is_ok(),
            Self::Block(block) | Self::Evonet(EvonetNetwork { network: block, .. }) => {
                block.copy_parameters(parameters).is_ok()
            }
            Self::HandWired(wired) => wired.copy_parameters(parameters),
            Self::Reflex(_) => true,
            Self::Registered(network) => network.copy_parameters(parameters),
        }
    }

    /// Returns the parameters in the network's own order.
    pub(crate) fn own_parameters(&self) -> &[f32] {
        match self {
            Self::Perceptron(layer, _) => layer.parameters(),
            Self::Leaky(leaky) => leaky.parameters(),
            Self::Ctrnn(ctrnn) => ctrnn.parameters(),
            Self::Block(block) | Self::Evonet(EvonetNetwork { network: block, .. }) => block.parameters(),
            Self::HandWired(wired) => wired.parameters(),
            Self::Reflex(_) => &[],
            Self::Registered(network) => network.parameters(),
        }
    }

    /// Gets the number of values that the network keeps: parameters and state.
    pub(crate) fn values(&self) -> usize {
        let state = match self {
            Self::Perceptron(..) | Self::HandWired(_) | Self::Reflex(_) => 0,
            Self::Registered(network) => network.neurons(),
            Self::Leaky(leaky) => leaky.layout().state_len(),
            Self::Ctrnn(ctrnn) => ctrnn.layout().state_len(),
            Self::Block(block) | Self::Evonet(EvonetNetwork { network: block, .. }) => block.layout().state_len(),
        };
        self.own_parameters().len() + state
    }

    /// Returns the activations of the hidden neurons of a leaky network, and of all neurons of the others.
    pub(crate) fn activations(&self) -> &[f32] {
        match self {
            Self::Perceptron(..) | Self::HandWired(_) | Self::Reflex(_) => &[],
            Self::Registered(network) => network.activations(),
            Self::Leaky(leaky) => leaky.hidden(),
            Self::Ctrnn(ctrnn) => ctrnn.neuron_outputs(),
            Self::Block(block) | Self::Evonet(EvonetNetwork { network: block, .. }) => block.activations(),
        }
    }

    /// Describes the network in one line.
    pub(crate) fn summary(&self) -> String {
        let shape = format!("{}-{}", self.inputs(), self.outputs());
        match self {
            Self::Perceptron(..) => format!("{shape}, one layer of logistic units without memory"),
            Self::Leaky(leaky) => {
                let [inputs, hidden, outputs] = [self.inputs(), leaky.layout().hidden(), self.outputs()];
                format!("{inputs}-{hidden}-{outputs}, recurrent hidden layer, leaks as filters")
            }
            Self::Ctrnn(ctrnn) => {
                format!("{shape}, {} neurons in continuous time, all linked to all", ctrnn.layout().neurons())
            }
            Self::HandWired(_) | Self::Reflex(_) => format!("{shape}, wired by hand"),
            Self::Registered(network) => format!("{shape}, {} neurons of a registered network", network.neurons()),
            Self::Block(_) | Self::Evonet(_) => {
                format!("{shape}, {} neurons in blocks", self.activations().len().saturating_sub(self.inputs()))
            }
        }
    }

    /// Gets the network for calls that are not in the loop of a trial.
    fn kind(&self) -> &dyn Ablatable {
        match self {
            Self::Perceptron(layer, _) => layer,
            Self::Leaky(leaky) => leaky,
            Self::Ctrnn(ctrnn) => ctrnn,
            Self::Block(block) | Self::Evonet(EvonetNetwork { network: block, .. }) => block,
            Self::HandWired(wired) => wired,
            Self::Reflex(reflex) => reflex,
            Self::Registered(network) => &**network,
        }
    }

    fn kind_mut(&mut self) -> &mut dyn Ablatable {
        match self {
            Self::Perceptron(layer, _) => layer,
            Self::Leaky(leaky) => leaky,
            Self::Ctrnn(ctrnn) => ctrnn,
            Self::Block(block) | Self::Evonet(EvonetNetwork { network: block, .. }) => block,
            Self::HandWired(wired) => wired,
            Self::Reflex(reflex) => reflex,
            Self::Registered(network) => &mut **network,
        }
    }
}

impl Controller for AnyNetwork {
    fn inputs(&self) -> usize {
        self.kind().inputs()
    }

    fn outputs(&self) -> usize {
        self.kind().outputs()
    }

    fn reset(&mut self) {
        self.kind_mut().reset();
    }

    /// Steps a perceptron inline, because an indirect call costs more than its sums.
    #[inline(always)]
    fn step(&mut self, x: &[f32], y: &mut [f32]) {
        if let Self::Perceptron(layer, _) = self {
            layer.step(x, y);
        } else {
            self.step_other(x, y);
        }
    }
}

impl AnyNetwork {
    #[inline(never)]
    fn step_other(&mut self, x: &[f32], y: &mut [f32]) {
        self.kind_mut().step(x, y);
    }
}

impl Ablatable for AnyNetwork {
    fn neurons(&self) -> usize {
        self.kind().neurons()
    }

    fn step_ablated(&mut self, lesions: &[Lesion], x: &[f32], y: &mut [f32]) {
        self.kind_mut().step_ablated(lesions, x, y);
    }
}

/// Rounds a range to single precision, in which networks compute.
fn single(ends: [f64; 2]) -> [f64; 2] {
    ends.map(|end| f64::from(end as f32))
}

fn from_blocks(layout: BlockLayoutBuf, source: &Source) -> Result<Blocks, Error> {
    source.limits.check_network(layout.layout().parameter_count(), layout.layout().state_len())?;
    let layout = static_layout(layout).layout();
    let (parameters, state) = (vec![0.0; layout.parameter_count()], vec![0.0; layout.state_len()]);
    Ok(BlockNetwork::new(layout, Leak::Filter, parameters, state)?)
}

/// Names the wires.
fn wire_names(wires: &[Wire]) -> Vec<String> {
    let name = |(number, wire): (usize, &Wire)| wire.name.clone().unwrap_or_else(|| format!("wire {}", number + 1));
    wires.iter().enumerate().map(name).collect()
}

/// Reorders parameters from biases and weights output by output to weights input by input and biases.
fn by_outputs(parameters: &[f32], [inputs, outputs]: [usize; 2]) -> Vec<f32> {
    let weight = |input: usize, output: usize| parameters[outputs + output * inputs + input];
    let weights = (0..inputs).flat_map(|input| (0..outputs).map(move |output| weight(input, output)));
    weights.chain(parameters[..outputs].iter().copied()).collect()
}

fn perceptron_parameters(ends: Ends<'_>, order: WeightOrder, range: [f64; 2]) -> Vec<Parameter> {
    let Ends { inputs, outputs, .. } = ends;
    let weight = |input: &String, output: &String| Parameter::new(format!("weight of {input} on {output}"), range);
    let biases = outputs.iter().map(|output| Parameter::new(format!("bias of {output}"), range));
    match order {
        WeightOrder::Inputs => {
            inputs.iter().flat_map(|x| outputs.iter().map(move |y| weight(x, y))).chain(biases).collect()
        }
        WeightOrder::Outputs => {
            biases.chain(outputs.iter().flat_map(|y| inputs.iter().map(move |x| weight(x, y)))).collect()
        }
    }
}

fn leaky_parameters(layout: LeakyLayout, ends: Ends<'_>, weights: [f64; 2], leaks: [f64; 2]) -> Vec<Parameter> {
    let (hidden, outputs) = (layout.hidden().max(1), layout.outputs().max(1));
    let of_kind = |kind: LeakyParameter| {
        let name = move |index: usize| match kind {
            LeakyParameter::SensorWeight => {
                format!("weight of {} on neuron {}", ends.inputs[index / hidden], index % hidden + 1)
            }
            LeakyParameter::RecurrentWeight => {
                format!("weight of neuron {} on neuron {}", index / hidden + 1, index % hidden + 1)
            }
            LeakyParameter::OutputWeight => {
                format!("weight of neuron {} on {}", index / outputs + 1, ends.outputs[index % outputs])
            }
            LeakyParameter::Bias => format!("bias of neuron {}", index + 1),
            _ => format!("leak of neuron {}", index + 1),
        };
        let range = if kind == LeakyParameter::Leak { leaks } else { weights };
        (0..layout.range(kind).len()).map(move |index| Parameter::new(name(index), range))
    };
    LeakyParameter::ALL.into_iter().flat_map(of_kind).collect()
}

/// Names parameters by kind and number.
fn numbered<'k>(kinds: impl Iterator<Item = (&'k str, [f64; 2])>) -> Vec<Parameter> {
    let mut counts: Vec<(&str, usize)> = Vec::new();
    let named = kinds.map(|(kind, range)| {
        let place = counts.iter().position(|(known, _)| *known == kind).unwrap_or_else(|| {
            counts.push((kind, 0));
            counts.len() - 1
        });
        counts[place].1 += 1;
        Parameter::new(format!("{kind} {}", counts[place].1), range)
    });
    named.collect()
}

/// Counts the searched parameters of a CTRNN: all except the gains.
fn searched(layout: &CtrnnLayout) -> usize {
    layout.parameter_count() - layout.neurons()
}

/// Returns all parameters of a CTRNN from the searched ones, with gains of 1.
fn ctrnn_parameters(layout: &CtrnnLayout, searched: &[f32]) -> Vec<f32> {
    let mut searched = searched.iter().copied();
    let parameter = |kind| if kind == CtrnnParameter::Gain { 1.0 } else { searched.next().unwrap_or(0.0) };
    layout.kinds().map(parameter).collect()
}
