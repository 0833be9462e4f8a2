//! Convex obstacles of a planar world, and discs and rays that hit them, for one world or lanes.
//!
//! In closed form over the sides, not by parry's iterations: those stop at a thousandth of the distance, and would have to
//! go lane by lane.

use alloc::vec::Vec;

use farsa_num::Scalar;

use crate::arena::outline::{LEAST, sides};
use crate::arena::surface::Meeting;

/// A side of an outline, in the obstacle's frame.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Side {
    /// Where it begins.
    from: [f32; 2],
    /// Unit vector along it, counter-clockwise about the obstacle. Outwards is to the right of it.
    along: [f32; 2],
    length: f32,
}

/// A face in the obstacle's frame, which is on the ground. Places with `out . place <= reach` are behind it.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Face {
    /// Unit vector outwards.
    pub(crate) out: [f32; 3],
    pub(crate) reach: f32,
}

/// A convex obstacle.
#[derive(Clone, Debug)]
pub(crate) struct Solid {
    /// The middle of the upright rectangle around it.
    pub(crate) centre: [f32; 2],
    /// Half the sides of that rectangle.
    pub(crate) around: [f32; 2],
    sides: Vec<Side>,
    faces: Vec<Face>,
    pub(crate) color: [f32; 3],
}

/// The middle of the upright rectangle around an outline, as the world has it, and half its sides [m].
pub(crate) fn middle(outline: &[[f64; 2]]) -> ([f64; 2], [f64; 2]) {
    let (mut low, mut high) = ([f64::INFINITY; 2], [f64::NEG_INFINITY; 2]);
    for corner in outline {
        for k in 0..2 {
            low[k] = low[k].min(corner[k]);
            high[k] = high[k].max(corner[k]);
        }
    }
    // Rounded first, so that the sides lie where they do whatever is lost here.
    let centre = [0, 1].map(|k| f64::from((0.5 * (low[k] + high[k])) as f32));
    (centre, [0, 1].map(|k| Scalar::max(high[k] - centre[k], centre[k] - low[k])))
}

/// The faces of an upright prism of a height over an outline in the obstacle's frame.
pub(crate) fn prism_faces(outline: &[[f64; 2]], height: f64) -> Vec<Face> {
    let upright = sides(outline).map(|[a, b]| {
        let [x, y] = [b[0] - a[0], b[1] - a[1]];
        let length = Scalar::sqrt(x * x + y * y);
        // To the right of a side that runs counter-clockwise is outwards.
        let [u, v] = [y / length, -x / length];
        Face { out: [u as f32, v as f32, 0.0], reach: (u * a[0] + v * a[1]) as f32 }
    });
    let ends = [Face { out: [0.0, 0.0, 1.0], reach: height as f32 }, Face { out: [0.0, 0.0, -1.0], reach: 0.0 }];
    upright.chain(ends).collect()
}

impl Solid {
    /// Builds a solid of an outline in the obstacle's frame, counter-clockwise.
    pub(crate) fn new(
        outline: &[[f64; 2]],
        centre: [f64; 2],
        around: [f64; 2],
        faces: Vec<Face>,
        color: [f64; 3],
    ) -> Self {
        let mut corners: Vec<[f64; 2]> = Vec::with_capacity(outline.len());
        for corner in outline {
            // Sides that are shorter than anything else have no direction in `f32`.
            let near = |other: &[f64; 2]| (0..2).all(|k| (corner[k] - other[k]).abs() < LEAST);
            if !corners.last().is_some_and(near) && !corners.first().is_some_and(near) {
                corners.push(*corner);
            }
        }
        let side = |[a, b]: [[f64; 2]; 2]| {
            let [x, y] = [b[0] - a[0], b[1] - a[1]];
            let length = Scalar::sqrt(x * x + y * y);
            Side { from: a.map(|x| x as f32), along: [(x / length) as f32, (y / length) as f32], length: length as f32 }
        };
        Self {
            centre: centre.map(|x| x as f32),
            around: around.map(|x| x as f32),
            sides: sides(&corners).map(side).collect(),
            faces,
            color: color.map(|x| x as f32),
        }
    }
}

/// The nearest point of an outline, in the obstacle's frame.
struct Nearest<S: Scalar> {
    place: [S; 2],
    point: [S; 2],
    /// Squared distance to it.
    square: S,
    within: S::Mask,
    /// The distance of the place beyond its farthest side, with the outward direction there. It counts within.
    gap: S,
    out: [S; 2],
}

#[inline(always)]
fn nearest<S: Scalar<Real = f32>>(solid: &Solid, [x, y]: [S; 2]) -> Nearest<S> {
    let place = [x - x.like(solid.centre[0]), y - x.like(solid.centre[1])];
    let zero = x.constant(0.0);
    let (mut point, mut square) = (place, x.like(f32::INFINITY));
    let (mut within, mut gap, mut out) = (zero.le(zero), x.like(f32::NEG_INFINITY), [zero; 2]);
    for side in &solid.sides {
        let [u, v] = [x.like(side.along[0]), x.like(side.along[1])];
        let from = [x.like(side.from[0]), x.like(side.from[1])];
        let [p, q] = [place[0] - from[0], place[1] - from[1]];
        // Outwards is (v, -u): positive beyond the line of the side. A place beyond none lies within.
        let beyond = p * v - q * u;
        within = within & beyond.le(zero);
        let farther = beyond.gt(gap);
        gap = S::select(farther, beyond, gap);
        out = [S::select(farther, v, out[0]), S::select(farther, -u, out[1])];
        // The nearest point of the side, not of its line.
        let along = (p * u + q * v).clamp(zero, x.like(side.length));
        let foot = [from[0] + along * u, from[1] + along * v];
        let [a, b] = [place[0] - foot[0], place[1] - foot[1]];
        let new = a * a + b * b;
        let nearer = new.lt(square);
        square = S::select(nearer, new, square);
        point = [S::select(nearer, foot[0], point[0]), S::select(nearer, foot[1], point[1])];
    }
    square = S::select(within, zero, square);
    point = [S::select(within, place[0], point[0]), S::select(within, place[1], point[1])];
    Nearest { place, point, square, within, gap, out }
}

