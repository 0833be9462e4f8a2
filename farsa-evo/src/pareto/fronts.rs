//! Non-dominated fronts, crowding distances and the hypervolume.

use alloc::vec;
use alloc::vec::Vec;

/// Checks whether objectives \[m\] dominate others. This is the case if they are nowhere smaller and somewhere larger.
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

/// Sorts individuals with these objectives [individuals x m] into fronts, where larger is better. The first front has
/// the individuals that no other dominates, the second those that only the first dominates, and so on. Each front is in
/// order of index. If m is 0, there are no fronts.
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
    // Without NaN domination has no cycle, so each pass finds a front until all individuals have one.
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

/// Computes the crowding distance of each individual of a front \[front\], given the objectives of all individuals
/// [individuals x m].
///
/// For each objective, in the order of its values, it adds the difference of an individual's neighbors divided by the
/// range. The first and the last have infinite distance. Equals are in the order of the front. An objective with equal
/// values, or with an infinite one, adds nothing else.
///
/// Source: \[Deb2002\] section III.B. Deviation: the source does not define objectives without a finite range.
///
/// ```
/// use farsa_evo::pareto::crowding_distances;
///
/// let objectives = [0.0, 4.0, 1.0, 2.0, 3.0, 1.0, 4.0, 0.0];
/// // (3 - 0) / 4 + (4 - 1) / 4, and (4 - 1) / 4 + (2 - 0) / 4.
/// assert_eq!(crowding_distances(&objectives, 2, &[0, 1, 2, 3]), [f64::INFINITY, 1.5, 1.25, f64::INFINITY]);
/// ```
pub fn crowding_distances(objectives: &[f64], m: usize, front: &[usize]) -> Vec<f64> {
    let mut distances = vec![0.0; front.len()];
    for objective in 0..m {
        let value = |place: usize| objectives.get(front[place] * m + objective).copied().unwrap_or(f64::NEG_INFINITY);
        let mut order: Vec<usize> = (0..front.len()).collect();
        // The stable sort leaves equals in the order of the front.
        order.sort_by(|&a, &b| value(a).total_cmp(&value(b)));
        let (Some(&first), Some(&last)) = (order.first(), order.last()) else { return distances };
        let range = value(last) - value(first);
        (distances[first], distances[last]) = (f64::INFINITY, f64::INFINITY);
        if range > 0.0 && range.is_finite() {
            for three in order.windows(3) {
                distances[three[1]] += (value(three[2]) - value(three[0])) / range;
            }
        }
    }
    distances
}

/// Computes the area above a reference point that is dominated by points with two objectives, where larger is better.
/// The result is exact up to rounding.
///
/// Points that are not above the reference in both objectives, or have a NaN, add nothing.
///
/// Source: \[Zitzler1999\], the size of the space covered. Deviation: with a reference point and larger values
/// being better.
///
/// ```
/// use farsa_evo::pareto::hypervolume;
///
/// assert_eq!(hypervolume(&[[3.0, 1.0], [1.0, 2.0], [2.0, 1.0], [-1.0, 9.0]], [0.0, 0.0]), 4.0);
/// ```
pub fn hypervolume(points: &[[f64; 2]], reference: [f64; 2]) -> f64 {
    let mut above: Vec<[f64; 2]> =
        points.iter().copied().filter(|[x, y]| *x > reference[0] && *y > reference[1]).collect();
    // From the largest x on, a point adds the strip above the highest y so far. Among equal x the highest y is first,
    // and the others add nothing.
    above.sort_by(|a, b| b[0].total_cmp(&a[0]).then(b[1].total_cmp(&a[1])));
    let (mut area, mut highest) = (0.0, reference[1]);
    for [x, y] in above {
        if y > highest {
            area += (x - reference[0]) * (y - highest);
            highest = y;
        }
    }
    area
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;

    use super::*;

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
            // Few values, so that many are equal. Some rows failed.
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

    const FAR: f64 = f64::INFINITY;

    #[test]
    fn distances_by_hand() {
        // Three objectives, of which the last is the same everywhere, so that the order is that of the indices.
        let objectives = [1.0, 9.0, 5.0, 2.0, 6.0, 5.0, 4.0, 5.0, 5.0, 5.0, 1.0, 5.0, 11.0, 0.0, 5.0];
        let want = [FAR, 3.0 / 10.0 + 4.0 / 9.0, 3.0 / 10.0 + 5.0 / 9.0, 7.0 / 10.0 + 5.0 / 9.0, FAR];
        assert_eq!(crowding_distances(&objectives, 3, &[0, 1, 2, 3, 4]), want);
        // In this part 2 is between 1 and 4, and 3 is the last of the first objective.
        let want = [FAR, (5.0 - 2.0) / 3.0 + (6.0 - 1.0) / 5.0, FAR];
        assert_eq!(crowding_distances(&objectives, 3, &[1, 2, 3]), want);
    }

    #[test]
    fn few_and_equal_ones() {
        assert_eq!(crowding_distances(&[], 2, &[]), [0.0; 0]);
        assert_eq!(crowding_distances(&[3.0, 1.0], 2, &[0]), [FAR]);
        assert_eq!(crowding_distances(&[3.0, 1.0, 1.0, 3.0], 2, &[0, 1]), [FAR, FAR]);
        // Copies of one individual: those in the middle have no room.
        assert_eq!(crowding_distances(&[2.0; 8], 2, &[0, 1, 2, 3]), [FAR, 0.0, 0.0, FAR]);
        let failed = [f64::NEG_INFINITY; 6];
        assert_eq!(crowding_distances(&failed, 2, &[0, 1, 2]), [FAR, 0.0, FAR]);
        // An infinite objective does not change the distance of the others.
        assert_eq!(crowding_distances(&[0.0, 4.0, 1.0, 3.0, FAR, 0.0], 2, &[0, 1, 2]), [FAR, 1.0, FAR]);
    }

    proptest! {
        /// Whole coordinates, so that unit squares can be counted.
        #[test]
        fn the_area_is_that_of_the_squares_below_a_point(
            points in proptest::collection::vec(proptest::array::uniform2(-2_i32..12), 0..20),
        ) {
            let covered = |x: i32, y: i32| points.iter().any(|[a, b]| *a > x && *b > y);
            let squares = (0..12).flat_map(|x| (0..12).map(move |y| (x, y))).filter(|&(x, y)| covered(x, y)).count();
            let points: Vec<[f64; 2]> = points.iter().map(|point| point.map(f64::from)).collect();
            prop_assert_eq!(hypervolume(&points, [0.0, 0.0]), squares as f64);
        }
    }

    #[test]
    fn what_is_no_number_adds_nothing() {
        let (nan, worst) = (f64::NAN, f64::NEG_INFINITY);
        assert_eq!(hypervolume(&[[nan, 5.0], [5.0, nan], [worst, worst], [1.0, 1.0]], [0.0, 0.0]), 1.0);
        assert_eq!(hypervolume(&[], [0.0, 0.0]), 0.0);
    }
}
