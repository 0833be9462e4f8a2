//! Order statistics over a few runs, and an exact test of two groups of them.

/// The middle of some values and how far their middle half reaches.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Quartiles {
    pub(crate) lower: f64,
    pub(crate) median: f64,
    pub(crate) upper: f64,
}

impl Quartiles {
    /// Of values in any order, interpolated linearly between neighbours as R and `NumPy` do by default; none of no values.
    ///
    /// Minus infinity is a value like any other: that of a generation in which all failed.
    pub(crate) fn from_values(values: &[f64]) -> Option<Self> {
        let mut sorted = values.to_vec();
        sorted.sort_by(f64::total_cmp);
        let at = |share: f64| {
            let place = share * sorted.len().checked_sub(1)? as f64;
            let below = *sorted.get(place.floor() as usize)?;
            let above = *sorted.get(place.ceil() as usize)?;
            let weight = place - place.floor();
            // Equal neighbours stay what they are, also when they are infinite.
            Some(if below == above { below } else { (1.0 - weight) * below + weight * above })
        };
        Some(Self { lower: at(0.25)?, median: at(0.5)?, upper: at(0.75)? })
    }
}

/// The median of values in any order.
pub(crate) fn median(values: &[f64]) -> Option<f64> {
    Quartiles::from_values(values).map(|quartiles| quartiles.median)
}

/// Most values that [`compare`] takes together: beyond it the count of arrangements takes too long.
const MOST: usize = 200;

/// How two groups of values differ.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Comparison {
    /// Mann and Whitney's U of the first group: pairs in which its value is the larger, ties as one half.
    pub(crate) u: f64,
    /// U by the number of pairs: the probability that a value of the first group is larger than one of the second.
    pub(crate) larger: f64,
    /// The probability of a U at least as far from its mean, were the groups formed by chance; two-sided and exact.
    pub(crate) p: f64,
}

/// Compares two groups by [Mann1947]; none if one has less than two values, both have very many, or one is not a number.
///
/// Deviation: the distribution is counted over all ways to divide the very values at hand, so that it is exact with ties
/// too.
pub(crate) fn compare(first: &[f64], second: &[f64]) -> Option<Comparison> {
    let (n, all) = (first.len(), first.len() + second.len());
    if n < 2 || second.len() < 2 || all > MOST || first.iter().chain(second).any(|x| x.is_nan()) {
        return None;
    }
    let mut sorted: Vec<(f64, bool)> =
        first.iter().map(|&x| (x, true)).chain(second.iter().map(|&x| (x, false))).collect();
    sorted.sort_by(|a, b| a.0.total_cmp(&b.0));
    // Ranks from 1, equals sharing their mean; doubled, they are whole numbers.
    let mut ranks: Vec<usize> = Vec::with_capacity(all);
    for equals in sorted.chunk_by(|a, b| a.0 == b.0) {
        let before = ranks.len();
        ranks.extend(std::iter::repeat_n(2 * before + equals.len() + 1, equals.len()));
    }
    let sum: usize = ranks.iter().zip(&sorted).filter(|(_, value)| value.1).map(|(rank, _)| rank).sum();

    // ways[k][s]: in how many ways k of the values have ranks that add up to s.
    let largest: usize = ranks.iter().sum();
    let mut ways = vec![vec![0.0_f64; largest + 1]; n + 1];
    ways[0][0] = 1.0;
    for &rank in &ranks {
        for k in (1..=n).rev() {
            let (fewer, these) = ways.split_at_mut(k);
            for (to, from) in these[0][rank..].iter_mut().zip(&fewer[k - 1]) {
                *to += from;
            }
        }
    }
    // The mean of the doubled sum is n (all + 1).
    let distance = |sum: usize| sum.abs_diff(n * (all + 1));
    let total: f64 = ways[n].iter().sum();
    let far: f64 =
        ways[n].iter().enumerate().filter(|(s, _)| distance(*s) >= distance(sum)).map(|(_, ways)| ways).sum();

    let u = sum as f64 / 2.0 - (n * (n + 1)) as f64 / 2.0;
    Some(Comparison { u, larger: u / (n * second.len()) as f64, p: far / total })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn quartiles_are_those_computed_by_hand() {
        let of = |values: &[f64]| Quartiles::from_values(values).map(|q| [q.lower, q.median, q.upper]);
        assert_eq!(of(&[]), None);
        assert_eq!(of(&[7.0]), Some([7.0; 3]));
        assert_eq!(of(&[3.0, 1.0]), Some([1.5, 2.0, 2.5]));
        assert_eq!(of(&[5.0, 1.0, 3.0]), Some([2.0, 3.0, 4.0]));
        // Places 0.75, 1.5 and 2.25 of 0 to 3.
        assert_eq!(of(&[10.0, 40.0, 20.0, 30.0]), Some([17.5, 25.0, 32.5]));
        assert_eq!(of(&[1.0, 2.0, 3.0, 4.0, 5.0]), Some([2.0, 3.0, 4.0]));
        let failed = f64::NEG_INFINITY;
        assert_eq!(of(&[failed, failed, 1.0, 3.0, 2.0]), Some([failed, 1.0, 2.0]));
        assert_eq!(median(&[2.0, 1.0]), Some(1.5));
    }

    #[test]
    fn groups_that_do_not_overlap_have_the_smallest_p_there_is() {
        // One of the 20 ways to divide six values, and its mirror image.
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
        let found = compare(&first, &second).unwrap();
        let pairs = first.iter().flat_map(|a| second.iter().map(move |b| a > b)).filter(|&larger| larger).count();
        // SciPy's documentation of `mannwhitneyu`: U = 17, exact p = 0.1111.
        assert_eq!((found.u, pairs), (17.0, 17));
        assert!((found.p - 14.0 / 126.0).abs() < 1e-15, "{found:?}");
        // Ranks 1, 2.5 against 2.5, 4: four of the six divisions are as far from the mean of 5 as 3.5 is.
        let tied = compare(&[1.0, 2.0], &[2.0, 3.0]).unwrap();
        assert_eq!((tied.u, tied.larger, tied.p), (0.5, 0.125, 4.0 / 6.0));
        assert_eq!(compare(&[1.0, 1.0], &[1.0, 1.0]).unwrap().p, 1.0);
    }
}
