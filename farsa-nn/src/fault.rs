//! Details of an [`Error`](crate::Error).

use core::fmt;

/// A slice whose length follows from the layout.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Slice {
    /// The parameters.
    Parameters,
    /// The state.
    State,
    /// The mirror images of inputs or neurons.
    MirrorImages,
}

/// A fault of one parameter.
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub enum ParameterFault {
    /// NaN or an infinity.
    NotFinite,
    /// A leak of this value, outside [0, 1].
    Leak(f32),
    /// A weight that is too large for an integer network, even without fraction bits. The value includes the slope.
    Weight(f64),
    /// A time constant that is not above zero, or so short that the integrator diverges.
    TimeConstant {
        /// Its value [s].
        value: f32,
        /// The smallest stable time constant [s], 0 if every one above zero is stable.
        least: f32,
    },
    /// A parameter without a value, which evolution is to draw.
    NoValue,
}

impl fmt::Display for ParameterFault {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match *self {
            Self::NotFinite => f.write_str(" is not finite"),
            Self::Leak(value) => write!(f, ", a leak, is {value}: outside [0, 1]"),
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

/// A fault of a layout or of a setting next to it.
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub enum LayoutFault {
    /// A NaN or infinite slope of the logistic function.
    Slope(f32),
    /// A time step [s] that is not a finite number above zero.
    TimeStep(f32),
    /// Neurons that the layout does not have.
    Neurons {
        /// The first of them.
        first: usize,
        /// Their number.
        count: usize,
        /// Number of neurons in the layout.
        neurons: usize,
    },
    /// A block over neurons that the layout does not have.
    Block {
        /// Index of the block.
        index: usize,
        /// The first of the neurons.
        first: usize,
        /// Their number.
        count: usize,
        /// Number of neurons in the layout.
        neurons: usize,
    },
    /// An invalid number of fraction bits of an integer network.
    FractionBits {
        /// The integers: inputs, weights or sums.
        of: &'static str,
        /// The number of fraction bits.
        found: u32,
        /// The smallest valid number.
        least: u32,
        /// The largest valid number.
        most: u32,
    },
    /// A missing mirror image of an input or of a neuron, or one with another mirror image.
    Mirror {
        /// The number of the input or neuron.
        index: usize,
        /// Its mirror image.
        image: usize,
    },
    /// Alike neurons that overlap with others, or whose mirror images are not alike.
    Alike {
        /// The first of them.
        first: usize,
        /// Their number.
        count: usize,
    },
}

impl fmt::Display for LayoutFault {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match *self {
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
