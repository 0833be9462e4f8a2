//! How far apart the individuals of a front lie.

use alloc::vec;
use alloc::vec::Vec;

/// The crowding distance of each individual of a front \[front\], given the objectives of all [individuals x m].
///
/// Of each objective, in the order of its values, it adds the difference of an individual's neighbours as a part of the whole
/// range; the first and the last are infinitely far from others. Equals lie in the order of the front. An objective of
/// which all values are the same, or one is infinite, adds nothing but that.
///
/// Source: \[Deb2002\] section III.B. Deviation: what is said of objectives without a finite range, on which it is silent.
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

#[cfg(test)]
mod tests {
    use super::*;

    const FAR: f64 = f64::INFINITY;

    #[test]
    fn distances_by_hand() {
        // Three objectives, of which the last is the same everywhere, so that the order is that of the indices.
        let objectives = [1.0, 9.0, 5.0, 2.0, 6.0, 5.0, 4.0, 5.0, 5.0, 5.0, 1.0, 5.0, 11.0, 0.0, 5.0];
        let want = [FAR, 3.0 / 10.0 + 4.0 / 9.0, 3.0 / 10.0 + 5.0 / 9.0, 7.0 / 10.0 + 5.0 / 9.0, FAR];
        assert_eq!(crowding_distances(&objectives, 3, &[0, 1, 2, 3, 4]), want);
        // Of a part of them: 2 stands between 1 and 4, 3 is the last of the first objective.
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
        // An infinite objective says nothing of the others' distance.
        assert_eq!(crowding_distances(&[0.0, 4.0, 1.0, 3.0, FAR, 0.0], 2, &[0, 1, 2]), [FAR, 1.0, FAR]);
    }
}
