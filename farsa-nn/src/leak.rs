//! Three interpretations of the leak of a hidden neuron.

use core::fmt;
use core::str::FromStr;

use farsa_num::{exp, ln, tanh};

use crate::error::Error;
use crate::name::same_letters;

/// The formula for the activation `H(t)` of a hidden neuron with leak `d` (between 0 and 1) and response `y(t) =
/// sigma(net(t))`.
///
/// The source prints one equation but describes another, and its program used a third one. Therefore each
/// interpretation has a name that is recorded in every run.
///
/// Source: `[Ferrauto2010]` chapter 2. Deviation: the default is [`Leak::Filter`], not the printed equation.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "serde", serde(rename_all = "kebab-case"))]
pub enum Leak {
    /// The low-pass filter `H(t) = d*y(t) + (1-d)*H(t-1)`. The source describes it in words.
    // The source calls d the time constant of leaky-integrator neurons. The printed equation has no integrator.
    #[default]
    Filter,
    /// The printed equation `H(t) = d*y(t) + (1-d)*y(t-1)`. Its memory is one step long.
    TwoTap,
    /// Equation `H(t) = d*H(t-1) + (1-d)*y(t)` of the original program. Here `d` is the weight of the previous
    /// value. It is computed from a gene `p` as `|p|/range` clamped to [0, 1].
    Evonet,
}

impl Leak {
    /// All interpretations in the order of their declaration.
    pub const ALL: [Self; 3] = [Self::Filter, Self::TwoTap, Self::Evonet];

    /// Returns the name used in configurations and logs. This is `filter`, `two-tap` or `evonet`.
    pub const fn name(self) -> &'static str {
        match self {
            Self::Filter => "filter",
            Self::TwoTap => "two-tap",
            Self::Evonet => "evonet",
        }
    }

    /// Returns the time constant (in seconds) of a neuron with leak `d` (between 0 and 1) that is updated every
    /// `time_step` (in seconds).
    ///
    /// In each step, the fraction `1-d` or `d` of the previous activation is kept. This equals `exp(-dt/tau)`.
    /// If the response is constant, the neuron follows `tau da/dt = -a + y`. The result is 0 if nothing is kept and
    /// infinite if everything is kept. It is `None` for [`Leak::TwoTap`], whose memory is one step, and for values of
    /// `d` outside [0, 1].
    ///
    /// ```
    /// use farsa_nn::Leak;
    ///
    /// // Half of the activation remains after a step of 10 ms.
    /// let tau = Leak::Filter.time_constant(0.5, 0.01).unwrap_or_default();
    /// assert!((tau - 0.0144270).abs() < 1e-7);
    /// assert_eq!(Leak::Filter.for_time_constant(tau, 0.01), Some(0.5));
    /// ```
    pub fn time_constant(self, leak: f32, time_step: f32) -> Option<f32> {
        let d = f64::from(leak);
        let left = match self {
            _ if !(0.0..=1.0).contains(&leak) => return None,
            Self::Filter => 1.0 - d,
            Self::Evonet => d,
            Self::TwoTap => return None,
        };
        // For a share of 1 the quotient would be NaN.
        Some(if left < 1.0 { (f64::from(time_step) / -ln(left)) as f32 } else { f32::INFINITY })
    }

    /// Returns the leak (between 0 and 1) of a neuron with the given time constant (in seconds) that is updated every
    /// `time_step` (in seconds). This is the inverse of [`time_constant`](Self::time_constant).
    ///
    /// The result is `None` for [`Leak::TwoTap`] and for negative time constants.
    pub fn for_time_constant(self, time_constant: f32, time_step: f32) -> Option<f32> {
        if time_constant.is_nan() || time_constant < 0.0 {
            return None;
        }
        let x = f64::from(time_step) / f64::from(time_constant);
        match self {
            // Avoids the difference of 1 and the exponential, which loses its digits at small x.
            Self::Filter => Some((tanh(0.5 * x) * (1.0 + exp(-x))) as f32),
            Self::Evonet => Some(exp(-x) as f32),
            Self::TwoTap => None,
        }
    }

    /// Computes activations from responses [both of the length of the leaks]. `previous` has the responses of the
    /// previous step for [`Leak::TwoTap`].
    #[inline]
    pub(crate) fn apply(self, responses: &[f32], leaks: &[f32], activations: &mut [f32], previous: &mut [f32]) {
        let neurons = activations.iter_mut().zip(responses).zip(leaks);
        match self {
            Self::Filter => neurons.for_each(|((h, y), d)| *h = d * y + (1.0 - d) * *h),
            Self::TwoTap => neurons.zip(previous).for_each(|(((h, y), d), previous)| {
                *h = d * y + (1.0 - d) * *previous;
                *previous = *y;
            }),
            Self::Evonet => neurons.for_each(|((h, y), d)| *h = d * *h + (1.0 - d) * y),
        }
    }
}

impl fmt::Display for Leak {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.pad(self.name())
    }
}

impl FromStr for Leak {
    type Err = Error;

    /// Parses the name of an interpretation. Case and hyphens are ignored, so `TwoTap` is equivalent to `two-tap`.
    ///
    /// # Errors
    /// Returns [`Error::Name`] if the name is unknown.
    fn from_str(name: &str) -> Result<Self, Error> {
        Self::ALL
            .into_iter()
            .find(|leak| same_letters(name, leak.name()))
            .ok_or(Error::Name { of: "leak", names: "filter, two-tap, evonet" })
    }
}
