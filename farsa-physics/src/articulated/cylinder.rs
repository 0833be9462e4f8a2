//! Cylinders against balls, segments and planes.

use farsa_num::{Mask as _, Scalar};

use crate::articulated::collision::{PlacedShape, Point, sign_of};
use crate::articulated::spatial::{Vector, add, cross, dot, rotate, rotate_back, scale, select, sub};

/// Radius and half the length of a cylinder.
#[derive(Clone, Copy)]
pub(crate) struct Cylinder<S> {
    pub(crate) radius: S,
    pub(crate) half_length: S,
}

impl<S: Scalar> Cylinder<S> {
    #[inline(always)]
    pub(crate) fn new(simd: S::Simd, radius: S::Real, half_length: S::Real) -> Self {
        Self { radius: S::splat(simd, radius), half_length: S::splat(simd, half_length) }
    }
}

/// Distance from the axis below which a point counts as on it [m], and tilt below which a cylinder counts as upright.
const ON_AXIS: f64 = 1e-9;
const UPRIGHT: f64 = 1e-5;

/// Signed distance of a point to a cylinder and the outward normal, both in the cylinder's axes.
#[inline(always)]
fn distance<S: Scalar>(p: Vector<S>, cylinder: Cylinder<S>) -> (S, Vector<S>) {
    // In the half plane through the axis, as for a box: outside the length of the positive part of q, inside its largest
    // component. A point on the axis is pushed along x.
    let (zero, one) = (p[0].constant(0.0), p[0].constant(1.0));
    let across = (p[0] * p[0] + p[1] * p[1]).sqrt();
    let off = across.gt(zero.constant(ON_AXIS));
    let reciprocal = one / S::select(off, across, one);
    let radial = [S::select(off, p[0] * reciprocal, one), S::select(off, p[1] * reciprocal, zero)];
    let q = [across - cylinder.radius, p[2].abs() - cylinder.half_length];
    let (side, end) = (q[0].max(zero), q[1].max(zero));
    let squared = side * side + end * end;
    let outside = squared.gt(zero);
    let length = S::select(outside, squared, one).sqrt();
    let nearer = q[0].ge(q[1]);
    let out = S::select(outside, side / length, S::select(nearer, one, zero));
    let up = S::select(outside, end / length, S::select(nearer, zero, one));
    let normal = [radial[0] * out, radial[1] * out, sign_of(p[2]) * up];
    (S::select(outside, length, q[0].max(q[1])), normal)
}

/// A ball about `p` against a cylinder.
#[inline(always)]
pub(crate) fn ball_cylinder<S: Scalar>(
    p: Vector<S>,
    radius: S,
    place: &PlacedShape<S>,
    cylinder: Cylinder<S>,
) -> Point<S> {
    let (distance, normal) = distance(rotate_back(&place.rotation, sub(p, place.position)), cylinder);
    let normal = rotate(&place.rotation, normal);
    let gap = distance - radius;
    let zero = gap.constant(0.0);
    let position = sub(p, scale(normal, radius + gap * gap.constant(0.5)));
    Point { gap, normal, position, valid: zero.le(zero) }
}

/// Halvings in the search along a segment: the place is found to a four-thousandth of its length.
const HALVINGS: usize = 12;

/// Returns the ball of `radius` on the segment `centre` +- `half_length` * `axis` that is deepest in a cylinder. It must be
/// deeper than at both ends, otherwise `valid` is false.
#[inline(always)]
pub(crate) fn segment_cylinder<S: Scalar>(
    centre: Vector<S>,
    axis: Vector<S>,
    half_length: S,
    radius: S,
    place: &PlacedShape<S>,
    cylinder: Cylinder<S>,
) -> Point<S> {
    let c = rotate_back(&place.rotation, sub(centre, place.position));
    let d = rotate_back(&place.rotation, axis);
    let (first, at_first) = distance(sub(c, scale(d, half_length)), cylinder);
    let (last, at_last) = distance(add(c, scale(d, half_length)), cylinder);
    let (zero, one_half) = (radius.constant(0.0), radius.constant(0.5));
    let between = dot(at_first, d).lt(zero) & dot(at_last, d).gt(zero);
    if !between.any() {
        return Point { gap: first.min(last) - radius, normal: at_first, position: centre, valid: between };
    }
    let (mut low, mut high) = (-half_length, half_length);
    // The distance to a convex body is convex along a line: its slope changes sign once.
    for _ in 0..HALVINGS {
        let t = (low + high) * one_half;
        let rising = dot(distance(add(c, scale(d, t)), cylinder).1, d).gt(zero);
        high = S::select(rising, t, high);
        low = S::select(rising, low, t);
    }
    let t = (low + high) * one_half;
    let mut point = ball_cylinder(add(centre, scale(axis, t)), radius, place, cylinder);
    point.gap = S::select(between, point.gap, first.min(last) - radius);
    // Deeper than the ends by more than the search's own error, or it is one of them.
    let error = half_length * half_length.constant(1e-3);
    point.valid = between & (point.gap + radius + error).lt(first.min(last));
    point
}

/// Returns one of four points on the rims that support a cylinder on a plane, as MuJoCo's: the lowest of each end, and two
/// more on the lower end, a third of a turn to both sides.
#[inline(always)]
pub(crate) fn rim<S: Scalar>(
    place: &PlacedShape<S>,
    cylinder: Cylinder<S>,
    plane: &PlacedShape<S>,
    index: usize,
) -> Vector<S> {
    let (up, axis) = (plane.axis(), place.axis());
    let one = up[0].constant(1.0);
    let along = dot(up, axis);
    let down = sub(scale(axis, along), up);
    let length = dot(down, down).sqrt();
    let tilted = length.gt(one.constant(UPRIGHT));
    let across = [place.rotation[0][0], place.rotation[1][0], place.rotation[2][0]];
    let lowest = select(tilted, scale(down, one / S::select(tilted, length, one)), across);
    let lower = -sign_of(along);
    let (end, direction) = match index {
        0 => (-one, lowest),
        1 => (one, lowest),
        _ => {
            let sine = one.constant(if index == 2 { 0.866_025_403_784_438_6 } else { -0.866_025_403_784_438_6 });
            let aside = scale(cross(axis, lowest), sine);
            (lower, sub(aside, scale(lowest, one.constant(0.5))))
        }
    };
    let rim = add(scale(axis, end * cylinder.half_length), scale(direction, cylinder.radius));
    add(place.position, rim)
}
