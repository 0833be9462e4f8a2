//! Contact of two boxes: separating axes, then one face clipped by another, or a pair of edges.

use farsa_num::{Mask, Scalar};

use crate::articulated::collision::{PlacedShape, Point, ball_box, corner, nearest_of_segments, sign_of};
use crate::articulated::model::POINT_WORDS;
use crate::articulated::spatial::{Vector, add, cross, dot, scale, select, sub};

/// Contact points of two boxes: both ends of the four edges of a face within another, the corners of the other face
/// within the first, and the nearest pair of edges or a corner.
pub(crate) const BOX_POINTS: usize = 13;
/// Points of two faces.
const FACE_POINTS: usize = 12;

/// The overlap [m] by which one axis must be better than another that is preferred. Also the distance beyond a face up
/// to which corners count as above it.
///
/// Rounding then changes neither the axis nor the number of points of boxes at rest.
const TIE: f64 = 1e-5;

/// The distance [m] over which a new point takes the impulse of an old one.
const HANDED: f64 = 1e-3;

/// Squared sine of the smallest angle between two edges that have a common normal.
const SKEW: f64 = 1e-6;

/// A box with the axes as vectors.
#[derive(Clone, Copy)]
struct Cuboid<S> {
    center: Vector<S>,
    axes: [Vector<S>; 3],
    half: Vector<S>,
}

impl<S: Scalar> Cuboid<S> {
    #[inline(always)]
    fn new(place: &PlacedShape<S>, half: Vector<S>) -> Self {
        let [x, y, z] = place.rotation;
        let axes = [[x[0], y[0], z[0]], [x[1], y[1], z[1]], [x[2], y[2], z[2]]];
        Self { center: place.position, axes, half }
    }

    #[inline(always)]
    fn select(mask: S::Mask, a: &Self, b: &Self) -> Self {
        Self {
            center: select(mask, a.center, b.center),
            axes: core::array::from_fn(|k| select(mask, a.axes[k], b.axes[k])),
            half: select(mask, a.half, b.half),
        }
    }

    /// The face across one of the axes, on the side of `direction`.
    #[inline(always)]
    fn face(&self, along: &[S::Mask; 3], direction: Vector<S>) -> Face<S> {
        let [x, y, z] = self.axes;
        let [a, b, c] = self.half;
        let axis = pick_vector(along, [x, y, z]);
        let side = sign_of(dot(axis, direction));
        let normal = scale(axis, side);
        Face {
            center: add(self.center, scale(normal, pick(along, [a, b, c]))),
            normal,
            across: [pick_vector(along, [y, z, x]), pick_vector(along, [z, x, y])],
            half: [pick(along, [b, c, a]), pick(along, [c, a, b])],
        }
    }

    /// The middle of the edge along one of the axes that is farthest in `direction`, its direction and half length.
    #[inline(always)]
    fn edge(&self, along: &[S::Mask; 3], direction: Vector<S>) -> (Vector<S>, Vector<S>, S) {
        let mut middle = self.center;
        for k in 0..3 {
            let reach = sign_of(dot(self.axes[k], direction)) * self.half[k];
            middle = add(middle, scale(self.axes[k], S::select(along[k], reach.constant(0.0), reach)));
        }
        (middle, pick_vector(along, self.axes), pick(along, self.half))
    }
}

/// A face of a box: outward normal, and the axes and half lengths of its sides.
#[derive(Clone, Copy)]
struct Face<S> {
    center: Vector<S>,
    normal: Vector<S>,
    across: [Vector<S>; 2],
    half: [S; 2],
}

#[inline(always)]
fn pick<S: Scalar>(which: &[S::Mask; 3], x: [S; 3]) -> S {
    S::select(which[0], x[0], S::select(which[1], x[1], x[2]))
}

#[inline(always)]
fn pick_vector<S: Scalar>(which: &[S::Mask; 3], x: [Vector<S>; 3]) -> Vector<S> {
    select(which[0], x[0], select(which[1], x[1], x[2]))
}

/// Which of three is largest, the first one of equal ones.
#[inline(always)]
fn largest<S: Scalar>(x: [S; 3]) -> [S::Mask; 3] {
    let first = x[0].ge(x[1]) & x[0].ge(x[2]);
    let second = !first & x[1].ge(x[2]);
    [first, second, !first & !second]
}

/// The best axis of one kind: the distance along it, negative where the boxes overlap, and the axes that it belongs to.
struct Separation<S: Scalar> {
    distance: S,
    /// An axis of the first box and one of the second. Faces use the one of `second_face`.
    axes: [[S::Mask; 3]; 2],
    second_face: S::Mask,
    /// Unit normal toward the first box, for edges.
    normal: Vector<S>,
}

