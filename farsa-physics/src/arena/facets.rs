//! Faces of the convex hull of points in space. No other file depends on parry.

use alloc::vec::Vec;

use farsa_num::{Scalar, sin_cos};
use parry3d::math::Vector;
use parry3d::transformation::try_convex_hull;

use crate::arena::outline::{LEAST, hull};
use crate::arena::solid::Face;

/// Points lie on a common face that are no farther from it, in parts of half the hull's breadth: what rounding makes of flat.
const FLAT: f64 = 1e-9;
/// Points are one that are no farther apart, in the same parts: `f32` has to distinguish them.
const SAME: f64 = 2e-4;

/// The tolerance of points beyond a face, in the same parts. parry leaves out corners that protrude less than a hundred
/// times `f32`'s rounding.
const BEYOND: f64 = 1e-4;
/// The tolerance for a narrow triangle, times its height.
const NARROW: f64 = 3e-6;
/// Directions that a hull is looked for from.
const MAX_TURNS: u8 = 8;

type Point = [f64; 3];

fn sub(a: Point, b: Point) -> Point {
    [a[0] - b[0], a[1] - b[1], a[2] - b[2]]
}

fn dot(a: Point, b: Point) -> f64 {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}

fn cross(a: Point, b: Point) -> Point {
    [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]]
}

fn unit(a: Point) -> Option<Point> {
    let length = Scalar::sqrt(dot(a, a));
    (length > 0.0).then(|| a.map(|x| x / length))
}

/// The fault of a hull.
pub(crate) enum Flaw {
    /// It is only so thick [m].
    Thin(f64),
    /// Its faces do not close.
    Open,
}

/// The face with one point on it by its corners' numbers, counter-clockwise seen from outside from the lowest number on.
fn corners(points: &[Point], numbers: &[usize], out: Point, first: usize) -> Vec<usize> {
    // Seen along the axis that is nearest to the normal. A bound that no common angle has: 1 / 2 is the sine of 30 degrees.
    let axis = [2, 0].into_iter().find(|k: &usize| out[*k].abs() >= 0.5337).unwrap_or(1);
    let flat = |point: &Point| [point[(axis + 1) % 3], point[(axis + 2) % 3]];
    let within = |i: &usize| dot(out, sub(points[*i], points[first])).abs() <= FLAT;
    let on: Vec<usize> = numbers.iter().copied().filter(within).collect();
    let outline = hull(&on.iter().map(|i| flat(&points[*i])).collect::<Vec<_>>());
    let number = |place: &[f64; 2]| on.iter().copied().find(|i| flat(&points[*i]) == *place);
    let mut corners: Vec<usize> = outline.iter().filter_map(number).collect();
    if out[axis] < 0.0 {
        corners.reverse();
    }
    let first = (0..corners.len()).min_by_key(|i| corners[*i]).unwrap_or(0);
    corners.rotate_left(first);
    corners
}

/// Returns the points scaled to [-1, 1] along the axes of their greatest breadths, in the same order. A hull has the
/// same faces in any affine frame, and this one is as far from flat as possible.
fn spread(points: &[Point]) -> Result<Vec<Point>, Flaw> {
    let first = points.first().copied().unwrap_or_default();
    let farthest = |off: &dyn Fn(Point) -> Point| {
        let off = points.iter().map(|point| off(sub(*point, first)));
        off.fold([0.0; 3], |most, new| if dot(new, new) > dot(most, most) { new } else { most })
    };
    let along = unit(farthest(&|way| way)).ok_or(Flaw::Thin(0.0))?;
    let aside = |way: Point| {
        let part = dot(way, along);
        [0, 1, 2].map(|k| way[k] - part * along[k])
    };
    let across = unit(farthest(&aside)).ok_or(Flaw::Thin(0.0))?;
    let axes = [along, across, cross(along, across)];
    let mut spread: Vec<Point> = points.iter().map(|point| axes.map(|axis| dot(axis, sub(*point, first)))).collect();
    for k in 0..3 {
        let [low, high] = range(spread.iter().map(|point| point[k]));
        if high - low < LEAST {
            return Err(Flaw::Thin(high - low));
        }
        for point in &mut spread {
            point[k] = (2.0 * point[k] - (low + high)) / (high - low);
        }
    }
    Ok(spread)
}

/// The lowest and the highest.
fn range(values: impl Iterator<Item = f64>) -> [f64; 2] {
    values.fold([f64::INFINITY, f64::NEG_INFINITY], |[low, high], x| [Scalar::min(low, x), Scalar::max(high, x)])
}

