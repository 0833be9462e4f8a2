//! The activation functions of neurons.

use core::fmt;
use core::str::FromStr;

use farsa_num::{Scalar, logistic, tanh};

use crate::error::Error;
use crate::name::same_letters;

/// The activation function of a neuron. Its argument is multiplied by a slope or a gain.
///
/// All functions are monotonic, and they are finite for finite arguments.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "serde", serde(rename_all = "kebab-case"))]
pub enum Activation {
    /// Logistic function `1/(1 + exp(-x))`, with values in [0, 1].
    #[default]
    Logistic,
    /// Hyperbolic tangent, with values in [-1, 1].
    Tanh,
    /// Identity function.
    Linear,
    /// A step function. It is 1 for arguments >= 0 and 0 otherwise.
    Step,
    /// A rectified function. This is `x` for arguments > 0 and 0 otherwise.
    Rectified,
}

impl Activation {
    /// All functions in the order of their declaration.
    pub const ALL: [Self; 5] = [Self::Logistic, Self::Tanh, Self::Linear, Self::Step, Self::Rectified];

    /// Returns the name used in configurations and logs. This is `logistic`, `tanh`, `linear`, `step` or `rectified`.
    pub const fn name(self) -> &'static str {
        match self {
            Self::Logistic => "logistic",
            Self::Tanh => "tanh",
            Self::Linear => "linear",
            Self::Step => "step",
            Self::Rectified => "rectified",
        }
    }

    /// Evaluates the function at `x`. If `x` is NaN, the result is 0 for the step and rectified functions and NaN for
    /// the others.
    ///
    /// ```
    /// use farsa_nn::Activation;
    ///
    /// assert_eq!(Activation::Step.apply(0.0), 1.0);
    /// assert_eq!(Activation::ALL.map(|f| f.apply(-2.0)), [0.11920292, -0.9640276, -2.0, 0.0, 0.0]);
    /// ```
    pub fn apply(self, x: f32) -> f32 {
        self.apply_lanes(x)
    }

    /// Evaluates the function in the lanes of a scalar.
    #[inline(always)]
    pub(crate) fn apply_lanes<S: Scalar>(self, x: S) -> S {
        let zero = x.constant(0.0);
        match self {
            Self::Logistic => logistic(x),
            Self::Tanh => tanh(x),
            Self::Linear => x,
            Self::Step => S::select(x.ge(zero), x.constant(1.0), zero),
            Self::Rectified => x.max(zero),
        }
    }
}

impl fmt::Display for Activation {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.pad(self.name())
    }
}

impl FromStr for Activation {
    type Err = Error;

    /// Parses the name of a function. The case of the letters is ignored.
    ///
    /// # Errors
    /// Returns [`Error::Name`] if the name is unknown.
    fn from_str(name: &str) -> Result<Self, Error> {
        Self::ALL
            .into_iter()
            .find(|activation| same_letters(name, activation.name()))
            .ok_or(Error::Name { of: "activation", names: "logistic, tanh, linear, step, rectified" })
    }
}
