//! What can be wrong with a network before it takes its first step.

use core::fmt;

/// Why a network could not be built, or given other parameters.
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub enum Error {
    /// The parameter slice has another length than the layout's parameter count.
    ParameterCount {
        /// Length the layout asks for.
        expected: usize,
        /// Length of the slice.
        found: usize,
    },
    /// The state slice has another length than the layout's state.
    StateLen {
        /// Length the layout asks for.
        expected: usize,
        /// Length of the slice.
        found: usize,
    },
    /// A parameter is NaN or infinite.
    NotFinite {
        /// Its place among the parameters.
        index: usize,
    },
    /// A leak lies outside [0, 1].
    LeakRange {
        /// Its place among the parameters.
        index: usize,
        /// Its value.
        value: f32,
    },
    /// The slope of the logistic function is NaN or infinite.
    Slope {
        /// Its value.
        value: f32,
    },
    /// No reading of the leak has this name.
    UnknownLeak,
}

impl fmt::Display for Error {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match *self {
            Self::ParameterCount { expected, found } => write!(f, "{found} parameters where the layout has {expected}"),
            Self::StateLen { expected, found } => {
                write!(f, "a state of {found} values where the layout needs {expected}")
            }
            Self::NotFinite { index } => write!(f, "parameter {index} is not finite"),
            Self::LeakRange { index, value } => write!(f, "parameter {index}, a leak, is {value}: outside [0, 1]"),
            Self::Slope { value } => write!(f, "the slope of the logistic function is {value}: not finite"),
            Self::UnknownLeak => f.write_str("unknown leak: one of filter, two-tap, evonet"),
        }
    }
}

impl core::error::Error for Error {}