/// The faces of the convex hull of points in the obstacle's frame.
///
/// parry finds which points lie on a common face, in `f32`. The faces themselves are computed from those points here,
/// so that no number of parry's gets into the world.
pub(crate) fn faces(points: &[Point]) -> Result<Vec<Face>, Flaw> {
    let spread = spread(points)?;
    let mut numbers: Vec<usize> = Vec::with_capacity(points.len());
    for (i, point) in spread.iter().enumerate() {
        let same = |other: &usize| (0..3).all(|k| (point[k] - spread[*other][k]).abs() < SAME);
        if !numbers.iter().any(same) {
            numbers.push(i);
        }
    }
    // Once in some ten thousand sets with many points in a plane, parry's triangles close, but not around the points:
    // seen from in other places they do.
    let triangles = (0..MAX_TURNS).find_map(|turn| triangles(&spread, &numbers, turn)).ok_or(Flaw::Open)?;
    let mut polygons: Vec<Vec<usize>> = Vec::new();
    for [a, b, c] in triangles {
        // A sliver along an edge has no direction, and its neighbors bound the hull there.
        if let Some(out) = unit(cross(sub(spread[b], spread[a]), sub(spread[c], spread[a]))) {
            polygons.push(corners(&spread, &numbers, out, a));
        }
    }
    polygons.sort_unstable();
    polygons.dedup();
    Ok(polygons.iter().filter_map(|polygon| plane(points, polygon)).collect())
}

/// Returns the triangles of parry's hull of some of the rotated points, or `None` without any.
fn triangles(points: &[Point], numbers: &[usize], turn: u8) -> Option<Vec<[usize; 3]>> {
    let [(s, c), (t, d)] = [0.7, 0.4].map(|angle| sin_cos(angle * f64::from(turn)));
    let turned = |number: &usize| {
        let [x, y, z] = points[*number];
        let [x, y] = [x * c - y * s, x * s + y * c];
        Vector::from([x, y * d - z * t, y * t + z * d].map(|x| x as f32))
    };
    let narrow: Vec<Vector> = numbers.iter().map(turned).collect();
    let (vertices, triangles) = try_convex_hull(&narrow).ok()?;
    // Points that are no corners have been taken out.
    let number = |i: u32| {
        let vertex = vertices.get(i as usize)?;
        narrow.iter().position(|point| point == vertex).map(|at| numbers[at])
    };
    let triangles = triangles
        .into_iter()
        .map(|[a, b, c]| Some([number(a)?, number(b)?, number(c)?]))
        .collect::<Option<Vec<_>>>()?;
    let behind = |[a, b, c]: &[usize; 3]| {
        let [u, v, w] = [[*a, *b], [*b, *c], [*c, *a]].map(|[from, to]| sub(points[to], points[from]));
        let area = cross(u, v);
        let longest = Scalar::max(Scalar::max(dot(u, u), dot(v, v)), dot(w, w));
        // The direction of a triangle is less accurate the narrower it is.
        unit(area).is_none_or(|out| {
            let slack = BEYOND + NARROW * Scalar::sqrt(longest / dot(area, area));
            numbers.iter().all(|number| dot(out, sub(points[*number], points[*a])) <= slack)
        })
    };
    (closed(&triangles) && triangles.iter().all(behind)).then_some(triangles)
}

/// Returns whether every edge of triangles belongs to two of them, once in either direction.
fn closed(triangles: &[[usize; 3]]) -> bool {
    let mut edges: Vec<[usize; 2]> = triangles.iter().flat_map(|[a, b, c]| [[*a, *b], [*b, *c], [*c, *a]]).collect();
    edges.sort_unstable();
    let twice = edges.windows(2).any(|pair| pair[0] == pair[1]);
    edges.len() > 6 && !twice && edges.iter().all(|[a, b]| edges.binary_search(&[*b, *a]).is_ok())
}

/// The plane of a polygon, no point beyond it.
fn plane(points: &[Point], polygon: &[usize]) -> Option<Face> {
    let corner = |i: usize| polygon.get(i).map(|number| points[*number]);
    let first = corner(0)?;
    // The area as a vector: of all corners, whatever triangle they were found by.
    let mut area = [0.0; 3];
    for i in 1..polygon.len() {
        let part = cross(sub(corner(i)?, first), sub(corner((i + 1) % polygon.len())?, first));
        area = [area[0] + part[0], area[1] + part[1], area[2] + part[2]];
    }
    let out = unit(area)?;
    let [_, reach] = range(points.iter().map(|point| dot(out, *point)));
    Some(Face { out: out.map(|x| x as f32), reach: reach as f32 })
}
