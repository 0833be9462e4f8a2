//! Any network.

use std::collections::BTreeMap;

use farsa_lab::{Error, Intervention, OwnedNetwork, Parameter, resting_network};
use farsa_nn::block::{Architecture, BlockLayoutBuf, BlockNetwork, BlockParameter};
use farsa_nn::{Controller, Ctrnn, CtrnnLayout, CtrnnParameter, Leak, LeakyLayout, LeakyParameter, Perceptron};

use crate::check::places::Places;
use crate::document::{Document, Network, NetworkKind, WeightOrder, Wire};
use crate::parts::blocks;
use crate::parts::bounded::bounded;
use crate::parts::ends::Ends;
use crate::parts::evonet::EvonetNetwork;
use crate::parts::kept::kept;
use crate::parts::wired::Wired;

/// A network, and how the parameters that are searched for become its own.
#[derive(Clone, Debug)]
pub(crate) enum AnyNetwork {
    Perceptron(Perceptron<Vec<f32>>, WeightOrder),
    Leaky(OwnedNetwork),
    Ctrnn(Ctrnn<Vec<f32>, Vec<f32>>),
    Block(BlockNetwork<'static, Vec<f32>, Vec<f32>>),
    Wired(Wired),
    Evonet(EvonetNetwork),
}

impl AnyNetwork {
    /// The network of a document at rest, between these inputs and outputs.
    ///
    /// # Errors
    /// [`Error::Setting`] for numbers of which no network can be made, and those of [`Wired::new`], [`blocks::layout`] and
    /// [`EvonetNetwork::new`].
    pub(crate) fn new(document: &Document, ends: Ends<'_>, places: &Places) -> Result<Self, Error> {
        let made = Self::between(document, ends, places);
        made.map_err(|error| if let Error::Other(why) = error { places.wrong("/network", why) } else { error })
    }

    fn between(document: &Document, ends: Ends<'_>, places: &Places) -> Result<Self, Error> {
        let Document { network, files, .. } = document;
        let [inputs, outputs] = [ends.inputs.len(), ends.outputs.len()];
        let architecture = match &network.kind {
            NetworkKind::Wired { bias, activation, wires, .. } => {
                return Ok(Self::Wired(Wired::new(wires, bias, *activation, ends, places)?));
            }
            NetworkKind::Evonet(evonet) => {
                return Ok(Self::Evonet(EvonetNetwork::new(
                    evonet,
                    [inputs, outputs],
                    network.weights,
                    files,
                    places,
                )?));
            }
            NetworkKind::Blocks(own) => return Self::of_blocks(blocks::layout(own, ends, places)?),
            &NetworkKind::Perceptron { order } => {
                bounded(Perceptron::parameter_count(inputs, outputs), 0)?;
                let parameters = vec![0.0; Perceptron::parameter_count(inputs, outputs)];
                return Ok(Self::Perceptron(Perceptron::new(inputs, outputs, 1.0, parameters)?, order));
            }
            &NetworkKind::Leaky { hidden, slope, .. } => {
                let layout = LeakyLayout::new(inputs, hidden as usize, outputs).with_slope(slope as f32);
                bounded(layout.parameter_count(), layout.state_len())?;
                return Ok(Self::Leaky(resting_network(&layout)?));
            }
            &NetworkKind::Ctrnn { neurons, time_constants } => {
                let neurons = neurons as usize;
                if neurons < outputs {
                    return Err(Error::Other(format!("{neurons} neurons where the motors want {outputs} outputs")));
                }
                let layout = CtrnnLayout::new(inputs, neurons, outputs);
                bounded(layout.parameter_count(), layout.state_len())?;
                let time_step = document.world.time_step;
                let own = ctrnn_parameters(&layout, &vec![time_constants[0] as f32; searched(&layout)]);
                let state = vec![0.0; layout.state_len()];
                // Each end makes a network or none.
                let other = ctrnn_parameters(&layout, &vec![time_constants[1] as f32; searched(&layout)]);
                Ctrnn::new(layout, time_step as f32, other, state.clone())?;
                return Ok(Self::Ctrnn(Ctrnn::new(layout, time_step as f32, own, state)?));
            }
            &NetworkKind::FeedForward { hidden } => Architecture::feed_forward(inputs, hidden as usize, outputs),
            &NetworkKind::Elman { hidden } => Architecture::elman(inputs, hidden as usize, outputs),
            &NetworkKind::Jordan { hidden } => Architecture::jordan(inputs, hidden as usize, outputs),
            &NetworkKind::FullyRecurrent { hidden } => Architecture::fully_recurrent(inputs, hidden as usize, outputs),
        };
        Self::of_blocks(architecture.plan().into())
    }

