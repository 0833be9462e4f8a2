//! How much a set of points dominates.

use alloc::vec::Vec;

/// The area that points of two objectives dominate, larger being better, above a reference point; exact but for rounding.
///
/// What is not above the reference in both objectives adds nothing; neither does a point with a NaN.
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
    use super::*;
    use proptest::prelude::*;

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
