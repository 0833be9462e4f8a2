//! Mann-Whitney U test, exact for small groups.

use crate::figures::normal::upper_tail;

/// Most values of both groups for the exact test, which takes too long beyond that.
const MAX_EXACT: usize = 200;

/// Comparison of two groups of values.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Comparison {
    /// Mann and Whitney's U of the first group: pairs in which its value is the larger, ties as one half.
    pub(crate) u: f64,
    /// U divided by the number of pairs, the probability that a value of the first group is the larger one.
    pub(crate) larger: f64,
    /// Two-sided probability of a U at least as far from its mean in random groups.
    pub(crate) p: f64,
    /// True for an exact `p`, false for the normal approximation.
    pub(crate) exact: bool,
}

/// Compares two groups by [Mann1947], or returns `None` for fewer than two values in a group and for NaN.
///
/// Up to 200 values p is exact, also with ties. It counts all ways to divide the given values. Beyond that p is the normal
/// approximation with the corrections of `SciPy` for ties and continuity.
pub(crate) fn compare(first: &[f64], second: &[f64]) -> Option<Comparison> {
    let (n, m, all) = (first.len(), second.len(), first.len() + second.len());
    if n < 2 || m < 2 || first.iter().chain(second).any(|x| x.is_nan()) {
        return None;
    }
    let mut sorted: Vec<(f64, bool)> =
        first.iter().map(|&x| (x, true)).chain(second.iter().map(|&x| (x, false))).collect();
    sorted.sort_by(|a, b| a.0.total_cmp(&b.0));
    // Ranks from 1, with the mean rank for ties. Doubled ranks are integers.
    let mut ranks: Vec<usize> = Vec::with_capacity(all);
    for equals in sorted.chunk_by(|a, b| a.0 == b.0) {
        let before = ranks.len();
        ranks.extend(std::iter::repeat_n(2 * before + equals.len() + 1, equals.len()));
    }
    let sum: usize = ranks.iter().zip(&sorted).filter(|(_, value)| value.1).map(|(rank, _)| rank).sum();
    let u = sum as f64 / 2.0 - (n * (n + 1)) as f64 / 2.0;
    let exact = all <= MAX_EXACT;
    let p = if exact { counted(&ranks, n, sum) } else { approximated(&sorted, n, u) };
    Some(Comparison { u, larger: u / (n * m) as f64, p, exact })
}

/// Computes the share of the choices of `n` ranks whose sum is at least as far from the mean as this one.
fn counted(ranks: &[usize], n: usize, sum: usize) -> f64 {
    let count = ranks.len();
    // ways[k][s] is the number of choices of k values whose ranks add up to s.
    let largest: usize = ranks.iter().sum();
    let mut ways = vec![vec![0.0_f64; largest + 1]; n + 1];
    ways[0][0] = 1.0;
    for &rank in ranks {
        for k in (1..=n).rev() {
            let (fewer, these) = ways.split_at_mut(k);
            for (to, from) in these[0][rank..].iter_mut().zip(&fewer[k - 1]) {
                *to += from;
            }
        }
    }
    // The mean of the doubled sum is n (all + 1).
    let distance = |sum: usize| sum.abs_diff(n * (count + 1));
    let total: f64 = ways[n].iter().sum();
    let far: f64 =
        ways[n].iter().enumerate().filter(|(s, _)| distance(*s) >= distance(sum)).map(|(_, ways)| ways).sum();
    far / total
}

/// Computes the normal approximation of that share.
fn approximated(sorted: &[(f64, bool)], n: usize, u: f64) -> f64 {
    let [n, all] = [n, sorted.len()].map(|count| count as f64);
    let m = all - n;
    let ties: f64 = sorted.chunk_by(|a, b| a.0 == b.0).map(|equals| cube_less_itself(equals.len() as f64)).sum();
    let variance = n * m / 12.0 * ((all + 1.0) - ties / (all * (all - 1.0)));
    if variance <= 0.0 {
        // All values are equal.
        return 1.0;
    }
    let distance = (u - n * m / 2.0).abs() - 0.5;
    (2.0 * upper_tail(distance / variance.sqrt())).min(1.0)
}

