//! Outlines of convex obstacles in double precision: hulls, checks, distances.

use alloc::vec::Vec;

use farsa_num::Scalar;

use crate::arena::error::{ArenaError, ConvexFault, Part};

/// A point in the plane [m].
type Point2 = [f64; 2];

/// Corners that are no farther apart are the same [m].
pub(crate) const LEAST: f64 = 1e-6;
/// Rounding may dent a straight side so much [m].
const SLACK: f64 = 1e-9;

fn apart(a: Point2, b: Point2) -> f64 {
    let [x, y] = [b[0] - a[0], b[1] - a[1]];
    Scalar::sqrt(x * x + y * y)
}

/// Twice the area of the triangle, positive if it runs counter-clockwise.
fn turn(a: Point2, b: Point2, c: Point2) -> f64 {
    (b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0])
}

/// Returns the distance of a place to the right of the line from `a` to `b` [m].
fn beyond([a, b]: [Point2; 2], place: Point2) -> f64 {
    -turn(a, b, place) / apart(a, b)
}

/// The sides of a closed polygon, from each corner to the next.
pub(crate) fn sides(corners: &[Point2]) -> impl Iterator<Item = [Point2; 2]> + '_ {
    corners.iter().zip(corners.iter().cycle().skip(1)).map(|(a, b)| [*a, *b])
}

/// The convex hull of places, counter-clockwise from the lowest x. Fewer than three places if it has no area.
///
/// Source: own, after Andrew's monotone chain.
pub(crate) fn hull(places: &[Point2]) -> Vec<Point2> {
    fn extend(chain: &mut Vec<Point2>, least: usize, place: Point2) {
        while chain.len() >= least && turn(chain[chain.len() - 2], chain[chain.len() - 1], place) <= 0.0 {
            chain.pop();
        }
        chain.push(place);
    }
    // No negative zeros: they would sort before what is equal to them.
    let mut sorted: Vec<Point2> = places.iter().map(|place| place.map(|x| x + 0.0)).collect();
    sorted.sort_by(|a, b| a[0].total_cmp(&b[0]).then(a[1].total_cmp(&b[1])));
    sorted.dedup();
    let mut chain = Vec::with_capacity(sorted.len() + 1);
    // The lower side from left to right, then the upper one back.
    for place in &sorted {
        extend(&mut chain, 2, *place);
    }
    let least = chain.len() + 1;
    for place in sorted.iter().rev().skip(1) {
        extend(&mut chain, least, *place);
    }
    chain.pop();
    chain
}

/// Returns the largest distance of a place beyond a side of an outline [m], negative within.
fn gap(outline: &[Point2], place: Point2) -> f64 {
    sides(outline).map(|side| beyond(side, place)).fold(f64::NEG_INFINITY, Scalar::max)
}

/// Distance from a place to an outline [m], negative within.
pub(crate) fn distance(outline: &[Point2], place: Point2) -> f64 {
    let gap = gap(outline, place);
    if gap <= 0.0 {
        return gap;
    }
    let to_side = |[a, b]: [Point2; 2]| {
        let [x, y] = [b[0] - a[0], b[1] - a[1]];
        let along = ((place[0] - a[0]) * x + (place[1] - a[1]) * y) / (x * x + y * y);
        let along = along.clamp(0.0, 1.0);
        apart([a[0] + along * x, a[1] + along * y], place)
    };
    sides(outline).map(to_side).fold(f64::INFINITY, Scalar::min)
}

/// The smallest breadth of an outline [m], or 0 if it has no area.
pub(crate) fn width(outline: &[Point2]) -> f64 {
    if outline.len() < 3 {
        return 0.0;
    }
    let breadth =
        |side: [Point2; 2]| outline.iter().map(|corner| -beyond(side, *corner)).fold(f64::NEG_INFINITY, Scalar::max);
    sides(outline).map(breadth).fold(f64::INFINITY, Scalar::min)
}

/// Returns whether corners follow each other around a convex polygon, either way.
pub(crate) fn check_turns(part: Part, corners: &[Point2], outline: &[Point2]) -> Result<(), ArenaError> {
    for (i, a) in corners.iter().enumerate() {
        for (j, b) in corners.iter().enumerate().skip(i + 1) {
            let distance = apart(*a, *b);
            if distance < LEAST {
                return Err(ArenaError::Convex { part, fault: ConvexFault::SameCorner { corners: [i, j], distance } });
            }
        }
    }
    let dents = corners.iter().enumerate().map(|(i, corner)| (i, -gap(outline, *corner)));
    let deepest = dents.fold((0, SLACK), |most, dent| if dent.1 > most.1 { dent } else { most });
    if deepest.1 > SLACK {
        return Err(ArenaError::Convex { part, fault: ConvexFault::Dent { corner: deepest.0, depth: deepest.1 } });
    }
    // All are on the hull. Where two sides cross, one has corners on both hands.
    let area: f64 = sides(corners).map(|[a, b]| turn(corners[0], a, b)).sum();
    let hand = if area < 0.0 { -1.0 } else { 1.0 };
    for (i, side) in sides(corners).enumerate() {
        if let Some(corner) = corners.iter().position(|corner| hand * beyond(side, *corner) > SLACK) {
            return Err(ArenaError::Convex {
                part,
                fault: ConvexFault::OutOfTurn { side: [i, (i + 1) % corners.len()], corner },
            });
        }
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    proptest! {
        #[test]
        fn hulls_hold_their_places(places in prop::collection::vec(prop::array::uniform2(-9_i32..9), 0..30)) {
            let places: Vec<Point2> = places.into_iter().map(|place| place.map(f64::from)).collect();
            let hull = hull(&places);
            prop_assert!(hull.iter().all(|corner| places.contains(corner)));
            if hull.len() > 2 {
                for i in 0..hull.len() {
                    prop_assert!(turn(hull[i], hull[(i + 1) % hull.len()], hull[(i + 2) % hull.len()]) > 0.0);
                }
                prop_assert!(places.iter().all(|place| gap(&hull, *place) <= 1e-12));
            } else {
                // All on a line.
                let [a, b] = [hull.first(), hull.last()].map(|x| x.copied().unwrap_or_default());
                prop_assert!(places.iter().all(|place| turn(a, b, *place) == 0.0));
            }
        }
    }

    #[test]
    fn the_width_is_the_narrowest() {
        let triangle = [[0.0, 0.0], [4.0, 0.0], [0.0, 3.0]];
        assert!((width(&triangle) - 2.4).abs() < 1e-12);
        assert_eq!(width(&triangle[..2]), 0.0);
        assert!((distance(&triangle, [5.0, -1.0]) - 2.0_f64.sqrt()).abs() < 1e-12);
        assert!((distance(&triangle, [0.5, 0.25]) + 0.25).abs() < 1e-12);
    }
}
