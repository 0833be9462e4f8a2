//! Where two convex shapes touch: gap, normal and point, for one world or one per lane.

use farsa_num::{Mask, Real, Scalar};

use crate::articulated::spatial::{Matrix, Vector, add, dot, rotate, rotate_back, scale, select, sub};

/// One possible contact point of a pair.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Point<S: Scalar> {
    /// Distance left between the surfaces, negative when they overlap [m].
    pub(crate) gap: S,
    /// Unit normal that pushes the first shape away from the second.
    pub(crate) normal: Vector<S>,
    /// Midway between the surfaces [m].
    pub(crate) position: Vector<S>,
    /// True for a point that counts.
    pub(crate) valid: S::Mask,
}

/// A shape in the world, for one step.
#[derive(Clone, Copy, Debug)]
pub(crate) struct PlacedShape<S> {
    pub(crate) rotation: Matrix<S>,
    pub(crate) position: Vector<S>,
    /// Predicted velocity of the position.
    pub(crate) velocity: Vector<S>,
}

impl<S: Scalar> Point<S> {
    pub(crate) fn new(simd: S::Simd) -> Self {
        let o = S::splat(simd, S::Real::from_f64(0.0));
        Self { gap: o, normal: [o; 3], position: [o; 3], valid: o.lt(o) }
    }
}

impl<S: Scalar> PlacedShape<S> {
    pub(crate) fn new(simd: S::Simd) -> Self {
        let o = S::splat(simd, S::Real::from_f64(0.0));
        Self { rotation: [[o; 3]; 3], position: [o; 3], velocity: [o; 3] }
    }
    #[inline(always)]
    pub(crate) fn axis(&self) -> Vector<S> {
        [self.rotation[0][2], self.rotation[1][2], self.rotation[2][2]]
    }
}

/// Below this distance two centers count as one [m]. The normal is then up.
const COINCIDENT: f64 = 1e-9;

/// Two balls about `a` and `b`. A radius of zero is a point.
#[inline(always)]
pub(crate) fn balls<S: Scalar>(a: Vector<S>, ra: S, b: Vector<S>, rb: S) -> Point<S> {
    // Lanes divide even where the quotient is unused, so 1 replaces an invalid divisor.
    let d = sub(a, b);
    let length = dot(d, d).sqrt();
    let apart = length.gt(length.constant(COINCIDENT));
    let one = length.constant(1.0);
    let zero = length.constant(0.0);
    let normal = select(apart, scale(d, one / S::select(apart, length, one)), [zero, zero, one]);
    let gap = length - ra - rb;
    let point = add(b, scale(normal, rb + gap * gap.constant(0.5)));
    Point { gap, normal, position: point, valid: zero.le(zero) }
}

/// The point of the segment `centre` +- `half` * `axis` nearest to `p`.
#[inline(always)]
pub(crate) fn nearest_on_segment<S: Scalar>(centre: Vector<S>, axis: Vector<S>, half: S, p: Vector<S>) -> Vector<S> {
    let t = dot(sub(p, centre), axis).clamp(-half, half);
    add(centre, scale(axis, t))
}

/// The nearest points of two segments `c` +- `h` * `d` [Ericson2005] section 5.1.9, without division by a vanishing determinant.
#[inline(always)]
pub(crate) fn nearest_of_segments<S: Scalar>(
    c1: Vector<S>,
    d1: Vector<S>,
    h1: S,
    c2: Vector<S>,
    d2: Vector<S>,
    h2: S,
) -> (Vector<S>, Vector<S>) {
    // Minimise |c1 + s d1 - c2 - t d2|^2: s = (b f - c) / (1 - b^2) on the lines, clamped. Then t for that s, clamped.
    // Then s again for that t, which is exact where t was clamped and changes nothing where it was not. Parallel ones
    // begin at s = 0.
    let r = sub(c1, c2);
    let b = dot(d1, d2);
    let c = dot(d1, r);
    let f = dot(d2, r);
    let one = b.constant(1.0);
    let determinant = one - b * b;
    let skew = determinant.gt(b.constant(1e-6));
    let s = S::select(skew, (b * f - c) / S::select(skew, determinant, one), b.constant(0.0)).clamp(-h1, h1);
    let t = (b * s + f).clamp(-h2, h2);
    let s = (b * t - c).clamp(-h1, h1);
    (add(c1, scale(d1, s)), add(c2, scale(d2, t)))
}

/// -1 below 0, else 1.
#[inline(always)]
pub(crate) fn sign_of<S: Scalar>(x: S) -> S {
    let one = x.constant(1.0);
    S::select(x.lt(x.constant(0.0)), -one, one)
}

