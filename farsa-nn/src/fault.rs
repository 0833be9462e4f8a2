//! Details of an [`Error`](crate::Error).

use core::fmt;

/// A slice whose length is determined by the layout.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Slice {
    /// Parameters of the network.
    Parameters,
    /// State of the network.
    State,
    /// Mirror images of inputs or neurons.
    MirrorImages,
}

/// The reason why a parameter cannot be used.
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub enum ParameterFault {
    /// The parameter is NaN or infinite.
    NotFinite,
    /// The parameter is a leak whose value is outside [0, 1].
    Leak(f32),
    /// The parameter is a leak outside [0, 1]. It is given as an integer in units of 2^-14.
    QuantizedLeak(i16),
    /// The parameter is a weight that is too large for an integer network, even without fraction bits. The value
    /// includes the slope.
    Weight(f64),
    /// The parameter is a time constant that is not above zero, or for which the integrator diverges.
    TimeConstant {
        /// Invalid time constant [s].
        value: f32,
        /// The smallest stable time constant [s], or 0 if all positive time constants are stable.
        least: f32,
    },
    /// The parameter has no value, because it is drawn by the evolution.
    NoValue,
}

impl fmt::Display for ParameterFault {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match *self {
            Self::NotFinite => f.write_str(" is not finite"),
            Self::Leak(value) => {
                write!(f, ", a leak, is {value}: outside [0, 1]; give leaks another gene range than weights")
            }
            Self::QuantizedLeak(units) => Self::Leak(f32::from(units) / 16384.0).fmt(f),
            Self::Weight(value) => write!(f, " times the slope is {value}: outside [-32767, 32767]"),
            Self::TimeConstant { value, least } if value > 0.0 => write!(
                f,
                ", a time constant, is {value}: below {least}, where the integrator diverges at this time step"
            ),
            Self::TimeConstant { value, .. } => write!(f, ", a time constant, is {value}: not above 0"),
            Self::NoValue => f.write_str(" has no value: evolution draws it"),
        }
    }
}

/// The reason why a layout or a setting is invalid.
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub enum LayoutFault {
    /// The slope of the logistic function is NaN or infinite.
    Slope(f32),
    /// The loss is cross entropy, and an output is not the value of a logistic function.
    Loss,
    /// The time step [s] is not a finite number above zero.
    TimeStep(f32),
    /// The layout does not have these neurons.
    Neurons {
        /// Index of the first neuron.
        first: usize,
        /// Number of neurons in the range.
        count: usize,
        /// Number of neurons in the layout.
        neurons: usize,
    },
    /// A block refers to neurons that do not exist in the layout.
    Block {
        /// Index of the block.
        index: usize,
        /// Index of the first neuron.
        first: usize,
        /// Number of neurons in the range.
        count: usize,
        /// Number of neurons in the layout.
        neurons: usize,
    },
    /// The number of fraction bits of an integer network is invalid.
    FractionBits {
        /// Kind of integers. These can be inputs, weights or sums.
        of: &'static str,
        /// Invalid number of fraction bits.
        found: u32,
        /// Smallest valid number.
        least: u32,
        /// Largest valid number.
        most: u32,
    },
    /// The mirror image of an input or a neuron does not exist or has a different mirror image.
    Mirror {
        /// Index of the input or neuron.
        index: usize,
        /// Index of its mirror image.
        image: usize,
    },
    /// A span of alike neurons overlaps with another one, or its mirror images are not alike.
    Alike {
        /// Index of the first neuron.
        first: usize,
        /// Number of neurons in the span.
        count: usize,
    },
}

impl fmt::Display for LayoutFault {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match *self {
            Self::Loss => f.write_str("cross entropy requires outputs that are values of logistic functions"),
            Self::Slope(value) => write!(f, "the slope of the logistic function is {value}: not finite"),
            Self::TimeStep(value) => write!(f, "the time step is {value}: not a finite number above 0"),
            Self::Neurons { first, count, neurons } => {
                write!(f, "{count} neurons from neuron {first} on where the layout has {neurons}")
            }
            Self::Block { index, first, count, neurons } => write!(
                f,
                "block {index} has {count} neurons from neuron {first} on where the layout has {neurons} neurons"
            ),
            Self::FractionBits { of, found, least, most } => {
                write!(f, "{found} fraction bits of {of}: outside [{least}, {most}]")
            }
            Self::Mirror { index, image } => {
                write!(f, "the mirror image of {index} is {image}, which is not there or has another mirror image")
            }
            Self::Alike { first, count } => write!(
                f,
                "{count} alike neurons from neuron {first} on: some are alike with others, or their mirror images are not alike"
            ),
        }
    }
}