/// The cosines between the axes of two boxes, their absolute values, and the center of the second box as seen from the
/// first one.
struct Relation<S> {
    cosines: [[S; 3]; 3],
    sizes: [[S; 3]; 3],
    offset: Vector<S>,
}

impl<S: Scalar> Relation<S> {
    #[inline(always)]
    fn new(a: &Cuboid<S>, b: &Cuboid<S>) -> Self {
        let cosines = a.axes.map(|x| b.axes.map(|y| dot(x, y)));
        Self { cosines, sizes: cosines.map(|row| row.map(Scalar::abs)), offset: sub(b.center, a.center) }
    }

    /// The face normal along which the boxes are farthest apart or overlap least [Ericson2005] section 4.4.1.
    #[inline(always)]
    fn faces(&self, a: &Cuboid<S>, b: &Cuboid<S>) -> Separation<S> {
        let c = &self.sizes;
        let first: [S; 3] =
            core::array::from_fn(|i| dot(self.offset, a.axes[i]).abs() - (a.half[i] + dot(c[i], b.half)));
        let second: [S; 3] = core::array::from_fn(|j| {
            dot(self.offset, b.axes[j]).abs() - (b.half[j] + dot([c[0][j], c[1][j], c[2][j]], a.half))
        });
        let axes = [largest(first), largest(second)];
        let [of_first, of_second] = [pick(&axes[0], first), pick(&axes[1], second)];
        let second_face = of_second.gt(of_first + of_first.constant(TIE));
        Separation { distance: S::select(second_face, of_second, of_first), axes, second_face, normal: self.offset }
    }

    /// The common normal of two edges along which the boxes are farthest apart or overlap least.
    #[inline(always)]
    fn edges(&self, a: &Cuboid<S>, b: &Cuboid<S>) -> Separation<S> {
        let zero = self.offset[0].constant(0.0);
        let one = self.offset[0].constant(1.0);
        let no = zero.lt(zero);
        let seen = a.axes.map(|axis| dot(axis, self.offset));
        let mut best = Separation {
            distance: zero.constant(f64::NEG_INFINITY),
            axes: [[no; 3]; 2],
            second_face: no,
            normal: [zero, zero, one],
        };
        let (c, sizes) = (&self.cosines, &self.sizes);
        for i in 0..3 {
            let (i1, i2) = ((i + 1) % 3, (i + 2) % 3);
            for j in 0..3 {
                let (j1, j2) = ((j + 1) % 3, (j + 2) % 3);
                // a_i x b_j has the components -c_i2j and c_i1j along a_i1 and a_i2, so its length does not cancel.
                let squared = c[i1][j] * c[i1][j] + c[i2][j] * c[i2][j];
                let skew = squared.gt(zero.constant(SKEW));
                let inverse = one / S::select(skew, squared, one).sqrt();
                let along = seen[i2] * c[i1][j] - seen[i1] * c[i2][j];
                let reach = (a.half[i1] * sizes[i2][j] + a.half[i2] * sizes[i1][j])
                    + (b.half[j1] * sizes[i][j2] + b.half[j2] * sizes[i][j1]);
                let distance = (along.abs() - reach) * inverse;
                let better = skew & distance.gt(best.distance);
                best.distance = S::select(better, distance, best.distance);
                // The offset leads from the first box to the second, the normal back.
                let normal = scale(cross(a.axes[i], b.axes[j]), -(sign_of(along) * inverse));
                best.normal = select(better, normal, best.normal);
                for k in 0..3 {
                    best.axes[0][k] = keep(better, k == i, best.axes[0][k]);
                    best.axes[1][k] = keep(better, k == j, best.axes[1][k]);
                }
            }
        }
        best
    }
}

/// `new` where `better`, else `old`.
#[inline(always)]
fn keep<M: Mask>(better: M, new: bool, old: M) -> M {
    if new { better | old } else { !better & old }
}

/// The part of `from` + t `step`, 0 <= t <= 1, that is between -`half` and `half`. Empty where it ends before it begins.
#[inline(always)]
fn span<S: Scalar>(from: S, step: S, half: S) -> [S; 2] {
    let zero = from.constant(0.0);
    let one = from.constant(1.0);
    let still = step.abs().le(from.constant(1e-12));
    let outside = from.abs().gt(half);
    let inverse = one / S::select(still, one, step);
    let (t1, t2) = ((-half - from) * inverse, (half - from) * inverse);
    let (low, high) = (t1.min(t2).max(zero), t1.max(t2).min(one));
    [S::select(still, zero, low), S::select(still, S::select(outside, -one, one), high)]
}