/// Returns whether a place may be nearer to an obstacle than `reach` [m].
#[inline(always)]
pub(crate) fn is_near<S: Scalar<Real = f32>>(solid: &Solid, [x, y]: [S; 2], reach: S) -> S::Mask {
    // The rectangle around it first: most places are far from most obstacles.
    let [u, v] = [(x - x.like(solid.centre[0])).abs(), (y - x.like(solid.centre[1])).abs()];
    (u - x.like(solid.around[0])).lt(reach) & (v - x.like(solid.around[1])).lt(reach)
}

/// Returns whether a disc overlaps an obstacle.
#[inline(always)]
pub(crate) fn overlaps_solid<S: Scalar<Real = f32>>(solid: &Solid, at: [S; 2], radius: S) -> S::Mask {
    is_near(solid, at, radius) & nearest(solid, at).square.lt(radius * radius)
}

/// The vector from a place to the nearest point of an obstacle [m], zero within.
#[inline(always)]
pub(crate) fn to_solid<S: Scalar<Real = f32>>(solid: &Solid, at: [S; 2]) -> [S; 2] {
    let Nearest { place, point, .. } = nearest(solid, at);
    [point[0] - place[0], point[1] - place[1]]
}

/// Returns the overlap of a disc with an obstacle.
#[inline(always)]
pub(crate) fn meets_solid<S: Scalar<Real = f32>>(solid: &Solid, at: [S; 2], radius: S) -> Meeting<S> {
    let Nearest { place, point, square, within, gap, out } = nearest(solid, at);
    let distance = square.sqrt();
    let outside = !within & distance.gt(radius.constant(0.0));
    let divisor = S::select(outside, distance, radius.constant(1.0));
    let [x, y] = [place[0] - point[0], place[1] - point[1]];
    // From within, out by the nearest side.
    let out = [S::select(outside, x / divisor, out[0]), S::select(outside, y / divisor, out[1])];
    // Within, `gap` is negative: the way back to the nearest side comes on top of the radius.
    let depth = radius - S::select(outside, distance, gap);
    let point = [radius.like(solid.centre[0]) + point[0], radius.like(solid.centre[1]) + point[1]];
    Meeting { depth, out, point }
}

/// Returns the distance and the face at which a ray enters the half spaces behind all faces, or `None` if it begins
/// within or misses. The ray is given by its distance beyond each face, and the growth of that distance.
#[inline(always)]
fn enters(faces: impl Iterator<Item = [f32; 2]>) -> Option<(f32, usize)> {
    let (mut enter, mut leave, mut face) = (f32::NEG_INFINITY, f32::INFINITY, 0);
    // It crosses a face where beyond + t growth = 0: inwards where growth is negative, else outwards. It is within
    // between the last crossing inwards and the first outwards [Ericson2005] section 5.3.8.
    for (i, [beyond, growth]) in faces.enumerate() {
        if growth < 0.0 {
            let here = -beyond / growth;
            if here > enter {
                (enter, face) = (here, i);
            }
        } else if growth > 0.0 {
            leave = Scalar::min(-beyond / growth, leave);
        // Along this face and outside of it.
        } else if beyond > 0.0 {
            return None;
        }
    }
    (enter >= 0.0 && enter <= leave).then_some((enter, face))
}

/// Where a ray in the plane enters an obstacle [m], or `None` if it begins within or misses.
pub(crate) fn ray_to_solid(solid: &Solid, from: [f32; 2], direction: [f32; 2]) -> Option<f32> {
    let [x, y] = [from[0] - solid.centre[0], from[1] - solid.centre[1]];
    let [u, v] = direction;
    let side = |side: &Side| {
        let [p, q] = [x - side.from[0], y - side.from[1]];
        [p * side.along[1] - q * side.along[0], u * side.along[1] - v * side.along[0]]
    };
    enters(solid.sides.iter().map(side)).map(|(distance, _)| distance)
}

/// Where a ray in space enters an obstacle: distance and outward normal, or `None` if it begins within or misses.
pub(crate) fn cast_to_solid(solid: &Solid, from: [f32; 3], direction: [f32; 3]) -> Option<(f32, [f32; 3])> {
    let [x, y, z] = [from[0] - solid.centre[0], from[1] - solid.centre[1], from[2]];
    let [u, v, w] = direction;
    let face = |face: &Face| {
        let [a, b, c] = face.out;
        [(a * x + b * y + c * z) - face.reach, a * u + b * v + c * w]
    };
    let (distance, index) = enters(solid.faces.iter().map(face))?;
    solid.faces.get(index).map(|face| (distance, face.out))
}
