//! The errors of networks.

use core::fmt;

use crate::fault::{LayoutFault, ParameterFault, Slice};

/// An error that occurs when a network is created, when its parameters are changed, or during learning.
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub enum Error {
    /// A slice has the wrong length. The layout provides the right one.
    Length {
        /// Slice with the wrong length.
        slice: Slice,
        /// Length that the layout requires.
        expected: usize,
        /// Actual length of the slice.
        found: usize,
    },
    /// A parameter cannot be used by the network.
    Parameter {
        /// Index of the parameter.
        index: usize,
        /// The reason why it cannot be used.
        fault: ParameterFault,
    },
    /// A sum of an integer network could exceed 32 bits. This can be avoided by smaller weights or fewer fraction bits.
    Sum {
        /// Target of the sum. Hidden neurons are counted first, followed by outputs.
        target: usize,
        /// Largest possible magnitude of the sum, in its units.
        largest: u64,
        /// Largest allowed magnitude.
        limit: u64,
    },
    /// A state is NaN or infinite.
    State {
        /// Index of the neuron.
        index: usize,
    },
    /// The layout or a setting is invalid.
    Layout(LayoutFault),
    /// The length of a demonstration is not a multiple of the number of values per tick.
    Demonstration {
        /// Number of sensor values.
        values: usize,
        /// Number of sensors in the layout.
        sensors: usize,
        /// Number of target motor values.
        wanted: usize,
        /// Number of outputs in the layout.
        outputs: usize,
    },
    /// A text contains an unexpected line.
    Text {
        /// Number of the line, starting at 1.
        line: usize,
        /// A description of the expected content.
        expected: &'static str,
    },
    /// A name is unknown.
    Name {
        /// Kind of item that the name should denote.
        of: &'static str,
        /// A list of all valid names.
        names: &'static str,
    },
}

impl fmt::Display for Error {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match *self {
            Self::Length { slice: Slice::Parameters, expected, found } => {
                write!(f, "{found} parameters where the layout has {expected}")
            }
            Self::Length { slice: Slice::State, expected, found } => {
                write!(f, "a state of {found} values where the layout needs {expected}")
            }
            Self::Length { slice: Slice::MirrorImages, expected, found } => {
                write!(f, "{found} mirror images where there are {expected}")
            }
            Self::Parameter { index, fault } => write!(f, "parameter {index}{fault}"),
            Self::Sum { target, largest, limit } => {
                write!(f, "the sum of target {target} can reach {largest} where {limit} is the most")
            }
            Self::State { index } => write!(f, "the state of neuron {index} is not finite"),
            Self::Layout(fault) => fault.fmt(f),
            Self::Demonstration { values, sensors, wanted, outputs } => write!(
                f,
                "{values} sensor values and {wanted} wanted motor values: not whole ticks of {sensors} and {outputs}"
            ),
            Self::Text { line, expected } => write!(f, "line {line}: expected {expected}"),
            Self::Name { of, names } => write!(f, "unknown {of}: one of {names}"),
        }
    }
}

impl core::error::Error for Error {}

impl From<LayoutFault> for Error {
    fn from(fault: LayoutFault) -> Self {
        Self::Layout(fault)
    }
}

impl Slice {
    /// Compares the length of a slice with the expected one.
    pub(crate) fn check(self, expected: usize, found: usize) -> Result<(), Error> {
        if expected == found { Ok(()) } else { Err(Error::Length { slice: self, expected, found }) }
    }
}

impl ParameterFault {
    /// The error of the parameter at this index.
    pub(crate) const fn at(self, index: usize) -> Error {
        Error::Parameter { index, fault: self }
    }
}

impl LayoutFault {
    /// Accepts a finite slope.
    pub(crate) fn check_slope(slope: f32) -> Result<(), Error> {
        if slope.is_finite() { Ok(()) } else { Err(Self::Slope(slope).into()) }
    }
}