/// Clips one face by the prism over another one.
///
/// A point keeps its number while the two faces are the same, so that its impulse starts the next step.
struct Clip<S: Scalar> {
    base: Face<S>,
    /// Half sides of the base.
    sides: [S; 2],
    /// Center and half sides of the clipped face along the sides and the normal of the base.
    middle: Vector<S>,
    halves: [Vector<S>; 2],
    /// Unit normal toward the first box.
    normal: Vector<S>,
}

impl<S: Scalar> Clip<S> {
    /// Prepares the face `other` against the face `base`, which is one of the second box where `second`.
    #[inline(always)]
    fn new(base: Face<S>, other: &Face<S>, second: S::Mask) -> Self {
        let seen = |x: Vector<S>| [dot(x, base.across[0]), dot(x, base.across[1]), dot(x, base.normal)];
        let tie = base.half[0].constant(TIE);
        let halves = [0, 1].map(|k: usize| seen(scale(other.across[k], other.half[k])));
        let back = scale(base.normal, -tie.constant(1.0));
        Self {
            sides: [base.half[0] + tie, base.half[1] + tie],
            middle: seen(sub(other.center, base.center)),
            halves,
            normal: select(second, base.normal, back),
            base,
        }
    }

    /// The contact point between the base and the clipped face at `at`.
    #[inline(always)]
    fn point(&self, at: Vector<S>, valid: S::Mask) -> Point<S> {
        let [x, y, gap] = at;
        let [u, v] = self.base.across;
        let height = scale(self.base.normal, gap * gap.constant(0.5));
        let position = add(add(self.base.center, height), add(scale(u, x), scale(v, y)));
        Point { gap, normal: self.normal, position, valid }
    }

    /// Both ends of edge `index` of the clipped face. The last one counts where it is not also the first one of the next
    /// edge.
    #[inline(always)]
    fn ends(&self, index: usize) -> [Point<S>; 2] {
        let [e, f] = self.halves;
        let corner = match index {
            0 => add(add(self.middle, e), f),
            1 => add(sub(self.middle, e), f),
            2 => sub(sub(self.middle, e), f),
            _ => sub(add(self.middle, e), f),
        };
        let side = if index.is_multiple_of(2) { e } else { f };
        let step = scale(side, side[0].constant(if index < 2 { -2.0 } else { 2.0 }));
        let [x, y] = [0, 1].map(|k: usize| span(corner[k], step[k], self.sides[k]));
        let (first, last) = (x[0].max(y[0]), x[1].min(y[1]));
        let within = first.le(last);
        let at = |t: S| add(corner, scale(step, t));
        [self.point(at(first), within), self.point(at(last), within & last.lt(last.constant(1.0)))]
    }

    /// Corner `index` of the base, where it is below the clipped face.
    #[inline(always)]
    fn base_corner(&self, index: usize) -> Point<S> {
        let [e, f] = self.halves;
        let one = e[0].constant(1.0);
        let [x, y] = self.sides;
        let q = [if index & 1 == 0 { -x } else { x }, if index & 2 == 0 { -y } else { y }];
        // q = middle + alpha e + beta f in the plane of the base. The faces oppose each other within 55 degrees, so the
        // determinant is at least 0.57 of the area.
        let inverse = one / (e[0] * f[1] - e[1] * f[0]);
        let (r0, r1) = (q[0] - self.middle[0], q[1] - self.middle[1]);
        let alpha = (r0 * f[1] - r1 * f[0]) * inverse;
        let beta = (e[0] * r1 - e[1] * r0) * inverse;
        let below = alpha.abs().lt(one) & beta.abs().lt(one);
        self.point([q[0], q[1], self.middle[2] + (alpha * e[2] + beta * f[2])], below)
    }
}

/// The nearest corner of one box to the other, for boxes that are apart.
#[inline(always)]
fn nearest_corner<S: Scalar>(places: [&PlacedShape<S>; 2], halves: [Vector<S>; 2]) -> Point<S> {
    let zero = halves[0][0].constant(0.0);
    let mut best = ball_box(corner(places[0], halves[0], 0), zero, places[1], halves[1]);
    for index in 1..16 {
        let (own, other) = if index < 8 { (0, 1) } else { (1, 0) };
        let mut point = ball_box(corner(places[own], halves[own], index % 8), zero, places[other], halves[other]);
        if own == 1 {
            point.normal = scale(point.normal, -zero.constant(1.0));
        }
        let nearer = point.gap.lt(best.gap);
        best = Point { valid: best.valid, ..choose(nearer, &point, &best) };
    }
    best
}

#[inline(always)]
fn choose<S: Scalar>(mask: S::Mask, a: &Point<S>, b: &Point<S>) -> Point<S> {
    Point {
        gap: S::select(mask, a.gap, b.gap),
        normal: select(mask, a.normal, b.normal),
        position: select(mask, a.position, b.position),
        valid: (mask & a.valid) | (!mask & b.valid),
    }
}

