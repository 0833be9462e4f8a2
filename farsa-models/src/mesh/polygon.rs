//! Triangles of a polygon in space.

use crate::vector::{cross, dot, sub};

/// Most corners of a polygon with a reflex corner. The time to divide it grows with their square or more.
const MAX_CORNERS: usize = 500;

/// Divides a face with these corners into triangles. `None` if it has reflex corners and too many corners.
///
/// A polygon without a reflex corner is a fan, and a quadrilateral is divided along its shorter diagonal, as tinyobj does
/// for MuJoCo. Ears are clipped from others.
pub(crate) fn triangles(points: &[[f64; 3]], face: &[usize]) -> Option<Vec<[usize; 3]>> {
    let fan = |face: &[usize]| face[1..].windows(2).map(|two| [face[0], two[0], two[1]]).collect();
    if face.len() < 4 {
        return Some(if face.len() < 3 { Vec::new() } else { fan(face) });
    }
    let at = |i: usize| points[face[i % face.len()]];
    // Newell's normal, twice the area.
    let normal = (1..face.len() - 1).fold([0.0; 3], |sum, i| {
        let part = cross(sub(at(i), at(0)), sub(at(i + 1), at(0)));
        [0, 1, 2].map(|k| sum[k] + part[k])
    });
    let turn = |a: [f64; 3], b: [f64; 3], c: [f64; 3]| dot(normal, cross(sub(b, a), sub(c, b)));
    let reflex = (0..face.len()).any(|i| turn(at(i), at(i + 1), at(i + 2)) < 0.0);
    match face {
        &[a, b, c, d] if !reflex => {
            let length = |from, to| {
                let way = sub(points[to], points[from]);
                dot(way, way)
            };
            Some(if length(a, c) < length(b, d) { vec![[a, b, c], [a, c, d]] } else { vec![[a, b, d], [b, c, d]] })
        }
        _ if !reflex => Some(fan(face)),
        _ if face.len() > MAX_CORNERS => None,
        _ => Some(clipped(points, face, turn)),
    }
}

/// Clips ears until a triangle is left. `turn` is positive for three points that turn as the polygon does.
fn clipped(points: &[[f64; 3]], face: &[usize], turn: impl Fn([f64; 3], [f64; 3], [f64; 3]) -> f64) -> Vec<[usize; 3]> {
    let mut rest = face.to_vec();
    let mut ears = Vec::with_capacity(face.len());
    while rest.len() > 3 {
        let n = rest.len();
        let corners = |i: usize| [rest[(i + n - 1) % n], rest[i], rest[(i + 1) % n]];
        let is_ear = |i: &usize| {
            let [a, b, c] = corners(*i).map(|number| points[number]);
            let inside = |number: &&usize| {
                let p = points[**number];
                let corner = [a, b, c].contains(&p);
                !corner && turn(a, b, p) >= 0.0 && turn(b, c, p) >= 0.0 && turn(c, a, p) >= 0.0
            };
            turn(a, b, c) > 0.0 && !rest.iter().any(|number| inside(&number))
        };
        // A polygon that crosses itself may have no ear, and three corners on a line bound nothing.
        let flat = |i: &usize| {
            let [a, b, c] = corners(*i).map(|number| points[number]);
            turn(a, b, c) == 0.0
        };
        let ear = (0..n).find(is_ear).or_else(|| (0..n).find(flat)).unwrap_or(0);
        ears.push(corners(ear));
        rest.remove(ear);
    }
    ears.extend(<[usize; 3]>::try_from(rest).ok());
    ears
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::vector::norm;
    use proptest::prelude::*;

    /// The area of the triangles without their sign, and with the sign of the polygon.
    fn areas(points: &[[f64; 3]]) -> [f64; 2] {
        let face: Vec<usize> = (0..points.len()).collect();
        let triangles = triangles(points, &face).expect("few corners");
        assert_eq!(triangles.len(), points.len() - 2);
        let parts = triangles.iter().map(|corners| {
            let [a, b, c] = corners.map(|i| points[i]);
            cross(sub(b, a), sub(c, a)).map(|x| x / 2.0)
        });
        let (mut size, mut sum) = (0.0, [0.0; 3]);
        for part in parts {
            size += norm(&part);
            sum = [0, 1, 2].map(|k| sum[k] + part[k]);
        }
        [size, norm(&sum)]
    }

    proptest! {
        /// A star around the origin has reflex corners. Its area is the sum over its sectors.
        #[test]
        fn stars_are_covered_once(radii in prop::collection::vec(0.1..1.0_f64, 4..40), first in 0..40_usize) {
            let count = radii.len();
            let points: Vec<[f64; 3]> = (0..count).map(|i| (i + first) % count).map(|i| {
                let (s, c) = farsa_num::sin_cos(i as f64 / count as f64 * std::f64::consts::TAU);
                let [x, y] = [radii[i] * c, radii[i] * s];
                // In an oblique plane.
                [x, 0.6 * y, 0.8 * y]
            }).collect();
            let (s, _) = farsa_num::sin_cos(std::f64::consts::TAU / count as f64);
            let area: f64 = (0..count).map(|i| 0.5 * s * radii[i] * radii[(i + 1) % count]).sum();
            let [size, sum] = areas(&points);
            prop_assert!((size - area).abs() < 1e-12 && (sum - area).abs() < 1e-12, "{size} {sum} {area}");
        }
    }

    #[test]
    fn letters_and_darts_are_covered_once() {
        let flat = |outline: &[[f64; 2]]| outline.iter().map(|[x, y]| [*x, *y, 1.0]).collect::<Vec<_>>();
        let c = [[0.0, 0.0], [3.0, 0.0], [3.0, 1.0], [1.0, 1.0], [1.0, 2.0], [3.0, 2.0], [3.0, 3.0], [0.0, 3.0]];
        assert_eq!(areas(&flat(&c)), [7.0, 7.0]);
        for turn in 0..4 {
            let mut dart = [[0.0, 1.0], [-0.5, 0.0], [0.0, 0.25], [0.5, 0.0]];
            dart.rotate_left(turn);
            assert_eq!(areas(&flat(&dart)), [0.375, 0.375]);
        }
        let long = flat(&(0..501).map(|i| [f64::from(i), f64::from(i % 2)]).collect::<Vec<_>>());
        assert_eq!(triangles(&long, &(0..501).collect::<Vec<_>>()), None);
    }
}
