//! The description of a network of blocks: groups of alike neurons, and blocks in the order of their evaluation.

use crate::activation::Activation;

/// Neurons `first` to `first + count - 1`.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct Span {
    /// The first neuron.
    pub first: usize,
    /// Number of neurons.
    pub count: usize,
}

impl Span {
    /// `count` neurons from `first` on.
    pub const fn new(first: usize, count: usize) -> Self {
        Self { first, count }
    }

    /// The end of the span, one after the last neuron. Saturates.
    pub const fn end(self) -> usize {
        self.first.saturating_add(self.count)
    }

    /// Returns true if the span contains a neuron.
    pub const fn contains(self, neuron: usize) -> bool {
        self.first <= neuron && neuron < self.end()
    }
}

/// A range of alike neurons. They have one activation function, and all or none of them have a bias, a gain and a leak.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct Group {
    /// Number of neurons.
    pub neurons: usize,
    /// Their function. The response of an input is the input itself.
    pub activation: Activation,
    /// The factor of the net input.
    pub slope: f32,
    /// Gives each a bias as the start of its net input, else 0.
    pub bias: bool,
    /// Gives each a gain as the factor of its activation at all targets, else 1.
    pub gain: bool,
    /// Gives each a leak in the reading of a [`Leak`](crate::Leak). Without it the activation is the response.
    pub leak: bool,
}

impl Group {
    /// Builds a group of this function with slope 1, without biases, gains and leaks.
    pub const fn new(neurons: usize, activation: Activation) -> Self {
        Self { neurons, activation, slope: 1.0, bias: false, gain: false, leak: false }
    }

    /// Sets the slope.
    pub const fn with_slope(self, slope: f32) -> Self {
        Self { slope, ..self }
    }

    /// Adds biases.
    pub const fn with_biases(self) -> Self {
        Self { bias: true, ..self }
    }

    /// Adds gains.
    pub const fn with_gains(self) -> Self {
        Self { gain: true, ..self }
    }

    /// Adds leaks.
    pub const fn with_leaks(self) -> Self {
        Self { leak: true, ..self }
    }
}

/// One part of a step. A step evaluates the blocks in their order.
///
/// A connection from neurons with a later update reads their activation of the previous step. So the order of the blocks
/// determines the recurrent connections.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "serde", serde(rename_all = "kebab-case"))]
#[non_exhaustive]
pub enum Block {
    /// Adds the activations of all neurons of one span, times their gains and the weights, to the net inputs of another.
    Connect {
        /// The sources.
        from: Span,
        /// The targets.
        to: Span,
        /// Delay of the sources [steps]. They are 0 before the first step.
        delay: usize,
    },
    /// Computes new activations from the net inputs.
    Update(Span),
    /// Copies the gain of the first neuron to the whole span.
    Gain(Span),
    /// Copies the activation of a neuron to the gains of a span.
    ModulatedGain {
        /// The neurons with this gain.
        neurons: Span,
        /// The neuron of the activation.
        by: usize,
    },
}

impl Block {
    /// Builds connections without a delay.
    pub const fn connect(from: Span, to: Span) -> Self {
        Self::Connect { from, to, delay: 0 }
    }

    /// Increases the delay of connections by a number of steps.
    pub const fn delayed(self, steps: usize) -> Self {
        match self {
            Self::Connect { from, to, delay } => Self::Connect { from, to, delay: delay.saturating_add(steps) },
            other => other,
        }
    }

    /// Number of weights.
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
