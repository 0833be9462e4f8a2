//! How genes change from parent to child.

use farsa_num::{Stream, exp};

use crate::error::EvoError;
use crate::real::bounds::{check_rate, check_setting, reflect};

/// How real genes are mutated: normal numbers are added; what is out of bounds is reflected.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub enum RealMutation {
    /// The same step size always.
    Gaussian {
        /// The probability, 0 to 1, that a gene is mutated.
        rate: f64,
        /// The standard deviation, as a share of the gene's range, 0 to 1.
        sigma: f64,
    },
    /// Each individual has a step size of its own, which it inherits from its first parent times e^(tau N), N standard
    /// normal, before its genes are mutated with it \[Beyer2002\]. Deviations: one step size, not one for each gene; it
    /// is a share of the range, and at most 1.
    SelfAdaptive {
        /// The probability, 0 to 1, that a gene is mutated; 1 in the source.
        rate: f64,
        /// The first step size, as a share of the gene's range, from `smallest` to 1.
        initial: f64,
        /// The learning rate tau, 0 to 10; 1 / sqrt(genes) in the source.
        tau: f64,
        /// The step size that is never undercut, above 0 to 1.
        smallest: f64,
    },
}

impl RealMutation {
    pub(crate) fn check(self) -> Result<(), EvoError> {
        match self {
            Self::Gaussian { rate, sigma } => {
                check_rate("the mutation rate", rate)?;
                check_setting((0.0..=1.0).contains(&sigma), "sigma of mutation", sigma, "0 to 1")
            }
            Self::SelfAdaptive { rate, initial, tau, smallest } => {
                check_rate("the mutation rate", rate)?;
                check_setting((0.0..=10.0).contains(&tau), "tau of mutation", tau, "0 to 10")?;
                check_setting(smallest > 0.0 && smallest <= 1.0, "the smallest step size", smallest, "above 0 to 1")?;
                let within = (smallest..=1.0).contains(&initial);
                check_setting(within, "the first step size", initial, "the smallest to 1")
            }
        }
    }

    /// Whether step sizes are part of the state, and the least they may be.
    pub(crate) fn smallest(self) -> Option<f64> {
        match self {
            Self::Gaussian { .. } => None,
            Self::SelfAdaptive { smallest, .. } => Some(smallest),
        }
    }

    /// The step size of an individual of the first generation, as a share of the range.
    pub(crate) fn first_step(self) -> f64 {
        match self {
            Self::Gaussian { sigma, .. } => sigma,
            Self::SelfAdaptive { initial, .. } => initial,
        }
    }

    /// The step size of a child; a constant one draws nothing.
    pub(crate) fn next_step(self, step: f64, stream: &mut Stream) -> f64 {
        match self {
            Self::Gaussian { sigma, .. } => sigma,
            Self::SelfAdaptive { tau, smallest, .. } => {
                let [normal, _] = stream.normal_pair_f64();
                (step * exp(tau * normal)).clamp(smallest, 1.0)
            }
        }
    }

    /// Mutates genes \[genes\] with a step size; `factors` \[genes, or none\] multiply the rate.
    pub(crate) fn apply(self, genes: &mut [f64], step: f64, bounds: &[[f64; 2]], factors: &[f64], stream: &mut Stream) {
        let (Self::Gaussian { rate, .. } | Self::SelfAdaptive { rate, .. }) = self;
        let factors = factors.iter().copied().chain(core::iter::repeat(1.0));
        for ((gene, &[low, high]), factor) in genes.iter_mut().zip(bounds).zip(factors) {
            if stream.uniform_f64() < rate * factor {
                let [normal, _] = stream.normal_pair_f64();
                *gene = reflect(*gene + step * (high - low) * normal, [low, high]);
            }
        }
    }
}