    fn of_blocks(layout: BlockLayoutBuf) -> Result<Self, Error> {
        bounded(layout.layout().parameter_count(), layout.layout().state_len())?;
        let layout = kept(layout).layout();
        let (parameters, state) = (vec![0.0; layout.parameter_count()], vec![0.0; layout.state_len()]);
        Ok(Self::Block(BlockNetwork::new(layout, Leak::Filter, parameters, state)?))
    }

    /// All parameters, with names and ranges.
    pub(crate) fn parameters(&self, network: &Network, ends: Ends<'_>) -> Vec<Parameter> {
        // As networks compute: in single precision.
        let single = |ends: [f64; 2]| ends.map(|end| f64::from(end as f32));
        let weights = single(network.weights);
        match self {
            Self::Perceptron(_, order) => perceptron_parameters(ends, *order, weights),
            Self::Leaky(leaky) => {
                let leaks = if let NetworkKind::Leaky { leaks, .. } = network.kind { leaks } else { [0.0, 1.0] };
                leaky_parameters(leaky.layout(), ends, weights, single(leaks))
            }
            Self::Ctrnn(ctrnn) => {
                let times = if let NetworkKind::Ctrnn { time_constants, .. } = network.kind {
                    time_constants
                } else {
                    [1.0; 2]
                };
                let kinds = ctrnn.layout().kinds().filter(|kind| *kind != CtrnnParameter::Gain);
                numbered(kinds.map(|kind| match kind {
                    CtrnnParameter::TimeConstant => ("time constant", single(times)),
                    CtrnnParameter::Bias => ("bias", weights),
                    CtrnnParameter::InputWeight => ("weight of an input", weights),
                    _ => ("weight", weights),
                }))
            }
            Self::Wired(_) => {
                let NetworkKind::Wired { wires, .. } = &network.kind else { return Vec::new() };
                Wired::named(wires, &wire_names(wires), ends.outputs, weights)
            }
            Self::Block(block) => match &network.kind {
                NetworkKind::Blocks(own) => blocks::parameters(own, block.layout(), ends, [weights, single(own.leaks)]),
                _ => numbered(block.layout().kinds().map(|kind| match kind {
                    BlockParameter::Leak => ("leak", [0.0, 1.0]),
                    BlockParameter::Bias => ("bias", weights),
                    BlockParameter::Gain => ("gain", weights),
                    _ => ("weight", weights),
                })),
            },
            Self::Evonet(evonet) => numbered(evonet.kinds().map(|kind| (kind, weights))),
        }
    }

    /// Parameters that are not searched for unless the document says so, with their values.
    pub(crate) fn given(&self, network: &Network, ends: Ends<'_>) -> BTreeMap<String, f64> {
        match (self, &network.kind) {
            (Self::Evonet(evonet), _) => {
                let given = self.parameters(network, ends).into_iter().zip(evonet.given());
                given.filter_map(|(parameter, value)| Some((parameter.name, f64::from((*value)?)))).collect()
            }
            (_, NetworkKind::Wired { bias, search_bias, wires, .. }) => {
                let names = wire_names(wires);
                let wires = wires.iter().zip(names).filter(|(wire, _)| !wire.searched);
                let wires = wires.map(|(wire, name)| (format!("weight of {name}"), wire.weight));
                let biases = ends.outputs.iter().zip(bias).filter(|_| !search_bias);
                wires.chain(biases.map(|(output, bias)| (format!("bias of {output}"), *bias))).collect()
            }
            _ => BTreeMap::new(),
        }
    }

