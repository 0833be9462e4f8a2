//! The nearest of many points.

use alloc::vec;
use alloc::vec::Vec;

/// Points of a leaf, which are compared one by one.
const LEAF: usize = 6;

/// A k-d tree over points that do not change. It finds exactly the point that a comparison with all finds, the first of
/// equals.
///
/// Source: \[Bentley1975\]. Deviations: leaves have a few points, and a node splits the axis along which its points spread
/// most.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Nearest {
    d: usize,
    /// The points in the order of the leaves [points x d].
    points: Vec<f64>,
    /// The number of each of them.
    numbers: Vec<u32>,
    /// The axis and the split of each inner node. The children of node i are 2 i + 1 and 2 i + 2.
    splits: Vec<(u32, f64)>,
}

/// The best so far: the squared distance and the number.
#[derive(Clone, Copy)]
struct Best {
    square: f64,
    number: u32,
}

impl Nearest {
    /// A tree over points [points x d], of which there is one at least and d is 1 or more.
    pub(super) fn new(points: &[f64], d: usize) -> Self {
        let count = points.len() / d.max(1);
        let mut numbers: Vec<u32> = (0..count as u32).collect();
        let mut splits = Vec::new();
        split(points, d, &mut numbers, 0, &mut splits);
        let row = |number: &u32| points.get(*number as usize * d..(*number as usize + 1) * d).unwrap_or_default();
        Self { d, points: numbers.iter().flat_map(row).copied().collect(), numbers, splits }
    }

    /// The number of the nearest point.
    pub(super) fn find(&self, point: &[f64]) -> usize {
        let mut best = Best { square: f64::INFINITY, number: u32::MAX };
        self.search(point, 0, 0, self.numbers.len(), &mut best);
        // On overflow all distances are infinite, and the first centroid is the nearest.
        if best.number == u32::MAX { 0 } else { best.number as usize }
    }

    fn search(&self, point: &[f64], node: usize, start: usize, end: usize, best: &mut Best) {
        if end - start <= LEAF {
            let rows = self.points[start * self.d..end * self.d].chunks_exact(self.d);
            for (own, &number) in rows.zip(&self.numbers[start..end]) {
                let square = own.iter().zip(point).fold(0.0, |sum, (a, b)| sum + (a - b) * (a - b));
                if square < best.square || square == best.square && number < best.number {
                    *best = Best { square, number };
                }
            }
            return;
        }
        let (axis, place) = self.splits[node];
        let (middle, beyond) = (start + (end - start) / 2, point[axis as usize] - place);
        let (lower, upper) = ((2 * node + 1, start, middle), (2 * node + 2, middle, end));
        // Points with the coordinate of the split may be on either side. The test with <= below finds them.
        let (near, far) = if beyond < 0.0 { (lower, upper) } else { (upper, lower) };
        self.search(point, near.0, near.1, near.2, best);
        // Rounding is monotonic, so no point beyond can be computed to be nearer than the split.
        if beyond * beyond <= best.square {
            self.search(point, far.0, far.1, far.2, best);
        }
    }
}

/// Orders the numbers of points so that half of them lie on each side of a split, and so on.
fn split(points: &[f64], d: usize, numbers: &mut [u32], node: usize, splits: &mut Vec<(u32, f64)>) {
    if numbers.len() <= LEAF {
        return;
    }
    let value = |number: u32, axis: usize| points[number as usize * d + axis];
    let mut ends = vec![[f64::INFINITY, f64::NEG_INFINITY]; d];
    for &number in numbers.iter() {
        for (axis, [low, high]) in ends.iter_mut().enumerate() {
            let x = value(number, axis);
            (*low, *high) = (low.min(x), high.max(x));
        }
    }
    let mut axis = 0;
    for (other, [low, high]) in ends.iter().enumerate() {
        if high - low > ends[axis][1] - ends[axis][0] {
            axis = other;
        }
    }
    let middle = numbers.len() / 2;
    // Ties by number make the two halves independent of the selection algorithm.
    let (_, &mut at, _) = numbers
        .select_nth_unstable_by(middle, |&a, &b| value(a, axis).total_cmp(&value(b, axis)).then_with(|| a.cmp(&b)));
    if splits.len() <= node {
        splits.resize(node + 1, (0, 0.0));
    }
    splits[node] = (axis as u32, value(at, axis));
    let (lower, upper) = numbers.split_at_mut(middle);
    split(points, d, lower, 2 * node + 1, splits);
    split(points, d, upper, 2 * node + 2, splits);
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    fn naive(points: &[f64], d: usize, point: &[f64]) -> usize {
        let square = |row: &[f64]| row.iter().zip(point).fold(0.0, |sum, (a, b)| sum + (a - b) * (a - b));
        let mut best = (f64::INFINITY, 0);
        for (number, row) in points.chunks(d).enumerate() {
            if square(row) < best.0 {
                best = (square(row), number);
            }
        }
        best.1
    }

    proptest! {
        /// On a coarse lattice, where many points are the same and many distances are equal, and between.
        #[test]
        fn it_finds_what_a_comparison_with_all_finds(
            d in 1_usize..5,
            lattice in proptest::collection::vec(-4_i8..5, 4..400),
            asked in proptest::collection::vec(-9_i8..10, 40),
            fine in any::<bool>(),
        ) {
            let scale = |x: &i8| f64::from(*x) * if fine { 0.37 } else { 0.5 };
            let mut points: Vec<f64> = lattice.iter().map(scale).collect();
            points.truncate(points.len() / d * d);
            let tree = Nearest::new(&points, d);
            for asked in asked.chunks_exact(d) {
                let point: Vec<f64> = asked.iter().map(|x| f64::from(*x) * 0.5).collect();
                prop_assert_eq!(tree.find(&point), naive(&points, d, &point));
            }
        }
    }

    #[test]
    fn numbers_that_overflow_find_a_point() {
        let points: Vec<f64> = (0..20).map(|i| f64::from(i) * 1e307).collect();
        assert!(Nearest::new(&points, 1).find(&[-1.7e308]) < 20);
    }
}
