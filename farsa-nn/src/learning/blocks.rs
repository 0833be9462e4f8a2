//! Back-propagation through block networks.

use alloc::vec;
use alloc::vec::Vec;

use farsa_num::Real;

use crate::activation::Activation;
use crate::block::description::{Block, Group, Span};
use crate::block::layout::BlockParameter;
use crate::block::network::BlockModel;
use crate::error::Error;
use crate::fault::LayoutFault;
use crate::leak::Leak;
use crate::learning::differentiable::{Demonstration, Differentiable, Domain};
use crate::learning::loss::Loss;
use crate::learning::sums::{activation_slope, add_products, add_rows, add_transposed};

/// A neuron with its group and the indices of its bias, gain and leak, if it has them.
#[derive(Clone, Copy)]
struct Neuron<'a> {
    group: &'a Group,
    bias: Option<usize>,
    gain: Option<usize>,
    leak: Option<usize>,
}

/// Values of all neurons during a tick.
struct State<R> {
    activations: Vec<R>,
    /// Responses of the previous tick.
    previous: Vec<R>,
    net: Vec<R>,
    gains: Vec<R>,
}

impl<R: Real> State<R> {
    fn new(neurons: usize) -> Self {
        let zeros = || vec![R::default(); neurons];
        Self { activations: zeros(), previous: zeros(), net: zeros(), gains: zeros() }
    }
}

/// Delayed values of a connection, `delay` rows of its sources.
type Ring<R> = Vec<R>;

