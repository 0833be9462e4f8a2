//! Computation of the reward in `icub-reach`.

/// The distances between hand and target collected during a trial. They are reset when the target moves.
#[derive(Clone, Copy, Debug, PartialEq, Default)]
pub struct RewardTotals {
    start: f64,
    last: f64,
    sum: f64,
    count: u32,
}

impl RewardTotals {
    /// Starts with the given distance between the hand and the target (in meters).
    pub fn new(start: f64) -> Self {
        Self { start, last: start, sum: 0.0, count: 0 }
    }

    /// Adds the distance after a step (in meters). Set `counts` to true if the step belongs to the final period.
    pub fn add(&mut self, distance: f64, counts: bool) {
        self.last = distance;
        if counts {
            self.sum += distance;
            self.count += 1;
        }
    }

    /// Gets the distance at the start (in meters).
    pub fn start(&self) -> f64 {
        self.start
    }

    /// Gets the distance after the last step (in meters).
    pub fn last(&self) -> f64 {
        self.last
    }

    /// Computes the mean distance in the final period (in meters). If there was no such step yet, it is the last
    /// distance.
    pub fn mean(&self) -> f64 {
        if self.count > 0 { self.sum / f64::from(self.count) } else { self.last }
    }

    /// Computes the fitness. It is 1 minus the ratio of the mean distance and the start distance. The start distance
    /// is at least `least` (in meters). The result is between 0 and 1, or NaN.
    pub fn fitness(&self, least: f64) -> f64 {
        // F = 1 - mean d / max(d0, least). The bound keeps a target near the start from a division by almost 0.
        1.0 - (self.mean() / self.start.max(least)).clamp(0.0, 1.0)
    }
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;

    use super::*;

    #[test]
    fn fitness_is_that_of_a_calculation_by_hand() {
        let mut totals = RewardTotals::new(0.2);
        assert_eq!((totals.mean(), totals.fitness(0.05)), (0.2, 0.0));
        totals.add(0.9, false);
        totals.add(0.03, true);
        totals.add(0.05, true);
        // (0.03 + 0.05) / 2 / 0.2 = 0.2.
        assert!((totals.mean() - 0.04).abs() < 1e-15 && (totals.fitness(0.05) - 0.8).abs() < 1e-15);
        assert_eq!((totals.start(), totals.last()), (0.2, 0.05));
        // With a least distance of 0.4 m it is a tenth.
        assert!((totals.fitness(0.4) - 0.9).abs() < 1e-15);
        totals.add(9.0, true);
        assert_eq!(totals.fitness(0.05), 0.0);
        totals.add(f64::NAN, true);
        assert!(totals.fitness(0.05).is_nan());
    }

    proptest! {
        #[test]
        fn fitness_is_from_0_to_1(
            start in 0.0..2.0_f64,
            least in 0.001..1.0_f64,
            distances in prop::collection::vec((0.0..3.0_f64, any::<bool>()), 0..30),
        ) {
            let mut totals = RewardTotals::new(start);
            for (distance, counts) in distances {
                totals.add(distance, counts);
            }
            prop_assert!((0.0..=1.0).contains(&totals.fitness(least)));
        }
    }
}
