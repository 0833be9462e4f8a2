//! An archive of behaviours, and how new one is.

use alloc::vec::Vec;

use farsa_num::Scalar;

/// The mean distance of each behaviour of a generation to the k nearest of the others and of an archive, of as many as there
/// are if they are fewer; 0 if there are none. Behaviours that are none, being of failed evaluations, have none and are
/// nobody's neighbours. [rows x d]
pub(super) fn novelty(rows: &[Option<&[f64]>], archive: &[f64], d: usize, k: usize) -> Vec<Option<f64>> {
    let mut nearest: Vec<f64> = Vec::with_capacity(k.min(rows.len() + archive.len() / d.max(1)));
    let mut of = |own: usize, behaviour: &[f64]| {
        nearest.clear();
        let others = rows.iter().enumerate().filter(|(other, _)| *other != own).filter_map(|(_, row)| *row);
        for other in others.chain(archive.chunks_exact(d.max(1))) {
            let square = other.iter().zip(behaviour).fold(0.0, |sum, (a, b)| sum + (a - b) * (a - b));
            if nearest.len() == k && nearest.last().is_some_and(|farthest| square >= *farthest) {
                continue;
            }
            nearest.truncate(k - 1);
            let place = nearest.partition_point(|near| *near <= square);
            nearest.insert(place, square);
        }
        let sum: f64 = nearest.iter().map(|square| Scalar::sqrt(*square)).sum();
        if nearest.is_empty() { 0.0 } else { sum / nearest.len() as f64 }
    };
    rows.iter().enumerate().map(|(own, row)| row.map(|behaviour| of(own, behaviour))).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use alloc::vec;
    use proptest::prelude::*;

    /// By the definition: all distances, sorted.
    fn naive(rows: &[Option<&[f64]>], archive: &[f64], d: usize, k: usize) -> Vec<Option<f64>> {
        let of = |own: usize| {
            let mut all: Vec<&[f64]> = archive.chunks(d).collect();
            all.extend((0..rows.len()).filter(|other| *other != own).filter_map(|other| rows[other]));
            let distance = |other: &&[f64]| {
                other.iter().zip(rows[own].unwrap()).map(|(a, b)| (a - b) * (a - b)).sum::<f64>().sqrt()
            };
            let mut distances: Vec<f64> = all.iter().map(distance).collect();
            distances.sort_by(f64::total_cmp);
            distances.truncate(k);
            distances.iter().sum::<f64>() / distances.len().max(1) as f64
        };
        (0..rows.len()).map(|own| rows[own].map(|_| of(own))).collect()
    }

    proptest! {
        #[test]
        fn novelty_is_that_of_the_definition(
            d in 1_usize..4,
            k in 1_usize..20,
            rows in proptest::collection::vec(-4_i8..5, 0..60),
            failed in proptest::collection::vec(any::<bool>(), 60),
            archive in proptest::collection::vec(-4_i8..5, 0..60),
        ) {
            let row = |values: &[i8]| values[..values.len() / d * d].iter().map(|x| f64::from(*x)).collect::<Vec<f64>>();
            let (all, archive) = (row(&rows), row(&archive));
            let rows: Vec<Option<&[f64]>> = all.chunks(d).zip(&failed).map(|(row, failed)| (!failed).then_some(row)).collect();
            prop_assert_eq!(novelty(&rows, &archive, d, k), naive(&rows, &archive, d, k));
        }
    }

    #[test]
    fn distances_by_hand() {
        let rows: Vec<Option<&[f64]>> = vec![Some(&[0.0, 0.0]), Some(&[3.0, 4.0]), None, Some(&[6.0, 8.0])];
        assert_eq!(
            novelty(&rows, &[0.0, 1.0], 2, 2),
            [Some(3.0), Some(0.5 * (5.0 + 18.0_f64.sqrt())), None, Some(0.5 * (5.0 + 85.0_f64.sqrt()))]
        );
        assert_eq!(novelty(&rows[..1], &[], 2, 5), [Some(0.0)]);
    }
}
