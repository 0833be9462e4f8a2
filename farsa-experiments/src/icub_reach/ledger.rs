//! What a trial of `icub-reach` earns.

/// The distances of a trial from its start, or from when the target jumped.
#[derive(Clone, Copy, Debug, PartialEq, Default)]
pub struct Ledger {
    start: f64,
    last: f64,
    sum: f64,
    count: u32,
}

impl Ledger {
    /// Begins at a distance between hand and target \[m\].
    pub fn new(start: f64) -> Self {
        Self { start, last: start, sum: 0.0, count: 0 }
    }

    /// Adds the distance after a step \[m\], and whether it is one of the last steps.
    pub fn add(&mut self, distance: f64, counts: bool) {
        self.last = distance;
        if counts {
            self.sum += distance;
            self.count += 1;
        }
    }

    /// The distance at the start \[m\].
    pub fn start(&self) -> f64 {
        self.start
    }

    /// The distance after the last step \[m\].
    pub fn last(&self) -> f64 {
        self.last
    }

    /// The mean distance over the last steps, or the last distance where there were none \[m\].
    pub fn mean(&self) -> f64 {
        if self.count > 0 { self.sum / f64::from(self.count) } else { self.last }
    }

    /// 1 less the mean distance in parts of the start distance, which counts as `least` \[m\] where it is less; 0..1, or NaN.
    pub fn fitness(&self, least: f64) -> f64 {
        1.0 - (self.mean() / self.start.max(least)).clamp(0.0, 1.0)
    }
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;

    use super::*;

    #[test]
    fn fitness_is_that_of_a_calculation_by_hand() {
        let mut ledger = Ledger::new(0.2);
        assert_eq!((ledger.mean(), ledger.fitness(0.05)), (0.2, 0.0));
        ledger.add(0.9, false);
        ledger.add(0.03, true);
        ledger.add(0.05, true);
        // (0.03 + 0.05) / 2 / 0.2 = 0.2.
        assert!((ledger.mean() - 0.04).abs() < 1e-15 && (ledger.fitness(0.05) - 0.8).abs() < 1e-15);
        assert_eq!((ledger.start(), ledger.last()), (0.2, 0.05));
        // Of 0.4 m as the least it is a tenth.
        assert!((ledger.fitness(0.4) - 0.9).abs() < 1e-15);
        ledger.add(9.0, true);
        assert_eq!(ledger.fitness(0.05), 0.0);
        ledger.add(f64::NAN, true);
        assert!(ledger.fitness(0.05).is_nan());
    }

    proptest! {
        #[test]
        fn fitness_is_from_0_to_1(
            start in 0.0..2.0_f64,
            least in 0.001..1.0_f64,
            distances in prop::collection::vec((0.0..3.0_f64, any::<bool>()), 0..30),
        ) {
            let mut ledger = Ledger::new(start);
            for (distance, counts) in distances {
                ledger.add(distance, counts);
            }
            prop_assert!((0.0..=1.0).contains(&ledger.fitness(least)));
        }
    }
}
