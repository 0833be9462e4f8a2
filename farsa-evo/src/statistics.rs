//! A summary of each generation, for logs.

use crate::fitness::Fitness;

/// A summary of the fitness of one generation, in the unit that the experiment uses.
///
/// Failed evaluations are only counted in [`Statistics::failed`]. If all evaluations failed, then best, mean and worst
/// are minus infinity.
///
/// ```
/// use farsa_evo::{Fitness, Statistics};
///
/// let fitness = [1.0, f64::NAN, 3.0].map(Fitness::nan_as_failed);
/// let summary = Statistics::from_fitness(&fitness).expect("three evaluations");
/// assert_eq!((summary.best_index, summary.best, summary.mean, summary.failed), (2, 3.0, 2.0, 1));
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct Statistics {
    /// Index of the best individual. If there are several, this is the lowest index.
    pub best_index: usize,
    /// Largest fitness of the generation.
    pub best: f64,
    /// Mean over the evaluations that did not fail. Values are summed in the order of the individuals, so the result is
    /// reproducible.
    pub mean: f64,
    /// Smallest fitness, not counting failed evaluations.
    pub worst: f64,
    /// Number of evaluations that failed.
    pub failed: usize,
}

impl Statistics {
    /// Summarizes `fitness` \[individuals\]. If it is empty, this returns `None`.
    pub fn from_fitness(fitness: &[Fitness]) -> Option<Self> {
        let mut best = *fitness.first()?;
        let mut worst = Fitness::WORST;
        let (mut best_index, mut counted, mut sum) = (0, 0_usize, 0.0);
        for (index, &value) in fitness.iter().enumerate() {
            if value > best {
                (best, best_index) = (value, index);
            }
            if !value.is_failed() {
                // A failure is below every value, so the minimum begins with the first success.
                worst = if counted == 0 { value } else { worst.min(value) };
                counted += 1;
                sum += value.get();
            }
        }
        let mean = if counted == 0 { f64::NEG_INFINITY } else { sum / counted as f64 };
        Some(Self { best_index, best: best.get(), mean, worst: worst.get(), failed: fitness.len() - counted })
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use alloc::vec::Vec;

    fn summary(values: &[f64]) -> Option<Statistics> {
        Statistics::from_fitness(&values.iter().map(|&v| Fitness::nan_as_failed(v)).collect::<Vec<_>>())
    }

    #[test]
    fn failed_lives_are_counted_apart() {
        let expected = Statistics { best_index: 2, best: 4.0, mean: 2.0, worst: 1.0, failed: 2 };
        assert_eq!(summary(&[f64::NAN, 1.0, 4.0, f64::NAN, 1.0, 2.0]), Some(expected));
    }

    #[test]
    fn the_first_of_equals_is_the_best() {
        assert_eq!(summary(&[0.0, 7.0, 7.0]).map(|s| s.best_index), Some(1));
        assert_eq!(summary(&[7.0, 7.0]).map(|s| s.best_index), Some(0));
    }

    #[test]
    fn a_generation_of_failures_has_no_numbers() {
        let none = f64::NEG_INFINITY;
        assert_eq!(
            summary(&[f64::NAN; 3]),
            Some(Statistics { best_index: 0, best: none, mean: none, worst: none, failed: 3 })
        );
        assert_eq!(summary(&[]), None);
    }
}