fn cube_less_itself(t: f64) -> f64 {
    t * t * t - t
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::figures::fixture::fixture;
    use proptest::prelude::*;

    #[test]
    fn groups_that_do_not_overlap_have_the_smallest_p_there_is() {
        // Six values are divided in 20 ways, of which this one and its mirror image count.
        let apart = compare(&[4.0, 5.0, 6.0], &[1.0, 2.0, 3.0]).unwrap();
        assert_eq!((apart.u, apart.larger, apart.p), (9.0, 1.0, 0.1));
        let mirrored = compare(&[1.0, 2.0, 3.0], &[4.0, 5.0, 6.0]).unwrap();
        assert_eq!((mirrored.u, mirrored.larger, mirrored.p), (0.0, 0.0, 0.1));
        assert_eq!(compare(&[3.0, 4.0], &[1.0, 2.0]).unwrap().p, 2.0 / 6.0);
        // 252 ways.
        let five = compare(&[6.0, 7.0, 8.0, 9.0, 10.0], &[1.0, 2.0, 3.0, 4.0, 5.0]).unwrap();
        assert!((five.p - 2.0 / 252.0).abs() < 1e-15);
        assert_eq!(compare(&[1.0], &[1.0, 2.0]), None);
    }

    #[test]
    fn a_published_example_and_ties_by_hand() {
        let (first, second) = ([19.0, 22.0, 16.0, 29.0, 24.0], [20.0, 11.0, 17.0, 12.0]);
        let comparison = compare(&first, &second).unwrap();
        let pairs = first.iter().flat_map(|a| second.iter().map(move |b| a > b)).filter(|&larger| larger).count();
        // SciPy's documentation of `mannwhitneyu`: U = 17, exact p = 0.1111.
        assert_eq!((comparison.u, pairs), (17.0, 17));
        assert!((comparison.p - 14.0 / 126.0).abs() < 1e-15, "{comparison:?}");
        // Ranks 1, 2.5 against 2.5, 4. Four of the six divisions are as far from the mean of 5 as 3.5 is.
        let tied = compare(&[1.0, 2.0], &[2.0, 3.0]).unwrap();
        assert_eq!((tied.u, tied.larger, tied.p), (0.5, 0.125, 4.0 / 6.0));
        assert_eq!(compare(&[1.0, 1.0], &[1.0, 1.0]).unwrap().p, 1.0);
    }

    #[test]
    fn many_values_have_the_p_of_scipy() {
        for case in fixture("mann_whitney").into_iter().chain(fixture("mann_whitney_ties")) {
            let values = |name: &str| case[name].as_array().unwrap().iter().map(|x| x.as_f64().unwrap()).collect();
            let (first, second): (Vec<f64>, Vec<f64>) = (values("first"), values("second"));
            let comparison = compare(&first, &second).unwrap();
            let [u, p] = ["u", "p"].map(|name| case[name].as_f64().unwrap());
            assert_eq!((comparison.u, comparison.exact), (u, case["exact"].as_bool().unwrap()));
            assert!((comparison.p - p).abs() <= 1e-12 * p, "{comparison:?} where SciPy has {p:e}");
        }
    }

    #[test]
    fn equal_values_are_no_difference_however_many() {
        let comparison = compare(&[1.0; 150], &[1.0; 150]).unwrap();
        assert_eq!((comparison.p, comparison.larger, comparison.exact), (1.0, 0.5, false));
    }

    proptest! {
        /// All divisions of a few values, one by one.
        #[test]
        fn the_count_is_that_of_all_divisions(values in prop::collection::vec(0_i8..6, 4..10), n in 2_usize..4) {
            let values: Vec<f64> = values.into_iter().map(f64::from).collect();
            let n = n.min(values.len() - 2);
            let u = |chosen: u32| {
                let is = |index: usize| chosen >> index & 1 == 1;
                let pair = |a: f64, b: f64| if a > b { 1.0 } else if a == b { 0.5 } else { 0.0 };
                let others = || (0..values.len()).filter(|&j| !is(j));
                (0..values.len()).filter(|&i| is(i)).map(|i| others().map(|j| pair(values[i], values[j])).sum::<f64>()).sum::<f64>()
            };
            let mean = (n * (values.len() - n)) as f64 / 2.0;
            let first = u((1 << n) - 1);
            let divisions: Vec<u32> = (0_u32..1 << values.len()).filter(|set| set.count_ones() as usize == n).collect();
            let far = divisions.iter().filter(|&&set| (u(set) - mean).abs() >= (first - mean).abs()).count();
            let comparison = compare(&values[..n], &values[n..]).unwrap();
            prop_assert_eq!(comparison.u, first);
            prop_assert!((comparison.p - far as f64 / divisions.len() as f64).abs() < 1e-12);
        }
    }
}