impl<'a> BlockModel<'a> {
    /// Lists the neurons.
    fn neurons_of(&self) -> Vec<Neuron<'a>> {
        let layout = self.layout;
        let first = |kind| layout.range(kind).start;
        let [biases, gains, leaks] = [BlockParameter::Bias, BlockParameter::Gain, BlockParameter::Leak].map(first);
        let neurons = layout.places().flat_map(|(group, span, [bias, gain, leak])| {
            (0..span.count).map(move |index| Neuron {
                group,
                bias: group.bias.then_some(biases + bias + index),
                gain: group.gain.then_some(gains + gain + index),
                leak: group.leak.then_some(leaks + leak + index),
            })
        });
        neurons.collect()
    }

    /// Lists the blocks with the first weight of each.
    fn blocks_with_weights(&self) -> Vec<(Block, usize)> {
        let mut first = 0;
        let block = |block: &Block| {
            first += block.weights();
            (*block, first - block.weights())
        };
        self.layout.blocks().iter().map(block).collect()
    }

    /// Builds the rings of delayed connections.
    fn rings<R: Real>(&self) -> Vec<Ring<R>> {
        let ring = |block: &Block| match block {
            Block::Connect { from, delay, .. } => vec![R::default(); delay * from.count],
            _ => Vec::new(),
        };
        self.layout.blocks().iter().map(ring).collect()
    }

    /// Returns the number of outputs' first neuron.
    fn first_output(&self) -> usize {
        self.layout.neurons() - self.layout.outputs()
    }

    /// Computes an activation from response, previous activation and previous response.
    fn leaky<R: Real>(&self, d: R, [response, activation, previous]: [R; 3]) -> R {
        let one = R::from_f64(1.0);
        match self.leak {
            Leak::Filter => d * response + (one - d) * activation,
            Leak::TwoTap => d * response + (one - d) * previous,
            Leak::Evonet => d * activation + (one - d) * response,
        }
    }

    /// Updates a span and stores responses, activations and previous responses before it.
    fn update<R: Real>(
        &self,
        (neurons, parameters): (&[Neuron<'_>], &[R]),
        span: Span,
        x: &[f32],
        state: &mut State<R>,
        trace: &mut Vec<R>,
    ) {
        for i in span.first..span.end() {
            let group = neurons[i].group;
            let net = R::from_f64(f64::from(group.slope)) * state.net[i];
            let response =
                if i < self.layout.inputs() { R::from_f64(f64::from(x[i])) } else { group.activation.apply_lanes(net) };
            let before = [response, state.activations[i], state.previous[i]];
            trace.extend(before);
            if let Some(leak) = neurons[i].leak {
                state.activations[i] = self.leaky(parameters[leak], before);
                if self.leak == Leak::TwoTap {
                    state.previous[i] = response;
                }
            } else {
                state.activations[i] = response;
            }
        }
    }

    /// Propagates the derivatives of a span back through its update.
    fn update_back<R: Real>(
        &self,
        (neurons, parameters): (&[Neuron<'_>], &[R]),
        span: Span,
        (flow, to_motors): (&mut State<R>, &mut [R]),
        trace: &[R],
        sum: &mut [R],
    ) {
        let one = R::from_f64(1.0);
        for (i, before) in (span.first..span.end()).zip(trace.chunks_exact(3)) {
            let [response, activation, previous] = [before[0], before[1], before[2]];
            let flow_in = flow.activations[i];
            let mut to_response = flow_in;
            flow.activations[i] = R::default();
            if let Some(leak) = neurons[i].leak {
                let d = parameters[leak];
                let (share, kept) = if self.leak == Leak::Evonet { (one - d, d) } else { (d, one - d) };
                let stays = if self.leak == Leak::TwoTap { previous } else { activation };
                let by_leak = if self.leak == Leak::Evonet { stays - response } else { response - stays };
                sum[leak] += flow_in * by_leak;
                to_response = share * flow_in;
                if self.leak == Leak::TwoTap {
                    // The response is also the previous one of the next update.
                    to_response += flow.previous[i];
                    flow.previous[i] = kept * flow_in;
                } else {
                    flow.activations[i] = kept * flow_in;
                }
            }
            if i >= self.layout.inputs() {
                let slope = R::from_f64(f64::from(neurons[i].group.slope));
                let mut to_net = to_response * activation_slope(neurons[i].group.activation, response);
                if let Some(motor) = i.checked_sub(self.first_output()) {
                    to_net += core::mem::take(&mut to_motors[motor]);
                }
                flow.net[i] += slope * to_net;
            }
        }
    }

    /// Returns true for an output whose motor value is the value of its activation function.
    fn is_direct(&self, neuron: &Neuron<'_>, index: usize) -> bool {
        neuron.leak.is_none() && index >= self.layout.inputs()
    }
}

impl Differentiable for BlockModel<'_> {
    fn parameter_count(&self) -> usize {
        self.layout.parameter_count()
    }

    fn check(&self, loss: Loss) -> Result<(), Error> {
        self.layout.check()?;
        let neurons = self.neurons_of();
        let mut outputs = neurons.iter().enumerate().skip(self.first_output());
        let logistic = |(index, neuron): (usize, &Neuron<'_>)| {
            self.is_direct(neuron, index) && neuron.group.activation == Activation::Logistic
        };
        if loss == Loss::CrossEntropy && !outputs.all(logistic) {
            return Err(LayoutFault::Loss.into());
        }
        Ok(())
    }

    fn domain(&self, index: usize) -> Domain {
        if self.layout.kind(index) == Some(BlockParameter::Leak) { Domain::Share } else { Domain::Any }
    }

    /// The trace has for each block of each tick: of a connection its sent values, and the activations and gains of its
    /// sources, of an update three values per neuron, and at the end of a tick the net inputs and motor values.
    fn run<R: Real>(
        &self,
        loss: Loss,
        parameters: &[R],
        of @ Demonstration { x, wanted }: Demonstration<'_>,
        trace: &mut Vec<R>,
    ) -> R {
        let (n, o, neurons) = (self.layout.inputs(), self.layout.outputs(), self.neurons_of());
        let (blocks, mut rings) = (self.blocks_with_weights(), self.rings::<R>());
        let mut state = State::<R>::new(neurons.len());
        let ticks = of.ticks(n, o);
        let mut cost = R::default();
        trace.clear();
        for tick in 0..ticks {
            for (i, neuron) in neurons.iter().enumerate() {
                state.net[i] = neuron.bias.map_or(R::default(), |bias| parameters[bias]);
                state.gains[i] = neuron.gain.map_or(R::from_f64(1.0), |gain| parameters[gain]);
            }
            for ((block, weights), ring) in blocks.iter().zip(&mut rings) {
                match *block {
                    Block::Connect { from, to, delay } => {
                        let sources = from.first..from.end();
                        let mut sent: Vec<R> = sources.clone().map(|j| state.activations[j] * state.gains[j]).collect();
                        if delay > 0 {
                            let place = tick % delay * from.count;
                            sent.swap_with_slice(&mut ring[place..place + from.count]);
                        }
                        add_rows(&mut state.net[to.first..to.end()], sent.iter().copied(), &parameters[*weights..]);
                        trace.extend(sent);
                        trace.extend(&state.activations[sources.clone()]);
                        trace.extend(&state.gains[sources]);
                    }
                    Block::Update(span) => {
                        let x = &x[tick * n..(tick + 1) * n];
                        self.update((&neurons, parameters), span, x, &mut state, trace);
                    }
                    Block::Gain(span) => {
                        let gain = state.gains[span.first];
                        state.gains[span.first..span.end()].fill(gain);
                    }
                    Block::ModulatedGain { neurons: span, by } => {
                        let gain = state.activations[by];
                        state.gains[span.first..span.end()].fill(gain);
                    }
                }
            }
            for (motor, wanted) in wanted[tick * o..(tick + 1) * o].iter().enumerate() {
                let i = self.first_output() + motor;
                let net = R::from_f64(f64::from(neurons[i].group.slope)) * state.net[i];
                cost += loss.cost(net, state.activations[i], R::from_f64(f64::from(*wanted)));
                trace.push(state.activations[i]);
            }
        }
        cost
    }

    fn follow_back<R: Real>(
        &self,
        loss: Loss,
        parameters: &[R],
        of @ Demonstration { wanted, .. }: Demonstration<'_>,
        mut trace: &[R],
        sum: &mut [R],
    ) {
        let (n, o, neurons) = (self.layout.inputs(), self.layout.outputs(), self.neurons_of());
        let (blocks, mut rings) = (self.blocks_with_weights(), self.rings::<R>());
        let ticks = of.ticks(n, o);
        let mut flow = State::<R>::new(neurons.len());
        let mut to_motors = vec![R::default(); o];
        // Splits the values of a block off the end of the trace.
        let mut take = |count: usize| {
            let (rest, taken) = trace.split_at(trace.len() - count);
            trace = rest;
            taken
        };
        for tick in (0..ticks).rev() {
            let motors = take(o);
            flow.net.fill(R::default());
            flow.gains.fill(R::default());
            for (motor, (value, wanted)) in motors.iter().zip(&wanted[tick * o..]).enumerate() {
                let (i, wanted) = (self.first_output() + motor, R::from_f64(f64::from(*wanted)));
                if self.is_direct(&neurons[i], i) {
                    // By the argument of the function: cross entropy has no finite derivative by its value.
                    to_motors[motor] = loss.slope_of(neurons[i].group.activation, *value, wanted);
                } else {
                    flow.activations[i] += R::from_f64(2.0) * (*value - wanted);
                }
            }
            for ((block, weights), ring) in blocks.iter().zip(&mut rings).rev() {
                match *block {
                    Block::Connect { from, to, delay } => {
                        let (sent, rest) = take(3 * from.count).split_at(from.count);
                        let (activations, gains) = rest.split_at(from.count);
                        let through = &flow.net[to.first..to.end()];
                        add_products(&mut sum[*weights..*weights + block.weights()], sent.iter().copied(), through);
                        let mut to_sent = vec![R::default(); from.count];
                        add_transposed(&mut to_sent, &parameters[*weights..*weights + block.weights()], through);
                        if delay > 0 {
                            // The sent values came from `delay` ticks before.
                            let place = tick % delay * from.count;
                            to_sent.swap_with_slice(&mut ring[place..place + from.count]);
                        }
                        for (j, to_sent) in to_sent.iter().enumerate() {
                            flow.activations[from.first + j] += *to_sent * gains[j];
                            flow.gains[from.first + j] += *to_sent * activations[j];
                        }
                    }
                    Block::Update(span) => {
                        let values = take(3 * span.count);
                        let flows = (&mut flow, &mut to_motors[..]);
                        self.update_back((&neurons, parameters), span, flows, values, sum);
                    }
                    Block::Gain(span) => {
                        let flows = &mut flow.gains[span.first..span.end()];
                        let total = flows.iter().fold(R::default(), |total, flow| total + *flow);
                        flows.fill(R::default());
                        flow.gains[span.first] = total;
                    }
                    Block::ModulatedGain { neurons: span, by } => {
                        let flows = &mut flow.gains[span.first..span.end()];
                        let total = flows.iter().fold(R::default(), |total, flow| total + *flow);
                        flows.fill(R::default());
                        flow.activations[by] += total;
                    }
                }
            }
            for (i, neuron) in neurons.iter().enumerate() {
                if let Some(bias) = neuron.bias {
                    sum[bias] += flow.net[i];
                }
                if let Some(gain) = neuron.gain {
                    sum[gain] += flow.gains[i];
                }
            }
        }
    }
}
