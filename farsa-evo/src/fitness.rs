//! A fitness value that can always be compared.

use alloc::vec::Vec;
use core::cmp::{Ordering, Reverse};

use crate::error::EvoError;

/// Result of an evaluation, in whatever unit the experiment uses. Larger is better, and the value is never NaN.
///
/// Fitness has a total order, so any two values can be compared. Since minus zero is stored as zero, equal values also
/// have equal bits. With the feature `serde`, a fitness is serialized as an optional number that is absent for a failed
/// evaluation. This is because text formats such as JSON cannot represent infinity.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "serde", serde(try_from = "Option<f64>", into = "Option<f64>"))]
pub struct Fitness(f64);

impl Fitness {
    /// Fitness of a failed evaluation. It is minus infinity, so it ranks below every other fitness.
    pub const WORST: Self = Self(f64::NEG_INFINITY);

    /// Creates a fitness from a value, or returns `None` if the value is NaN.
    pub const fn new(value: f64) -> Option<Self> {
        // Adding zero turns minus zero into zero and changes nothing else.
        if value.is_nan() { None } else { Some(Self(value + 0.0)) }
    }

    /// Creates a fitness from a value, where NaN becomes [`Fitness::WORST`]. Use this if an evaluation whose arithmetic
    /// broke down should count as failed.
    pub const fn nan_as_failed(value: f64) -> Self {
        match Self::new(value) {
            Some(fitness) => fitness,
            None => Self::WORST,
        }
    }

    /// Gets the value. For a failed evaluation this is minus infinity.
    pub const fn get(self) -> f64 {
        self.0
    }

    /// Sorts individuals by fitness and returns their indices, best first. If two individuals are equally good, the one
    /// with the lower index comes first.
    ///
    /// ```
    /// use farsa_evo::Fitness;
    ///
    /// let fitness = [1.0, 5.0, f64::NAN, 5.0].map(Fitness::nan_as_failed);
    /// assert_eq!(Fitness::ranking(&fitness), [1, 3, 0, 2]);
    /// ```
    pub fn ranking(fitness: &[Self]) -> Vec<usize> {
        let mut order: Vec<usize> = (0..fitness.len()).collect();
        order.sort_by_key(|&individual| Reverse(fitness.get(individual)));
        order
    }

    /// Checks whether the evaluation failed, that is, whether this is [`Fitness::WORST`].
    pub const fn is_failed(self) -> bool {
        self.0 == f64::NEG_INFINITY
    }
}

// Sound because NaN is kept out: equality is reflexive, and the order below agrees with it because -0.0 is kept out.
impl Eq for Fitness {}

impl Ord for Fitness {
    fn cmp(&self, other: &Self) -> Ordering {
        self.0.total_cmp(&other.0)
    }
}

impl PartialOrd for Fitness {
    fn partial_cmp(&self, other: &Self) -> Option<Ordering> {
        Some(self.cmp(other))
    }
}

impl TryFrom<f64> for Fitness {
    type Error = EvoError;

    /// Converts a value that must not be NaN.
    ///
    /// # Errors
    /// Returns [`EvoError::NanFitness`].
    fn try_from(value: f64) -> Result<Self, EvoError> {
        Self::new(value).ok_or(EvoError::NanFitness)
    }
}

impl From<Fitness> for f64 {
    fn from(fitness: Fitness) -> Self {
        fitness.0
    }
}

#[cfg(feature = "serde")]
impl TryFrom<Option<f64>> for Fitness {
    type Error = EvoError;

    fn try_from(value: Option<f64>) -> Result<Self, EvoError> {
        value.map_or(Ok(Self::WORST), Self::try_from)
    }
}

#[cfg(feature = "serde")]
impl From<Fitness> for Option<f64> {
    fn from(fitness: Fitness) -> Self {
        (!fitness.is_failed()).then_some(fitness.0)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn nan_is_refused_or_failed() {
        for nan in [f64::NAN, -f64::NAN, f64::from_bits(0x7ff0_0000_0000_0001)] {
            assert_eq!(Fitness::new(nan), None);
            assert_eq!(Fitness::try_from(nan), Err(EvoError::NanFitness));
            assert_eq!(Fitness::nan_as_failed(nan), Fitness::WORST);
        }
        assert_eq!(Fitness::nan_as_failed(2.5).get(), 2.5);
    }

    #[test]
    fn the_order_is_that_of_the_numbers() {
        let rising = [f64::NEG_INFINITY, f64::MIN, -1.0, -f64::MIN_POSITIVE, 0.0, 1e-300, 1.0, f64::INFINITY];
        for (i, &a) in rising.iter().enumerate() {
            for (j, &b) in rising.iter().enumerate() {
                assert_eq!(Fitness::new(a).cmp(&Fitness::new(b)), i.cmp(&j));
            }
        }
        assert!(Fitness::WORST.is_failed() && !Fitness::nan_as_failed(f64::MIN).is_failed());
    }

    #[test]
    fn equal_individuals_rank_by_index() {
        let fitness = [1.0, 5.0, f64::NAN, 5.0, 1.0, f64::NAN].map(Fitness::nan_as_failed);
        assert_eq!(Fitness::ranking(&fitness), [1, 3, 0, 4, 2, 5]);
    }

    #[test]
    fn minus_zero_is_zero() {
        let (minus, plus) = (Fitness::nan_as_failed(-0.0), Fitness::nan_as_failed(0.0));
        assert_eq!((minus, minus.cmp(&plus)), (plus, Ordering::Equal));
        assert_eq!(minus.get().to_bits(), 0);
    }
}