    /// Takes all its parameters; false for others than the network's.
    pub(crate) fn load(&mut self, parameters: &[f32]) -> bool {
        match self {
            Self::Perceptron(layer, order) => {
                let (inputs, outputs) = (layer.inputs(), layer.outputs());
                if parameters.len() != Perceptron::parameter_count(inputs, outputs) {
                    return false;
                }
                let own = match order {
                    WeightOrder::Inputs => parameters.to_vec(),
                    WeightOrder::Outputs => by_outputs(parameters, [inputs, outputs]),
                };
                Perceptron::new(inputs, outputs, 1.0, own).map(|made| *layer = made).is_ok()
            }
            Self::Leaky(leaky) => leaky.copy_parameters(parameters).is_ok(),
            Self::Ctrnn(ctrnn) => {
                let layout = ctrnn.layout();
                parameters.len() == searched(&layout)
                    && ctrnn.copy_parameters(&ctrnn_parameters(&layout, parameters)).is_ok()
            }
            Self::Block(block) => block.copy_parameters(parameters).is_ok(),
            Self::Wired(wired) => wired.copy_parameters(parameters),
            Self::Evonet(evonet) => evonet.load(parameters),
        }
    }

    /// Changes its own parameters as a test says; false for what makes no network.
    pub(crate) fn edit(&mut self, change: &Intervention) -> bool {
        if change.parameters.is_empty() {
            return true;
        }
        let own = change.edited(self.own_parameters()).into_owned();
        match self {
            Self::Perceptron(layer, _) => {
                Perceptron::new(layer.inputs(), layer.outputs(), 1.0, own).map(|made| *layer = made).is_ok()
            }
            Self::Leaky(leaky) => leaky.copy_parameters(&own).is_ok(),
            Self::Ctrnn(ctrnn) => ctrnn.copy_parameters(&own).is_ok(),
            Self::Block(block) => block.copy_parameters(&own).is_ok(),
            Self::Wired(wired) => wired.copy_parameters(&own),
            Self::Evonet(evonet) => evonet.network.copy_parameters(&own).is_ok(),
        }
    }

    /// The network's own parameters, for the picture of it.
    pub(crate) fn own_parameters(&self) -> &[f32] {
        match self {
            Self::Perceptron(layer, _) => layer.parameters(),
            Self::Leaky(leaky) => leaky.parameters(),
            Self::Ctrnn(ctrnn) => ctrnn.parameters(),
            Self::Block(block) => block.parameters(),
            Self::Wired(wired) => wired.parameters(),
            Self::Evonet(evonet) => evonet.network.parameters(),
        }
    }

    /// How many values it keeps: its own parameters and its state.
    pub(crate) fn kept(&self) -> usize {
        let state = match self {
            Self::Perceptron(..) | Self::Wired(_) => 0,
            Self::Leaky(leaky) => leaky.layout().state_len(),
            Self::Ctrnn(ctrnn) => ctrnn.layout().state_len(),
            Self::Block(block) | Self::Evonet(EvonetNetwork { network: block, .. }) => block.layout().state_len(),
        };
        self.own_parameters().len() + state
    }

    /// What its hidden neurons, or all its neurons, are at.
    pub(crate) fn activations(&self) -> &[f32] {
        match self {
            Self::Perceptron(..) | Self::Wired(_) => &[],
            Self::Leaky(leaky) => leaky.hidden(),
            Self::Ctrnn(ctrnn) => ctrnn.neuron_outputs(),
            Self::Block(block) => block.activations(),
            Self::Evonet(evonet) => evonet.network.activations(),
        }
    }

