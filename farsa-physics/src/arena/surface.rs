//! Nearest points and overlaps of discs with walls and with each other, for one world or lanes of them.

use farsa_num::Scalar;

use crate::arena::slab::Slab;

/// A disc that overlaps something: how deep [m], the unit vector out of it, and the point of its surface [m].
#[derive(Clone, Copy)]
pub(crate) struct Meeting<S> {
    pub(crate) depth: S,
    pub(crate) out: [S; 2],
    pub(crate) point: [S; 2],
}

/// A place in a wall's frame, and its nearest point of the wall there.
#[inline(always)]
fn within<S: Scalar<Real = f32>>(slab: &Slab, [x, y]: [S; 2]) -> ([S; 2], [S; 2]) {
    let [c, s] = [x.like(slab.axis[0]), x.like(slab.axis[1])];
    let [u, v] = [x - x.like(slab.centre[0]), y - x.like(slab.centre[1])];
    let place = [u * c + v * s, v * c - u * s];
    let [a, b] = [x.like(slab.half[0]), x.like(slab.half[1])];
    (place, [place[0].clamp(-a, a), place[1].clamp(-b, b)])
}

/// A vector of a wall's frame in the world's.
#[inline(always)]
fn out_of<S: Scalar<Real = f32>>(slab: &Slab, [u, v]: [S; 2]) -> [S; 2] {
    let [c, s] = [u.like(slab.axis[0]), u.like(slab.axis[1])];
    [u * c - v * s, u * s + v * c]
}

/// Squared distance from a place to a wall [m2], 0 within.
#[inline(always)]
pub(crate) fn wall_squared<S: Scalar<Real = f32>>(slab: &Slab, at: [S; 2]) -> S {
    let ([u, v], [a, b]) = within(slab, at);
    let [u, v] = [u - a, v - b];
    u * u + v * v
}

/// The vector from a place to the nearest point of a wall [m], zero within.
#[inline(always)]
pub(crate) fn to_wall<S: Scalar<Real = f32>>(slab: &Slab, at: [S; 2]) -> [S; 2] {
    let ([u, v], [a, b]) = within(slab, at);
    out_of(slab, [a - u, b - v])
}

/// Returns the overlap of a disc with a wall.
#[inline(always)]
pub(crate) fn meets_wall<S: Scalar<Real = f32>>(slab: &Slab, at: [S; 2], radius: S) -> Meeting<S> {
    // In the wall's frame (u, v) is the center, (a, b) its nearest point of the wall. Their difference is the way out,
    // and zero for a center within.
    let zero = radius.constant(0.0);
    let one = radius.constant(1.0);
    let ([u, v], [a, b]) = within(slab, at);
    let [x, y] = [u - a, v - b];
    let distance = (x * x + y * y).sqrt();
    let outside = distance.gt(zero);
    let divisor = S::select(outside, distance, one);
    // From within, out by the nearest side.
    let sign = |z: S| S::select(z.lt(zero), -one, one);
    let overlap = [radius.like(slab.half[0]) - u.abs(), radius.like(slab.half[1]) - v.abs()];
    let along = overlap[0].lt(overlap[1]);
    let [p, q] = [S::select(along, sign(u), zero), S::select(along, zero, sign(v))];
    let out = [S::select(outside, x / divisor, p), S::select(outside, y / divisor, q)];
    let depth = radius - S::select(outside, distance, -overlap[0].min(overlap[1]));
    let [w, h] = out_of(slab, [a, b]);
    let point = [radius.like(slab.centre[0]) + w, radius.like(slab.centre[1]) + h];
    Meeting { depth, out: out_of(slab, out), point }
}

/// Returns the overlap of a disc with another disc.
#[inline(always)]
pub(crate) fn meets_disc<S: Scalar<Real = f32>>(at: [S; 2], other: [S; 2], radius: S, other_radius: S) -> Meeting<S> {
    // Along the line of centers. Along x for two at one place, which have none.
    let [x, y] = [at[0] - other[0], at[1] - other[1]];
    let distance = (x * x + y * y).sqrt();
    let apart = distance.gt(radius.constant(0.0));
    let divisor = S::select(apart, distance, radius.constant(1.0));
    let out =
        [S::select(apart, x / divisor, radius.constant(1.0)), S::select(apart, y / divisor, radius.constant(0.0))];
    let point = [other[0] + out[0] * other_radius, other[1] + out[1] * other_radius];
    Meeting { depth: (radius + other_radius) - distance, out, point }
}

/// Where a ray of unit direction enters a disc around the origin [m], or `None` if it begins within or misses.
pub(crate) fn ray_to_disc(from: [f32; 2], direction: [f32; 2], radius: f32) -> Option<f32> {
    // From the difference of the squares, because their roots would lose a small disc at a distance.
    let along = from[0] * direction[0] + from[1] * direction[1];
    let across = from[0] * direction[1] - from[1] * direction[0];
    let outside = from[0] * from[0] + from[1] * from[1] - radius * radius;
    let under = (radius - across) * (radius + across);
    // NaN hits nothing.
    if !(outside >= 0.0 && along <= 0.0 && under >= 0.0) {
        return None;
    }
    Some((-along - Scalar::sqrt(under)).max(0.0))
}

/// Where a ray enters a wall [m], or `None` if it begins within or misses.
#[inline]
pub(crate) fn ray_to_wall(slab: &Slab, from: [f32; 2], direction: [f32; 2]) -> Option<f32> {
    // Slabs: the ray is within the wall where it is between both pairs of sides, from the last entry to the first exit
    // [Ericson2005] section 5.3.3.
    let ([u, v], _) = within(slab, from);
    let [c, s] = slab.axis;
    let way = [direction[0] * c + direction[1] * s, direction[1] * c - direction[0] * s];
    let (mut enter, mut leave) = (f32::NEG_INFINITY, f32::INFINITY);
    for (x, (way, half)) in [u, v].into_iter().zip(way.into_iter().zip(slab.half)) {
        if way == 0.0 {
            if x.abs() > half {
                return None;
            }
            continue;
        }
        let [near, far] = if way > 0.0 { [-half - x, half - x] } else { [half - x, -half - x] };
        enter = Scalar::max(near / way, enter);
        leave = Scalar::min(far / way, leave);
    }
    (enter >= 0.0 && enter <= leave).then_some(enter)
}
