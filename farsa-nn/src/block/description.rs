//! The description of a block network. It consists of groups of similar neurons and a sequence of blocks.

use crate::activation::Activation;

/// A range of consecutive neurons.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct Span {
    /// Index of the first neuron.
    pub first: usize,
    /// Number of neurons.
    pub count: usize,
}

impl Span {
    /// Creates a span of `count` neurons that starts at `first`.
    pub const fn new(first: usize, count: usize) -> Self {
        Self { first, count }
    }

    /// Returns the index after the last neuron. The addition saturates.
    pub const fn end(self) -> usize {
        self.first.saturating_add(self.count)
    }

    /// Returns true if the neuron belongs to the span.
    pub const fn contains(self, neuron: usize) -> bool {
        self.first <= neuron && neuron < self.end()
    }
}

/// A group of similar neurons. They have the same activation function, and either all or none of them have a bias, a
/// gain or a leak.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct Group {
    /// Number of neurons in the group.
    pub neurons: usize,
    /// Activation function. It is not applied to inputs.
    pub activation: Activation,
    /// Factor by which the net input is multiplied. The default is 1.
    pub slope: f32,
    /// If true, each neuron has a bias, and its net input starts at this value. Otherwise it is 0.
    pub bias: bool,
    /// If true, each neuron has a gain that multiplies its activation at all targets. Otherwise it is 1.
    pub gain: bool,
    /// If true, each neuron has a leak. It is interpreted according to the selected [`Leak`](crate::Leak). Otherwise
    /// the activation equals the response.
    pub leak: bool,
}

impl Group {
    /// Creates a group with a slope of 1 and without biases, gains and leaks.
    pub const fn new(neurons: usize, activation: Activation) -> Self {
        Self { neurons, activation, slope: 1.0, bias: false, gain: false, leak: false }
    }

    /// Sets the slope of the group.
    pub const fn with_slope(self, slope: f32) -> Self {
        Self { slope, ..self }
    }

    /// Adds biases to the neurons.
    pub const fn with_biases(self) -> Self {
        Self { bias: true, ..self }
    }

    /// Adds gains to the neurons.
    pub const fn with_gains(self) -> Self {
        Self { gain: true, ..self }
    }

    /// Adds leaks to the neurons.
    pub const fn with_leaks(self) -> Self {
        Self { leak: true, ..self }
    }
}

/// A part of the computation of a step. The blocks of a network are evaluated in their order.
///
/// If a connection starts at neurons updated by a later block, it uses their activations from the previous step. The
/// order of the blocks therefore determines which connections are recurrent.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "serde", serde(rename_all = "kebab-case"))]
#[non_exhaustive]
pub enum Block {
    /// Connects all neurons of a span to all neurons of another span. The activations of the sources are multiplied by
    /// their gains and the weights and added to the net inputs of the targets.
    Connect {
        /// Neurons from which the connections start.
        from: Span,
        /// Neurons at which the connections end.
        to: Span,
        /// Delay of the activations in steps. Delayed activations from before the first step are 0.
        delay: usize,
    },
    /// Computes new activations from the net inputs.
    Update(Span),
    /// Copies the gain of the first neuron to all neurons of the span.
    Gain(Span),
    /// Copies the activation of a neuron to the gains of a span.
    ModulatedGain {
        /// Neurons whose gains are replaced.
        neurons: Span,
        /// Neuron whose activation becomes the gain.
        by: usize,
    },
}

impl Block {
    /// Creates connections without a delay.
    pub const fn connect(from: Span, to: Span) -> Self {
        Self::Connect { from, to, delay: 0 }
    }

    /// Increases the delay of connections by the given number of steps.
    pub const fn delayed(self, steps: usize) -> Self {
        match self {
            Self::Connect { from, to, delay } => Self::Connect { from, to, delay: delay.saturating_add(steps) },
            other => other,
        }
    }

    /// Returns the number of weights in this block.
    pub const fn weights(&self) -> usize {
        match self {
            Self::Connect { from, to, .. } => from.count.saturating_mul(to.count),
            _ => 0,
        }
    }

    /// Length of the state for a delay: the delayed values and the index of the oldest one.
    pub(crate) const fn memory(&self) -> usize {
        match self {
            Self::Connect { from, delay, .. } if *delay > 0 => from.count.saturating_mul(*delay).saturating_add(1),
            _ => 0,
        }
    }

    /// The spans of neurons that must exist.
    pub(crate) fn spans(&self) -> [Span; 2] {
        match *self {
            Self::Connect { from, to, .. } => [from, to],
            Self::Update(span) | Self::Gain(span) => [span, span],
            Self::ModulatedGain { neurons, by } => [neurons, Span::new(by, 1)],
        }
    }
}
