//! Shares of successes with intervals, and Fisher's exact test.

/// 97.5 % quantile of the normal distribution.
pub(crate) const Z: f64 = 1.959_963_984_540_054;

/// A number of successes and of trials.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) struct Proportion {
    pub(crate) successes: usize,
    pub(crate) of: usize,
}

impl Proportion {
    /// Computes the 95 % interval of [Wilson1927], or 0 to 1 without trials.
    pub(crate) fn interval(self) -> [f64; 2] {
        if self.of == 0 {
            return [0.0, 1.0];
        }
        let n = self.of as f64;
        let share = self.successes as f64 / n;
        let centre = share + Z * Z / (2.0 * n);
        let reach = Z * (share * (1.0 - share) / n + Z * Z / (4.0 * n * n)).sqrt();
        let scale = 1.0 + Z * Z / n;
        // Exact ends, without rounding errors.
        let low = if self.successes == 0 { 0.0 } else { (centre - reach) / scale };
        let high = if self.successes == self.of { 1.0 } else { (centre + reach) / scale };
        [low, high]
    }
}

/// Returns the two-sided p of [Fisher1922]'s exact test, the probability of all equally or less probable tables of equal sums.
///
/// As in R and `SciPy`, probabilities within 1e-7 count as equal.
pub(crate) fn fisher(first: Proportion, second: Proportion) -> f64 {
    let successes = first.successes + second.successes;
    // The number of successes in the first group, the only free value.
    let (least, most) = (successes.saturating_sub(second.of), successes.min(first.of));
    // Each probability results from that of a neighboring table, from the most probable one on, so that nothing overflows.
    let next = |x: usize| {
        let ways = (first.of - x) as f64 * (successes - x) as f64;
        ways / ((x + 1) as f64 * (second.of + x + 1 - successes) as f64)
    };
    let mut peak = least;
    while peak < most && next(peak) > 1.0 {
        peak += 1;
    }
    let mut weights = vec![1.0; most - least + 1];
    for x in peak..most {
        weights[x + 1 - least] = weights[x - least] * next(x);
    }
    for x in (least..peak).rev() {
        weights[x - least] = weights[x + 1 - least] / next(x);
    }
    let limit = weights[first.successes - least] * (1.0 + 1e-7);
    let total: f64 = weights.iter().sum();
    let as_rare: f64 = weights.iter().filter(|weight| **weight <= limit).sum();
    as_rare / total
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::figures::fixture::fixture;
    use proptest::prelude::*;

    #[test]
    fn intervals_are_those_of_scipy() {
        for case in fixture("wilson") {
            let [successes, of] = ["successes", "of"].map(|name| case[name].as_u64().unwrap() as usize);
            let expected = ["low", "high"].map(|name| case[name].as_f64().unwrap());
            let found = Proportion { successes, of }.interval();
            for (found, expected) in found.into_iter().zip(expected) {
                assert!((found - expected).abs() < 1e-14, "{successes} of {of}: {found} where SciPy has {expected}");
            }
        }
        assert_eq!(Proportion { successes: 0, of: 0 }.interval(), [0.0, 1.0]);
    }

    #[test]
    fn tables_have_the_p_of_scipy() {
        for case in fixture("fisher") {
            let [a, b, c, d] = ["a", "b", "c", "d"].map(|name| case[name].as_u64().unwrap() as usize);
            let p = case["p"].as_f64().unwrap();
            let found = fisher(Proportion { successes: a, of: a + b }, Proportion { successes: c, of: c + d });
            assert!((found - p).abs() <= 1e-11 * p, "{a} {b} {c} {d}: {found:e} where SciPy has {p:e}");
        }
    }

    /// Computes the number of choices of k of n, exact up to 2^64.
    fn choose(n: u64, k: u64) -> u64 {
        (0..k).fold(1, |ways, i| ways * (n - i) / (i + 1))
    }

    proptest! {
        /// Fisher's test with integers.
        #[test]
        fn fishers_test_counts_tables(a in 0_usize..12, b in 0_usize..12, c in 0_usize..12, d in 0_usize..12) {
            let [first, second] = [(a, b), (c, d)].map(|(successes, failures)| Proportion { successes, of: successes + failures });
            let (n, m, all) = (first.of as u64, second.of as u64, (a + c) as u64);
            let ways = |x: u64| choose(n, x) * choose(m, all - x);
            let limit = ways(a as u64);
            let tables = || all.saturating_sub(m)..=all.min(n);
            let rare: u64 = tables().map(ways).filter(|ways| *ways <= limit).sum();
            let total: u64 = tables().map(ways).sum();
            let p = fisher(first, second);
            prop_assert!((p - rare as f64 / total as f64).abs() < 1e-12, "{}", p);
            // Exchanging groups or outcomes does not change p.
            prop_assert!((fisher(second, first) - p).abs() < 1e-12);
            let failed = [first, second].map(|group| Proportion { successes: group.of - group.successes, of: group.of });
            prop_assert!((fisher(failed[0], failed[1]) - p).abs() < 1e-12);
        }

        #[test]
        fn an_interval_holds_its_share(of in 1_usize..1000, part in 0.0..=1.0) {
            let successes = ((of as f64 * part) as usize).min(of);
            let [low, high] = Proportion { successes, of }.interval();
            let share = successes as f64 / of as f64;
            prop_assert!(0.0 <= low && low <= share && share <= high && high <= 1.0, "{low} {share} {high}");
        }
    }
}
