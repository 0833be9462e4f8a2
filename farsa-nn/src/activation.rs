//! Activation functions.

use core::fmt;
use core::str::FromStr;

use farsa_num::{Scalar, logistic, tanh};

use crate::error::Error;
use crate::name::same_letters;

/// The activation function of a neuron. A slope or gain multiplies its argument.
///
/// Every function is finite for finite numbers and never falls where its argument rises.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "serde", serde(rename_all = "kebab-case"))]
pub enum Activation {
    /// `1/(1 + exp(-x))`, in [0, 1].
    #[default]
    Logistic,
    /// The hyperbolic tangent, in [-1, 1].
    Tanh,
    /// `x` itself.
    Linear,
    /// 1 from zero on, else 0.
    Step,
    /// `x` above zero, else 0.
    Rectified,
}

impl Activation {
    /// Every function, in the order of their declaration.
    pub const ALL: [Self; 5] = [Self::Logistic, Self::Tanh, Self::Linear, Self::Step, Self::Rectified];

    /// The name in configurations and logs: `logistic`, `tanh`, `linear`, `step` or `rectified`.
    pub const fn name(self) -> &'static str {
        match self {
            Self::Logistic => "logistic",
            Self::Tanh => "tanh",
            Self::Linear => "linear",
            Self::Step => "step",
            Self::Rectified => "rectified",
        }
    }

    /// Evaluates the function at `x`. For a NaN the result is 0 (step, rectified) or NaN.
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

    /// Finds the function of this name, ignoring case.
    ///
    /// # Errors
    /// [`Error::Name`] for an unknown name.
    fn from_str(name: &str) -> Result<Self, Error> {
        Self::ALL
            .into_iter()
            .find(|activation| same_letters(name, activation.name()))
            .ok_or(Error::Name { of: "activation", names: "logistic, tanh, linear, step, rectified" })
    }
}
