//! Who is dominated by whom.

use alloc::vec;
use alloc::vec::Vec;

/// Whether objectives \[m\] are nowhere smaller than others, and somewhere larger.
pub fn dominates(objectives: &[f64], others: &[f64]) -> bool {
    let mut larger = false;
    for (own, other) in objectives.iter().zip(others) {
        if own < other {
            return false;
        }
        larger |= own > other;
    }
    larger
}

/// The fronts of individuals with these objectives [individuals x m], larger being better: first those that nobody
/// dominates, then those that only the first front dominates, and so on; in each front by index. No fronts for m = 0.
///
/// It asks at most 3 n^2 / 2 times whether one dominates another, and keeps a number for each individual.
///
/// Source: \[Deb2002\] section III.A, the fast non-dominated sorting. Deviations: larger is better, and the pairs that dominate
/// each other are found again where the source keeps them, which takes memory for n^2.
///
/// ```
/// use farsa_evo::pareto::non_dominated_fronts;
///
/// let objectives = [0.0, 3.0, 1.0, 1.0, 3.0, 0.0, 2.0, 2.0];
/// assert_eq!(non_dominated_fronts(&objectives, 2), [vec![0, 2, 3], vec![1]]);
/// ```
pub fn non_dominated_fronts(objectives: &[f64], m: usize) -> Vec<Vec<usize>> {
    if m == 0 {
        return Vec::new();
    }
    let rows: Vec<&[f64]> = objectives.chunks_exact(m).collect();
    let mut dominated_by = vec![0_usize; rows.len()];
    for (i, own) in rows.iter().enumerate() {
        for (j, other) in rows.iter().enumerate().skip(i + 1) {
            if dominates(own, other) {
                dominated_by[j] += 1;
            } else if dominates(other, own) {
                dominated_by[i] += 1;
            }
        }
    }
    let (mut front, mut rest): (Vec<usize>, Vec<usize>) = (0..rows.len()).partition(|&i| dominated_by[i] == 0);
    let mut fronts = Vec::new();
    while !front.is_empty() {
        for &i in &front {
            for &j in rest.iter().filter(|&&j| dominates(rows[i], rows[j])) {
                dominated_by[j] -= 1;
            }
        }
        let next;
        (next, rest) = rest.into_iter().partition(|&j| dominated_by[j] == 0);
        fronts.push(core::mem::replace(&mut front, next));
    }
    fronts
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    /// By the definition: peel off, again and again, those that none of the rest dominates.
    fn naive(objectives: &[f64], m: usize) -> Vec<Vec<usize>> {
        let rows: Vec<&[f64]> = objectives.chunks(m).collect();
        let beats = |a: usize, b: usize| {
            rows[a].iter().zip(rows[b]).all(|(a, b)| a >= b) && rows[a].iter().zip(rows[b]).any(|(a, b)| a > b)
        };
        let (mut rest, mut fronts): (Vec<usize>, Vec<Vec<usize>>) = ((0..rows.len()).collect(), Vec::new());
        while !rest.is_empty() {
            let front: Vec<usize> = rest.iter().copied().filter(|&i| !rest.iter().any(|&j| beats(j, i))).collect();
            rest.retain(|i| !front.contains(i));
            fronts.push(front);
        }
        fronts
    }

    proptest! {
        #[test]
        fn fronts_are_those_of_the_definition(
            m in 1_usize..5,
            whole in proptest::collection::vec(-3_i32..4, 0..160),
            failed in proptest::collection::vec(any::<bool>(), 160),
        ) {
            // Few values, so that many are equal; some rows failed.
            let mut objectives: Vec<f64> = whole.iter().map(|x| f64::from(*x)).collect();
            objectives.truncate(objectives.len() / m * m);
            for (row, failed) in objectives.chunks_mut(m).zip(&failed) {
                if *failed && row[0] > 1.0 {
                    row.fill(f64::NEG_INFINITY);
                }
            }
            prop_assert_eq!(non_dominated_fronts(&objectives, m), naive(&objectives, m));
        }
    }

    #[test]
    fn failed_ones_are_the_last_front() {
        let worst = f64::NEG_INFINITY;
        let objectives = [worst, worst, 0.0, -1e300, worst, worst, f64::MIN, 0.0];
        assert_eq!(non_dominated_fronts(&objectives, 2), [vec![1, 3], vec![0, 2]]);
        assert!(non_dominated_fronts(&objectives, 0).is_empty() && non_dominated_fronts(&[], 2).is_empty());
    }
}
