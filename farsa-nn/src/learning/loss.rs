//! Costs of motor values.

use farsa_num::Real;

use crate::activation::Activation;
use crate::learning::sums::activation_slope;

/// The cost of a motor value `O` with target `T`.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "serde", serde(rename_all = "kebab-case"))]
pub enum Loss {
    /// Squared error `(O - T)^2`.
    #[default]
    SquaredError,
    /// Cross entropy `-T ln O - (1-T) ln(1-O)`, minus its value for `O = T`. Wrong outputs near 0 and 1 are
    /// corrected faster than with squared errors.
    CrossEntropy,
}

impl Loss {
    /// The cost of a motor value whose logistic function had the argument `net`.
    pub(crate) fn cost<R: Real>(self, net: R, motor: R, wanted: R) -> R {
        match self {
            Self::SquaredError => (motor - wanted) * (motor - wanted),
            Self::CrossEntropy => {
                // -ln O = ln(1 + exp(-net)), and ln(1 - O) = ln O - net.
                let log = |size: R| farsa_num::ln(R::from_f64(1.0) + farsa_num::exp(-size));
                let small = if net < R::default() { -net } else { R::default() };
                let log_motor = small + log(net.abs());
                let entropy = |p: R| if p > R::default() { p * farsa_num::ln(p) } else { R::default() };
                let least = entropy(wanted) + entropy(R::from_f64(1.0) - wanted);
                log_motor + (R::from_f64(1.0) - wanted) * net + least
            }
        }
    }

    /// Its derivative by that argument.
    pub(crate) fn slope<R: Real>(self, motor: R, wanted: R) -> R {
        match self {
            Self::SquaredError => R::from_f64(2.0) * (motor - wanted) * motor * (R::from_f64(1.0) - motor),
            Self::CrossEntropy => motor - wanted,
        }
    }

    /// Its derivative by the argument of an activation.
    pub(crate) fn slope_of<R: Real>(self, activation: Activation, motor: R, wanted: R) -> R {
        match self {
            Self::SquaredError => R::from_f64(2.0) * (motor - wanted) * activation_slope(activation, motor),
            // Only logistic outputs have it.
            Self::CrossEntropy => motor - wanted,
        }
    }
}