/// Finds the contact points of two boxes. Returns the distance of the boxes, or 0 where they overlap.
#[inline(never)]
pub(crate) fn find_boxes<S: Scalar>(
    simd: S::Simd,
    places: [&PlacedShape<S>; 2],
    halves: [[S::Real; 3]; 2],
    out: &mut [Point<S>; BOX_POINTS],
) -> S {
    S::vectorize(
        simd,
        #[inline(always)]
        || manifold(places, halves.map(|half| half.map(|x| S::splat(simd, x))), out),
    )
}

/// Moves the impulses of points that no longer exist to new points near them, in their words [`POINT_WORDS`].
///
/// A corner that crosses the border of a face becomes the end of another edge. Without its impulse the boxes would jerk.
#[inline(always)]
pub(crate) fn hand_over<S: Scalar>(points: &[Point<S>; BOX_POINTS], words: &mut [S]) {
    let zero = points[0].gap.constant(0.0);
    let limit = zero.constant(HANDED * HANDED);
    for from in 0..BOX_POINTS {
        let old: [S; POINT_WORDS] = core::array::from_fn(|k| words[POINT_WORDS * from + k]);
        let mut gone = old[3].gt(zero) & !points[from].valid;
        if !gone.any() {
            continue;
        }
        for (to, point) in points.iter().enumerate() {
            let new = &mut words[POINT_WORDS * to..POINT_WORDS * to + 4];
            let moved = sub(point.position, [old[4], old[5], old[6]]);
            let takes = gone & point.valid & new[3].le(zero) & dot(moved, moved).lt(limit);
            for (new, old) in new.iter_mut().zip(old) {
                *new = S::select(takes, old, *new);
            }
            gone = gone & !takes;
        }
    }
}

#[inline(always)]
fn manifold<S: Scalar>(places: [&PlacedShape<S>; 2], halves: [Vector<S>; 2], out: &mut [Point<S>; BOX_POINTS]) -> S {
    let (a, b) = (Cuboid::new(places[0], halves[0]), Cuboid::new(places[1], halves[1]));
    let relation = Relation::new(&a, &b);
    let (faces, edges) = (relation.faces(&a, &b), relation.edges(&a, &b));
    let zero = faces.distance.constant(0.0);
    let tie = zero.constant(TIE);
    let by_edges = edges.distance.gt(faces.distance + tie);
    let apart = faces.distance.max(edges.distance).gt(zero);
    // The face along the best axis, and the one of the other box that opposes it most.
    let second = faces.second_face;
    let own = Cuboid::select(second, &b, &a);
    let other = Cuboid::select(second, &a, &b);
    let along: [S::Mask; 3] = core::array::from_fn(|k| (second & faces.axes[1][k]) | (!second & faces.axes[0][k]));
    let base = own.face(&along, sub(other.center, own.center));
    let opposing = largest(other.axes.map(|axis| dot(axis, base.normal).abs()));
    let clip = Clip::new(base, &other.face(&opposing, scale(base.normal, -zero.constant(1.0))), second);
    for index in 0..4 {
        let [first, last] = clip.ends(index);
        out[2 * index] = first;
        out[2 * index + 1] = last;
        out[8 + index] = clip.base_corner(index);
    }
    let mut nearest = zero.constant(f64::INFINITY);
    for point in &mut out[..FACE_POINTS] {
        point.valid = point.valid & !by_edges;
        nearest = S::select(point.valid, nearest.min(point.gap), nearest);
    }
    // Two edges. Apart, the nearest points of the boxes are on them where the line between them is along the normal.
    let minus = scale(edges.normal, -zero.constant(1.0));
    let (middle, direction, length) = a.edge(&edges.axes[0], minus);
    let (other_middle, other_direction, other_length) = b.edge(&edges.axes[1], edges.normal);
    let (on_a, on_b) = nearest_of_segments(middle, direction, length, other_middle, other_direction, other_length);
    let between = sub(on_a, on_b);
    let across = sub(between, scale(edges.normal, dot(between, edges.normal)));
    let crossing = !apart | dot(across, across).le(tie * tie);
    let mut single = Point {
        gap: edges.distance,
        normal: edges.normal,
        position: scale(add(on_a, on_b), zero.constant(0.5)),
        valid: by_edges & crossing,
    };
    nearest = S::select(single.valid, nearest.min(single.gap), nearest);
    if apart.any() {
        let point = nearest_corner(places, halves);
        let nearer = apart & (point.gap + tie).lt(nearest);
        nearest = S::select(nearer, point.gap, nearest);
        single = choose(nearer, &point, &single);
    }
    out[FACE_POINTS] = single;
    S::select(apart, nearest, zero)
}
