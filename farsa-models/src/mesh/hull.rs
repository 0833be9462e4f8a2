//! Convex hulls of points. No other file depends on parry.

/// Returns the triangles of the hull of points, by their numbers, or the reason for its absence.
#[cfg(not(feature = "parry"))]
pub(crate) fn hull(_: &[[f64; 3]]) -> Result<Vec<[usize; 3]>, &'static str> {
    Err("its mass needs a convex hull, which the feature `parry` of farsa-models computes")
}

#[cfg(feature = "parry")]
pub(crate) use with_parry::hull;

#[cfg(feature = "parry")]
mod with_parry {
    use std::collections::BTreeMap;

    use farsa_num::sin_cos;
    use parry3d_f64::math::Vector;
    use parry3d_f64::transformation::try_convex_hull;

    use crate::vector::{cross, dot, norm, sub};

    /// A set of points is flat if it is thinner, as a part of its length.
    const THIN: f64 = 1e-9;
    /// Greatest height of a point above a face, in parts of half the breadth.
    const ABOVE: f64 = 1e-9;
    /// Directions that a hull is looked for from.
    const MAX_TURNS: u8 = 8;
    const FLAT: &str = "its points are in a plane, which has no convex hull";

    /// Returns the triangles of the hull of points, by their numbers, or the reason for its absence.
    pub(crate) fn hull(points: &[[f64; 3]]) -> Result<Vec<[usize; 3]>, &'static str> {
        let spread = spread(points).ok_or(FLAT)?;
        // The first of equal points.
        let mut numbers: BTreeMap<[u64; 3], usize> = BTreeMap::new();
        for (i, point) in spread.iter().enumerate() {
            numbers.entry(point.map(|x| (x + 0.0).to_bits())).or_insert(i);
        }
        let mut numbers: Vec<usize> = numbers.into_values().collect();
        numbers.sort_unstable();
        let hull = (0..MAX_TURNS).find_map(|turn| seen_from(&spread, &numbers, turn));
        hull.ok_or("its convex hull was not found")
    }

    /// Returns the points scaled to [-1, 1] along the axes of their greatest breadths, or `None` if they are flat. A hull
    /// has the same faces in any affine frame, and this one is as far from flat as possible.
    fn spread(points: &[[f64; 3]]) -> Option<Vec<[f64; 3]>> {
        let first = points.first().copied()?;
        let farthest = |off: &dyn Fn([f64; 3]) -> [f64; 3]| {
            let off = points.iter().map(|point| off(sub(*point, first)));
            off.fold([0.0; 3], |most, new| if dot(new, new) > dot(most, most) { new } else { most })
        };
        let unit = |way: [f64; 3]| Some(norm(&way)).filter(|n| *n > 0.0).map(|n| way.map(|x| x / n));
        let along = unit(farthest(&|way| way))?;
        let across = unit(farthest(&|way| {
            let part = dot(way, along);
            [0, 1, 2].map(|k| way[k] - part * along[k])
        }))?;
        let axes = [along, across, cross(along, across)];
        let mut spread: Vec<[f64; 3]> =
            points.iter().map(|point| axes.map(|axis| dot(axis, sub(*point, first)))).collect();
        let mut length = 0.0_f64;
        for k in 0..3 {
            let (low, high) = spread.iter().fold((0.0_f64, 0.0_f64), |(low, high), p| (low.min(p[k]), high.max(p[k])));
            length = length.max(high - low);
            if high - low <= THIN * length {
                return None;
            }
            for point in &mut spread {
                point[k] = (2.0 * point[k] - (low + high)) / (high - low);
            }
        }
        Some(spread)
    }

    /// Returns the triangles of parry's hull of the rotated points if they close around all of them.
    fn seen_from(points: &[[f64; 3]], numbers: &[usize], turn: u8) -> Option<Vec<[usize; 3]>> {
        let [(s, c), (t, d)] = [0.7, 0.4].map(|angle| sin_cos(angle * f64::from(turn)));
        let turned = |number: &usize| {
            let [x, y, z] = points[*number];
            let [x, y] = [x * c - y * s, x * s + y * c];
            [x, y * d - z * t, y * t + z * d]
        };
        let turned: Vec<[f64; 3]> = numbers.iter().map(turned).collect();
        let key = |point: [f64; 3]| point.map(f64::to_bits);
        let names: BTreeMap<_, usize> =
            turned.iter().zip(numbers).map(|(point, number)| (key(*point), *number)).collect();
        let vectors: Vec<Vector> = turned.iter().map(|point| Vector::from(*point)).collect();
        let (corners, faces) = try_convex_hull(&vectors).ok()?;
        let number = |i: u32| names.get(&key(corners.get(i as usize)?.to_array())).copied();
        let faces = faces.into_iter().map(|[a, b, c]| Some([number(a)?, number(b)?, number(c)?]));
        let faces: Vec<[usize; 3]> = faces.collect::<Option<_>>()?;
        let behind = |face: &[usize; 3]| {
            let [a, b, c] = face.map(|i| points[i]);
            let out = cross(sub(b, a), sub(c, a));
            // A sliver has no direction, and its neighbors bound the hull there.
            norm(&out) < ABOVE || faces.iter().flatten().all(|i| dot(out, sub(points[*i], a)) <= ABOVE)
        };
        (closed(&faces) && faces.iter().all(behind)).then_some(faces)
    }

    /// Checks that every edge of triangles belongs to two of them, once in either direction.
    fn closed(triangles: &[[usize; 3]]) -> bool {
        let mut edges: Vec<[usize; 2]> =
            triangles.iter().flat_map(|[a, b, c]| [[*a, *b], [*b, *c], [*c, *a]]).collect();
        edges.sort_unstable();
        let twice = edges.windows(2).any(|pair| pair[0] == pair[1]);
        edges.len() > 6 && !twice && edges.iter().all(|[a, b]| edges.binary_search(&[*b, *a]).is_ok())
    }
}
