//! Errors of networks.

use core::fmt;

use crate::fault::{LayoutFault, ParameterFault, Slice};

/// An error of building a network, of changing its parameters, or of learning.
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub enum Error {
    /// A slice of the wrong length. Ask the layout for the right one.
    Length {
        /// The slice.
        slice: Slice,
        /// Length that the layout needs.
        expected: usize,
        /// Length of the slice.
        found: usize,
    },
    /// A parameter that the network cannot use.
    Parameter {
        /// Its index.
        index: usize,
        /// The fault.
        fault: ParameterFault,
    },
    /// A sum of an integer network that could leave 32 bits. Smaller weights or fewer fraction bits help.
    Sum {
        /// The target: hidden neurons first, then outputs.
        target: usize,
        /// The largest possible magnitude of the sum, in its units.
        largest: u64,
        /// The largest magnitude allowed.
        limit: u64,
    },
    /// A NaN or infinite state.
    State {
        /// The number of its neuron.
        index: usize,
    },
    /// An invalid layout or setting.
    Layout(LayoutFault),
    /// A demonstration that is not a whole number of ticks.
    Demonstration {
        /// Number of sensor values.
        values: usize,
        /// Sensors of the layout.
        sensors: usize,
        /// Number of target motor values.
        wanted: usize,
        /// Outputs of the layout.
        outputs: usize,
    },
    /// An unexpected line of a text.
    Text {
        /// Its number, from 1.
        line: usize,
        /// The expected content.
        expected: &'static str,
    },
    /// An unknown name.
    Name {
        /// The named thing.
        of: &'static str,
        /// All valid names.
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
