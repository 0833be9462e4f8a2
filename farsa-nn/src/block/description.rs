//! What a block-wise network is described by: groups of alike neurons, and blocks that are worked through in their order.

use crate::activation::Activation;

/// Neurons `first` to `first + count - 1`.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct Span {
    /// The first neuron.
    pub first: usize,
    /// How many there are.
    pub count: usize,
}

impl Span {
    /// `count` neurons from `first` on.
    pub const fn new(first: usize, count: usize) -> Self {
        Self { first, count }
    }

    /// One more than the last neuron; saturates.
    pub const fn end(self) -> usize {
        self.first.saturating_add(self.count)
    }

    /// Whether a neuron is one of them.
    pub const fn contains(self, neuron: usize) -> bool {
        self.first <= neuron && neuron < self.end()
    }
}

/// Neurons that follow each other and are alike: one activation function, and each of bias, gain and leak as a parameter for
/// all of them or for none.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct Group {
    /// How many neurons there are.
    pub neurons: usize,
    /// Their function; inputs have none, their response is the input.
    pub activation: Activation,
    /// What multiplies the net input before.
    pub slope: f32,
    /// Whether each has a bias, where its net input starts; else at 0.
    pub bias: bool,
    /// Whether each has a gain, which multiplies its activation wherever that goes; else 1.
    pub gain: bool,
    /// Whether each has a leak, read as [`Leak`](crate::Leak) says; else its activation is its response.
    pub leak: bool,
}

impl Group {
    /// Neurons of this function with slope 1, without bias, gain and leak.
    pub const fn new(neurons: usize, activation: Activation) -> Self {
        Self { neurons, activation, slope: 1.0, bias: false, gain: false, leak: false }
    }

    /// The same with another slope.
    pub const fn with_slope(self, slope: f32) -> Self {
        Self { slope, ..self }
    }

    /// The same with biases.
    pub const fn with_biases(self) -> Self {
        Self { bias: true, ..self }
    }

    /// The same with gains.
    pub const fn with_gains(self) -> Self {
        Self { gain: true, ..self }
    }

    /// The same with leaks.
    pub const fn with_leaks(self) -> Self {
        Self { leak: true, ..self }
    }
}

/// One piece of a step. A step works through the blocks in their order.
///
/// A connection from neurons that are updated further on reads their activation of the step before: so the order of the
/// blocks says which connections are recurrent.
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
        /// How many steps earlier the sources are read; 0 before there were any.
        delay: usize,
    },
    /// Makes new activations of the net inputs.
    Update(Span),
    /// Gives all of a span the gain of its first neuron.
    Gain(Span),
    /// Gives all of a span the activation of a neuron as their gain.
    ModulatedGain {
        /// Whose gain it becomes.
        neurons: Span,
        /// Whose activation it is.
        by: usize,
    },
}

impl Block {
    /// Connections without a delay.
    pub const fn connect(from: Span, to: Span) -> Self {
        Self::Connect { from, to, delay: 0 }
    }

    /// The same block, with connections that read their sources so many steps earlier.
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

    /// What a delay needs of the state: the values on their way, and which of them is the oldest.
    pub(crate) const fn memory(&self) -> usize {
        match self {
            Self::Connect { from, delay, .. } if *delay > 0 => from.count.saturating_mul(*delay).saturating_add(1),
            _ => 0,
        }
    }

    /// The spans that must be neurons of the network.
    pub(crate) fn spans(&self) -> [Span; 2] {
        match *self {
            Self::Connect { from, to, .. } => [from, to],
            Self::Update(span) | Self::Gain(span) => [span, span],
            Self::ModulatedGain { neurons, by } => [neurons, Span::new(by, 1)],
        }
    }
}
