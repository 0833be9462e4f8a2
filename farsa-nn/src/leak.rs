//! The three readings of a hidden neuron's leak.

use core::fmt;
use core::str::FromStr;

use farsa_num::{exp, ln, tanh};

use crate::error::Error;
use crate::name::same_letters;

/// The formula for the activation `H(t)` of a hidden neuron with leak `d` [0..1] and response `y(t) = sigma(net(t))`.
///
/// The source prints one equation and describes another, and its program used a third. So each reading has a name, and a run
/// records the one it used.
///
/// Source: `[Ferrauto2010]` chapter 2. Deviation: the default is [`Leak::Filter`], not the printed equation.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "serde", serde(rename_all = "kebab-case"))]
pub enum Leak {
    /// `H(t) = d*y(t) + (1-d)*H(t-1)`: the low-pass filter of the source's description.
    // The source calls d the time constant of leaky-integrator neurons. The printed equation has no integrator.
    #[default]
    Filter,
    /// `H(t) = d*y(t) + (1-d)*y(t-1)`: the equation as printed, a memory of one step.
    TwoTap,
    /// `H(t) = d*H(t-1) + (1-d)*y(t)`: the original program, where `d` weights the old value (and is `|p|/range` of a
    /// gene `p`, clamped to [0, 1]).
    Evonet,
}

impl Leak {
    /// Every reading, in the order of their declaration.
    pub const ALL: [Self; 3] = [Self::Filter, Self::TwoTap, Self::Evonet];

    /// The name in configurations and logs: `filter`, `two-tap` or `evonet`.
    pub const fn name(self) -> &'static str {
        match self {
            Self::Filter => "filter",
            Self::TwoTap => "two-tap",
            Self::Evonet => "evonet",
        }
    }

    /// The time constant [s] of a neuron with leak `d` [0..1] that is updated every `time_step` [s].
    ///
    /// A step keeps the share `1-d` or `d` of the old activation, which equals `exp(-dt/tau)`. Under a constant response the
    /// neuron follows `tau da/dt = -a + y`. The result is 0 for a share of 0 and infinite for a share of 1. It is `None` for
    /// [`Leak::TwoTap`], whose memory is one step, and for a `d` outside [0, 1].
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

    /// The leak [0..1] of a neuron with this time constant [s] that is updated every `time_step` [s]: the inverse of
    /// [`time_constant`](Self::time_constant).
    ///
    /// `None` for [`Leak::TwoTap`] and for a time constant below zero.
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

    /// Computes activations from responses [both of the length of the leaks]. `previous` has the responses of the previous step
    /// for [`Leak::TwoTap`].
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

    /// Finds the reading of this name, ignoring case and hyphens. `TwoTap` is `two-tap`.
    ///
    /// # Errors
    /// [`Error::Name`] for an unknown name.
    fn from_str(name: &str) -> Result<Self, Error> {
        Self::ALL
            .into_iter()
            .find(|leak| same_letters(name, leak.name()))
            .ok_or(Error::Name { of: "leak", names: "filter, two-tap, evonet" })
    }
}