/// Signed distance of a point to a box and the outward normal, both in the box's axes.
#[inline(always)]
fn box_distance<S: Scalar>(p: Vector<S>, half: Vector<S>) -> (S, Vector<S>) {
    // By symmetry in the octant of positive coordinates: q = |p| - half, outside the length of its positive part max(q,
    // 0), inside the largest component of q, which is negative.
    let zero = p[0].constant(0.0);
    let one = p[0].constant(1.0);
    let sign = [sign_of(p[0]), sign_of(p[1]), sign_of(p[2])];
    let q = sub([p[0].abs(), p[1].abs(), p[2].abs()], half);
    let out = [q[0].max(zero), q[1].max(zero), q[2].max(zero)];
    let squared = dot(out, out);
    let outside = squared.gt(zero);
    let length = S::select(outside, squared, one).sqrt();
    // Inside, the nearest face. Ties to x, then y.
    let x_face = q[0].ge(q[1]) & q[0].ge(q[2]);
    let y_face = !x_face & q[1].ge(q[2]);
    let z_face = !x_face & !y_face;
    let inner = [S::select(x_face, sign[0], zero), S::select(y_face, sign[1], zero), S::select(z_face, sign[2], zero)];
    let outer = [sign[0] * (out[0] / length), sign[1] * (out[1] / length), sign[2] * (out[2] / length)];
    let depth = q[0].max(q[1]).max(q[2]);
    (S::select(outside, length, depth), select(outside, outer, inner))
}

/// A ball about `p` against a box.
#[inline(always)]
pub(crate) fn ball_box<S: Scalar>(p: Vector<S>, radius: S, place: &PlacedShape<S>, half: Vector<S>) -> Point<S> {
    let local = rotate_back(&place.rotation, sub(p, place.position));
    let (distance, normal) = box_distance(local, half);
    let normal = rotate(&place.rotation, normal);
    let gap = distance - radius;
    let zero = gap.constant(0.0);
    let point = sub(p, scale(normal, radius + gap * gap.constant(0.5)));
    Point { gap, normal, position: point, valid: zero.le(zero) }
}

/// Halvings in the search along a segment: the place is found to a four-thousandth of its length.
const HALVINGS: usize = 12;

/// Returns the ball of `radius` on the segment `centre` +- `half_length` * `axis` that is deepest in a box. It must be
/// deeper than at both ends, so that the segment crosses an edge, otherwise `valid` is false.
#[inline(always)]
pub(crate) fn segment_box<S: Scalar>(
    centre: Vector<S>,
    axis: Vector<S>,
    half_length: S,
    radius: S,
    place: &PlacedShape<S>,
    half: Vector<S>,
) -> Point<S> {
    // In the box's axes the segment is c + t d. The slope of the distance along it is the outward normal times d.
    let c = rotate_back(&place.rotation, sub(centre, place.position));
    let d = rotate_back(&place.rotation, axis);
    let (first, at_first) = box_distance(sub(c, scale(d, half_length)), half);
    let (last, at_last) = box_distance(add(c, scale(d, half_length)), half);
    let zero = radius.constant(0.0);
    let one_half = radius.constant(0.5);
    // Deepest between the ends only where the distance falls at the first and rises at the last.
    let between = dot(at_first, d).lt(zero) & dot(at_last, d).gt(zero);
    if !between.any() {
        return Point { gap: first.min(last) - radius, normal: at_first, position: centre, valid: between };
    }
    let (mut low, mut high) = (-half_length, half_length);
    // The distance to a convex body is convex along a line: its slope changes sign once.
    for _ in 0..HALVINGS {
        let t = (low + high) * one_half;
        let (_, normal) = box_distance(add(c, scale(d, t)), half);
        let rising = dot(normal, d).gt(zero);
        high = S::select(rising, t, high);
        low = S::select(rising, low, t);
    }
    let t = (low + high) * one_half;
    let mut point = ball_box(add(centre, scale(axis, t)), radius, place, half);
    point.gap = S::select(between, point.gap, first.min(last) - radius);
    // Deeper than the ends by more than the search's own error, or it is one of them.
    let error = half_length * half_length.constant(1e-3);
    point.valid = between & (point.gap + radius + error).lt(first.min(last));
    point
}

/// A ball about `p` against the half space below a plane.
#[inline(always)]
pub(crate) fn ball_plane<S: Scalar>(p: Vector<S>, radius: S, plane: &PlacedShape<S>) -> Point<S> {
    let normal = plane.axis();
    let gap = dot(sub(p, plane.position), normal) - radius;
    let zero = gap.constant(0.0);
    let point = sub(p, scale(normal, radius + gap * gap.constant(0.5)));
    Point { gap, normal, position: point, valid: zero.le(zero) }
}

/// Corner `index` (0..8) of a box in the world.
#[inline(always)]
pub(crate) fn corner<S: Scalar>(place: &PlacedShape<S>, half: Vector<S>, index: usize) -> Vector<S> {
    let mut at = half;
    for k in 0..3 {
        if index >> k & 1 == 0 {
            at[k] = -half[k];
        }
    }
    add(place.position, rotate(&place.rotation, at))
}

/// Distance from a point to a box [m], for the bounding test.
#[inline(always)]
pub(crate) fn distance_to_box<S: Scalar>(p: Vector<S>, place: &PlacedShape<S>, half: Vector<S>) -> S {
    box_distance(rotate_back(&place.rotation, sub(p, place.position)), half).0
}
