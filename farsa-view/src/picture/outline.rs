//! Flat outlines: convex hulls and clipping.

/// A point in a picture, from the upper left corner [pixels].
pub(crate) type Point2 = [f64; 2];

/// Returns the convex hull of places, counterclockwise with y upward, with fewer than three places if it has no area.
pub(crate) fn hull(places: &[Point2]) -> Vec<Point2> {
    let mut sorted = places.to_vec();
    sorted.sort_by(|a, b| a[0].total_cmp(&b[0]).then(a[1].total_cmp(&b[1])));
    sorted.dedup();
    let mut chain: Vec<Point2> = Vec::with_capacity(2 * sorted.len());
    // Andrew's monotone chain, with the lower side from left to right and the upper one back.
    let mut extend = |floor: usize, place: Point2| {
        while chain.len() > floor + 1 && turn(chain[chain.len() - 2], chain[chain.len() - 1], place) <= 0.0 {
            chain.pop();
        }
        chain.push(place);
        chain.len() - 1
    };
    let mut end = 0;
    for place in &sorted {
        end = extend(0, *place);
    }
    for place in sorted.iter().rev().skip(1) {
        extend(end, *place);
    }
    chain.pop();
    chain
}

/// Returns twice the area of a triangle, positive if counterclockwise with y upward.
fn turn(a: Point2, b: Point2, c: Point2) -> f64 {
    (b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0])
}

/// Returns true for a place in a hull or on its edge.
pub(crate) fn holds(hull: &[Point2], place: Point2) -> bool {
    hull.len() > 2 && (0..hull.len()).all(|i| turn(hull[i], hull[(i + 1) % hull.len()], place) >= 0.0)
}

/// Returns the lowest and highest x and y of places, `[low, high]`.
pub(crate) fn bounds(places: &[Point2]) -> [Point2; 2] {
    places.iter().fold([[f64::INFINITY; 2], [f64::NEG_INFINITY; 2]], |[low, high], place| {
        [[low[0].min(place[0]), low[1].min(place[1])], [high[0].max(place[0]), high[1].max(place[1])]]
    })
}

/// Clips a convex polygon to the part where the linear function `room` is not negative. `mix` interpolates between corners.
pub(crate) fn clip<P: Copy>(corners: &[P], room: impl Fn(&P) -> f64, mix: impl Fn(P, P, f64) -> P) -> Vec<P> {
    let mut clipped = Vec::with_capacity(corners.len() + 1);
    for (i, corner) in corners.iter().enumerate() {
        let next = &corners[(i + 1) % corners.len()];
        let (here, there) = (room(corner), room(next));
        if here >= 0.0 {
            clipped.push(*corner);
        }
        if (here >= 0.0) != (there >= 0.0) {
            clipped.push(mix(*corner, *next, here / (here - there)));
        }
    }
    clipped
}

/// Clips a convex polygon to a frame of this size with a `margin` around it.
pub(crate) fn framed(corners: &[Point2], size: [u32; 2], margin: f64) -> Vec<Point2> {
    let mix = |a: Point2, b: Point2, s: f64| [a[0] + (b[0] - a[0]) * s, a[1] + (b[1] - a[1]) * s];
    let mut clipped = corners.to_vec();
    for axis in 0..2 {
        let high = f64::from(size[axis]) + margin;
        clipped = clip(&clipped, |place| place[axis] + margin, mix);
        clipped = clip(&clipped, |place| high - place[axis], mix);
    }
    clipped
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    proptest! {
        #[test]
        fn hulls_hold_their_places(places in prop::collection::vec(prop::array::uniform2(-9i32..9), 0..30)) {
            let places: Vec<Point2> = places.into_iter().map(|place| place.map(f64::from)).collect();
            let hull = hull(&places);
            prop_assert!(hull.iter().all(|corner| places.contains(corner)));
            for i in 0..hull.len() {
                let [a, b, c] = [0, 1, 2].map(|k| hull[(i + k) % hull.len()]);
                prop_assert!(hull.len() < 3 || turn(a, b, c) > 0.0);
            }
            if hull.len() > 2 {
                prop_assert!(places.iter().all(|place| holds(&hull, *place)));
            }
        }

        #[test]
        fn what_is_clipped_is_in_the_frame(places in prop::collection::vec(prop::array::uniform2(-90.0..90.0), 3..9)) {
            let hull = hull(&places);
            let framed = framed(&hull, [40, 20], 5.0);
            for [x, y] in &framed {
                prop_assert!((-5.000_001..=45.000_001).contains(x) && (-5.000_001..=25.000_001).contains(y));
            }
            let inside = [20.0, 10.0];
            prop_assert!(!holds(&hull, inside) || !framed.is_empty());
        }
    }
}
