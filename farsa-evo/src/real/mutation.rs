//! Mutation of real genes.

use farsa_num::{Stream, exp, ln};

use crate::error::{EvoError, check_range, check_setting, check_share};
use crate::real::bounds::reflect;

/// Method used to mutate real genes. All methods add normal numbers and reflect genes that leave the bounds.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub enum RealMutation {
    /// Mutation with a constant step size.
    Gaussian {
        /// Probability (0 to 1) that a gene is mutated.
        rate: f64,
        /// The standard deviation, as a share of the gene's range, 0 to 1.
        sigma: f64,
    },
    /// Each individual has a step size. It inherits that of its first parent times e^(tau N), N standard normal, and its
    /// genes are then mutated with it \[Beyer2002\]. Deviations: there is one step size, not one for each gene. It is a
    /// share of the range, and at most 1.
    SelfAdaptive {
        /// Probability (0 to 1) that a gene is mutated. 1 in the source.
        rate: f64,
        /// The first step size, as a share of the gene's range, from `smallest` to 1.
        initial: f64,
        /// The learning rate tau, 0 to 10. 1 / sqrt(genes) in the source.
        tau: f64,
        /// Lower limit of the step size, above 0 to 1.
        smallest: f64,
    },
}

impl RealMutation {
    pub(crate) fn check(self) -> Result<(), EvoError> {
        match self {
            Self::Gaussian { rate, sigma } => {
                check_share("the mutation rate", rate)?;
                check_share("sigma of mutation", sigma)
            }
            Self::SelfAdaptive { rate, initial, tau, smallest } => {
                check_share("the mutation rate", rate)?;
                check_range("tau of mutation", tau, [0.0, 10.0], "0 to 10")?;
                check_setting(smallest > 0.0 && smallest <= 1.0, "the smallest step size", smallest, "above 0 to 1")?;
                check_range("the first step size", initial, [smallest, 1.0], "the smallest to 1")
            }
        }
    }

    /// The smallest step size, if step sizes are part of the state.
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

    /// The step size of a child. A constant one draws nothing.
    pub(crate) fn next_step(self, step: f64, stream: &mut Stream) -> f64 {
        match self {
            Self::Gaussian { sigma, .. } => sigma,
            Self::SelfAdaptive { tau, smallest, .. } => {
                let [normal, _] = stream.normal_pair_f64();
                // The logarithm tau N has the mean 0, so within the limits selection alone favors larger or smaller
                // steps.
                (step * exp(tau * normal)).clamp(smallest, 1.0)
            }
        }
    }

    /// Mutates genes \[genes\] with a step size. `factors` \[genes, or empty\] multiply the rate.
    pub(crate) fn apply(self, genes: &mut [f64], step: f64, bounds: &[[f64; 2]], factors: &[f64], stream: &mut Stream) {
        let (Self::Gaussian { rate, .. } | Self::SelfAdaptive { rate, .. }) = self;
        let factors = factors.iter().copied().chain(core::iter::repeat(1.0));
        for ((gene, &[low, high]), factor) in genes.iter_mut().zip(bounds).zip(factors) {
            if stream.uniform_f64() < rate * factor {
                // The second number is discarded, so every mutated gene draws the same amount.
                let [normal, _] = stream.normal_pair_f64();
                *gene = reflect(*gene + step * (high - low) * normal, [low, high]);
            }
        }
    }
}

/// A step towards one end of a gene's range or the other, more often small than large, that never leaves the range.
///
/// Source: K. Deb's program NSGA-II, `mutation.c`, as \[Deb2002\] uses it. No deviation.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct PolynomialMutation {
    /// The probability that a gene is mutated.
    pub(crate) rate: f64,
    /// The distribution index eta.
    pub(crate) eta: f64,
}

impl PolynomialMutation {
    pub(crate) fn check(self) -> Result<(), EvoError> {
        check_share("the mutation rate", self.rate)?;
        check_range("eta of polynomial mutation", self.eta, [0.0, 1000.0], "0 to 1000")
    }

    /// Mutates genes \[genes\] within their bounds.
    pub(crate) fn apply(self, genes: &mut [f64], bounds: &[[f64; 2]], stream: &mut Stream) {
        for (gene, &[low, high]) in genes.iter_mut().zip(bounds) {
            let width = high - low;
            if stream.uniform_f64() >= self.rate || width <= 0.0 {
                continue;
            }
            let (u, power) = (stream.uniform_f64(), self.eta + 1.0);
            let step = if u < 0.5 {
                // delta = (2 u + (1 - 2 u) (1 - d)^(eta + 1))^(1 / (eta + 1)) - 1, where d = (x - low) / width. The
                // other half mirrors it.
                let rest = raised((high - *gene) / width, power);
                raised(2.0 * u + (1.0 - 2.0 * u) * rest, 1.0 / power) - 1.0
            } else {
                let rest = raised((*gene - low) / width, power);
                1.0 - raised(2.0 * (1.0 - u) + (2.0 * u - 1.0) * rest, 1.0 / power)
            };
            *gene = (*gene + step * width).clamp(low, high);
        }
    }
}

/// Raises a number of 0 to 1, up to rounding, to a power above 0.
fn raised(x: f64, power: f64) -> f64 {
    if x > 0.0 { exp(power * ln(x)) } else { 0.0 }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The density of steps from the middle of a range is (eta + 1) (1 - |step|)^eta / 2 before the range cuts it. A step
    /// is therefore farther than s with probability (1 - s)^(eta + 1), here without the part beyond the half.
    #[test]
    fn steps_are_as_long_as_the_source_says() {
        let mutation = PolynomialMutation { rate: 0.5, eta: 4.0 };
        let (bounds, mut stream) = ([[-1.0, 3.0], [2.0, 2.0]], Stream::from_seed(5));
        let (mut moved, mut far, mut up) = (0_u32, 0_u32, 0_u32);
        for _ in 0..100_000 {
            let mut genes = [1.0, 2.0];
            mutation.apply(&mut genes, &bounds, &mut stream);
            assert!((-1.0..=3.0).contains(&genes[0]) && genes[1] == 2.0);
            moved += u32::from(genes[0] != 1.0);
            far += u32::from((genes[0] - 1.0).abs() > 0.4);
            up += u32::from(genes[0] > 1.0);
        }
        let fifth = |x: f64| x * x * x * x * x;
        let expected = 50_000.0 * (fifth(0.9) - fifth(0.5)) / (1.0 - fifth(0.5));
        assert!((f64::from(moved) - 50_000.0).abs() < 800.0, "{moved}");
        assert!((f64::from(far) - expected).abs() < 800.0, "{far} for {expected}");
        assert!((f64::from(up) - f64::from(moved) / 2.0).abs() < 800.0, "{up} of {moved}");
    }

    #[test]
    fn the_ends_of_a_range_stay_within() {
        let mutation = PolynomialMutation { rate: 1.0, eta: 20.0 };
        let (mut stream, bounds) = (Stream::from_seed(5), [[0.0, 1.0], [-1e100, 1e100]]);
        let mut genes = [0.0, 1e100];
        for _ in 0..10_000 {
            mutation.apply(&mut genes, &bounds, &mut stream);
            assert!((0.0..=1.0).contains(&genes[0]) && (-1e100..=1e100).contains(&genes[1]), "{genes:?}");
        }
    }
}
