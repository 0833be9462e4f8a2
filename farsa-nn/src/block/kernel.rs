//! One step of a block network, computed for the lanes of a [`Scalar`]. As in the kernel of layers, each lane is a
//! target.

use farsa_num::{Scalar, logistic};

use crate::activation::Activation;
use crate::block::description::{Block, Span};
use crate::block::layout::{BlockLayout, BlockParameter};
use crate::kernel::{Lanes, Layer, prefix};
use crate::leak::Leak;
use crate::lesion::{Lesion, hold};

/// The data of a step. All slices except parameters, inputs and delays are `[neurons]`.
pub(crate) struct Blocks<'a> {
    pub(crate) layout: BlockLayout<'a>,
    pub(crate) leak: Leak,
    pub(crate) parameters: &'a [f32],
    pub(crate) lesions: &'a [Lesion],
    pub(crate) x: &'a [f32],
    pub(crate) activations: &'a mut [f32],
    /// Responses of the previous step.
    pub(crate) previous: &'a mut [f32],
    pub(crate) net: &'a mut [f32],
    pub(crate) gains: &'a mut [f32],
    /// Values of the sources of a connection.
    pub(crate) sent: &'a mut [f32],
    /// Initial sums, then the responses.
    pub(crate) work: &'a mut [f32],
    /// Index of the oldest value and the delayed values of each delayed connection.
    pub(crate) delays: &'a mut [f32],
}

impl Lanes for Blocks<'_> {
    fn widest(&self) -> usize {
        self.net.len()
    }

    #[inline(always)]
    fn run<S: Scalar<Real = f32>>(&mut self, simd: S::Simd) {
        self.begin();
        let (mut weights, mut delays) = (0, 0);
        for block in self.layout.blocks() {
            match *block {
                Block::Connect { from, to, delay } => {
                    self.send(from, delay, delays);
                    self.connect::<S>(simd, from, to, weights);
                }
                Block::Update(span) => self.update::<S>(simd, span),
                Block::Gain(span) => self.set_gains(span, self.gains.get(span.first).copied()),
                Block::ModulatedGain { neurons, by } => self.set_gains(neurons, self.activations.get(by).copied()),
            }
            weights += block.weights();
            delays += block.memory();
        }
    }
}

impl Blocks<'_> {
    /// Initializes net inputs by the biases, and gains by the parameters.
    fn begin(&mut self) {
        hold(self.lesions, 0, self.activations);
        self.net.fill(0.0);
        self.gains.fill(1.0);
        let (parameters, layout) = (self.parameters, self.layout);
        let [biases, gains] = [BlockParameter::Bias, BlockParameter::Gain].map(|kind| part(parameters, &layout, kind));
        for (group, span, [bias, gain, _]) in layout.places() {
            if group.bias {
                copy(biases, bias, self.net, span);
            }
            if group.gain {
                copy(gains, gain, self.gains, span);
            }
        }
    }

    /// Stores the values of the sources: activations times gains, current or delayed.
    fn send(&mut self, from: Span, delay: usize, delays: usize) {
        let sources = self.activations.iter().zip(&*self.gains).skip(from.first).take(from.count);
        let sent = self.sent.iter_mut();
        if delay == 0 {
            sent.zip(sources).for_each(|(sent, (activation, gain))| *sent = activation * gain);
            return;
        }
        let Some((oldest, ring)) = self.delays.get_mut(delays..).and_then(<[f32]>::split_first_mut) else { return };
        // A ring of `delay` rows: the newest row replaces the oldest one.
        let place = (*oldest as usize).min(delay - 1);
        let values = ring.iter_mut().skip(place * from.count);
        for ((sent, (activation, gain)), value) in sent.zip(sources).zip(values) {
            *sent = core::mem::replace(value, activation * gain);
        }
        *oldest = ((place + 1) % delay) as f32;
    }

    #[inline(always)]
    fn connect<S: Scalar<Real = f32>>(&mut self, simd: S::Simd, from: Span, to: Span, weights: usize) {
        let sent = prefix(self.sent, from.count);
        let (Some(weights), Some(net)) = (self.parameters.get(weights..), self.net.get_mut(to.first..to.end())) else {
            return;
        };
        // Several connections may reach one target. Each starts from the sum of the previous ones.
        let start = prefix(self.work, to.count);
        start.copy_from_slice(net);
        let layer = Layer { targets: to.count, slope: 1.0, biases: start, sources: [(sent, weights), (&[], &[])] };
        // Fewer targets than lanes are summed one by one, with the same bits.
        if to.count < S::LANES {
            layer.all_sums::<f32>((), net);
        } else {
            layer.all_sums::<S>(simd, net);
        }
    }

    #[inline(always)]
    fn update<S: Scalar<Real = f32>>(&mut self, simd: S::Simd, span: Span) {
        let leaks = part(self.parameters, &self.layout, BlockParameter::Leak);
        // A span may cover parts of several groups with different activations and leaks.
        for (group, all, [_, _, leak]) in self.layout.places() {
            let first = span.first.max(all.first);
            let own = first..span.end().min(all.end());
            let (Some(net), Some(work)) = (self.net.get(own.clone()), self.work.get_mut(own.clone())) else { continue };
            let inputs = self.x.get(first..).unwrap_or(&[]);
            activate::<S>(simd, group.activation, group.slope, net, work);
            // The response of an input neuron is its input, or zero if the input is missing.
            let neurons = first..self.layout.inputs();
            for ((response, _), x) in work.iter_mut().zip(neurons).zip(inputs.iter().chain(core::iter::repeat(&0.0))) {
                *response = *x;
            }
            let (Some(activations), Some(previous)) =
                (self.activations.get_mut(own.clone()), self.previous.get_mut(own.clone()))
            else {
                continue;
            };
            if group.leak {
                let leaks = leaks.get(leak + first - all.first..).unwrap_or(&[]);
                self.leak.apply(work, leaks, activations, previous);
            } else {
                activations.copy_from_slice(work);
            }
            hold(self.lesions, first, activations);
        }
    }

    fn set_gains(&mut self, span: Span, gain: Option<f32>) {
        if let (Some(gains), Some(gain)) = (self.gains.get_mut(span.first..span.end()), gain) {
            gains.fill(gain);
        }
    }
}

/// Computes the responses to the net inputs.
#[inline(always)]
fn activate<S: Scalar<Real = f32>>(simd: S::Simd, activation: Activation, slope: f32, net: &[f32], y: &mut [f32]) {
    let last = net.len().min(y.len()).checked_sub(S::LANES);
    match (activation, last) {
        // The other functions are fast without vectors.
        (Activation::Logistic, Some(last)) => {
            let mut i = 0;
            while i < last {
                logistic(S::splat(simd, slope) * S::load(simd, &net[i..])).store(&mut y[i..]);
                i += S::LANES;
            }
            // May overlap the previous vector, with the same responses.
            logistic(S::splat(simd, slope) * S::load(simd, &net[last..])).store(&mut y[last..]);
        }
        _ => net.iter().zip(y).for_each(|(net, y)| *y = activation.apply(slope * net)),
    }
}

/// The parameters of one kind.
fn part<'a>(parameters: &'a [f32], layout: &BlockLayout<'_>, kind: BlockParameter) -> &'a [f32] {
    parameters.get(layout.range(kind)).unwrap_or(&[])
}

/// Copies values from an index on to a span.
fn copy(values: &[f32], place: usize, to: &mut [f32], span: Span) {
    let to = to.iter_mut().skip(span.first).take(span.count);
    to.zip(values.iter().skip(place)).for_each(|(to, value)| *to = *value);
}