    /// What it is, in one line.
    pub(crate) fn summary(&self) -> String {
        let (inputs, outputs) = (self.inputs(), self.outputs());
        match self {
            Self::Perceptron(..) => format!("{inputs}-{outputs}, one layer of logistic units without memory"),
            Self::Leaky(leaky) => {
                format!("{inputs}-{}-{outputs}, recurrent hidden layer, leaks as filters", leaky.layout().hidden())
            }
            Self::Ctrnn(ctrnn) => {
                format!(
                    "{inputs}-{outputs}, {} neurons in continuous time, all linked to all",
                    ctrnn.layout().neurons()
                )
            }
            Self::Wired(_) => format!("{inputs}-{outputs}, wired by hand"),
            Self::Block(block) | Self::Evonet(EvonetNetwork { network: block, .. }) => {
                let neurons = block.activations().len().saturating_sub(inputs);
                format!("{inputs}-{outputs}, {neurons} neurons in blocks")
            }
        }
    }
}

impl Controller for AnyNetwork {
    fn inputs(&self) -> usize {
        match self {
            Self::Perceptron(layer, _) => layer.inputs(),
            Self::Leaky(leaky) => leaky.inputs(),
            Self::Ctrnn(ctrnn) => ctrnn.inputs(),
            Self::Block(block) => block.inputs(),
            Self::Wired(wired) => wired.inputs(),
            Self::Evonet(evonet) => evonet.network.inputs(),
        }
    }

    fn outputs(&self) -> usize {
        match self {
            Self::Perceptron(layer, _) => layer.outputs(),
            Self::Leaky(leaky) => leaky.outputs(),
            Self::Ctrnn(ctrnn) => ctrnn.outputs(),
            Self::Block(block) => block.outputs(),
            Self::Wired(wired) => wired.outputs(),
            Self::Evonet(evonet) => evonet.network.outputs(),
        }
    }

    fn reset(&mut self) {
        match self {
            Self::Perceptron(layer, _) => layer.reset(),
            Self::Leaky(leaky) => leaky.reset(),
            Self::Ctrnn(ctrnn) => ctrnn.reset(),
            Self::Block(block) => block.reset(),
            Self::Wired(wired) => wired.reset(),
            Self::Evonet(evonet) => evonet.network.reset(),
        }
    }

    /// Networks without memory are stepped here, without a call.
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
        match self {
            Self::Perceptron(layer, _) => layer.step(x, y),
            Self::Leaky(leaky) => leaky.step(x, y),
            Self::Ctrnn(ctrnn) => ctrnn.step(x, y),
            Self::Block(block) => block.step(x, y),
            Self::Wired(wired) => wired.step(x, y),
            Self::Evonet(evonet) => evonet.network.step(x, y),
        }
    }
}

/// What wires are called.
fn wire_names(wires: &[Wire]) -> Vec<String> {
    let own = |(number, wire): (usize, &Wire)| wire.name.clone().unwrap_or_else(|| format!("wire {}", number + 1));
    wires.iter().enumerate().map(own).collect()
}

/// A layer's own order from that in which the biases come first and then the weights, output by output.
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

/// Parameters by their kind, those of a kind numbered from 1.
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

/// How many of a continuous-time network's parameters are searched for: all but the gains.
fn searched(layout: &CtrnnLayout) -> usize {
    layout.parameter_count() - layout.neurons()
}

/// All parameters of a continuous-time network: those that are searched for, and gains of 1.
fn ctrnn_parameters(layout: &CtrnnLayout, searched: &[f32]) -> Vec<f32> {
    let mut searched = searched.iter().copied();
    let own = |kind| if kind == CtrnnParameter::Gain { 1.0 } else { searched.next().unwrap_or(0.0) };
    layout.kinds().map(own).collect()
}
