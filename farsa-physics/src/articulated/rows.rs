//! Rows: what unit forces and moments at a contact do to the articulated bodies.
//!
//! [`accelerations`](crate::articulated::tree::accelerations) has already factorized the inverse of the joint-space
//! inertia, `M^-1 = B B^T`. The row `y = B^T J^T` of a unit force has entries only along the path from its link to the
//! root. It gives every product: `J M^-1 J^T = y^T y`. The response `z` is the sum of `y` times impulse over all
//! points, and the change of a point's velocity is `y^T z`. Own derivation.

use farsa_num::{Mask, Real, Scalar};

use crate::articulated::link::{LinkData, Motion, WORLD};
use crate::articulated::model::{Model, Pair};
use crate::articulated::spatial::{Spatial, Vector, sub};
use crate::articulated::tree::Root;

/// Two unit vectors across a unit normal, without a branch [Duff2017].
#[inline(always)]
pub(crate) fn tangents<S: Scalar>(n: Vector<S>) -> [Vector<S>; 2] {
    // The sign of n_z keeps the divisor, sign + n_z, away from zero.
    let one = n[0].constant(1.0);
    let sign = S::select(n[2].lt(n[0].constant(0.0)), -one, one);
    let a = -(one / (sign + n[2]));
    let b = n[0] * n[1] * a;
    [[one + sign * n[0] * n[0] * a, sign * b, -(sign * n[0])], [b, sign + n[1] * n[1] * a, -n[1]]]
}

/// Predicted velocity of a collider's point.
#[inline(always)]
pub(crate) fn velocity_at<S: Scalar>(simd: S::Simd, link: u16, work: &[LinkData<S>], point: Vector<S>) -> Vector<S> {
    if link == WORLD {
        return [S::splat(simd, S::Real::from_f64(0.0)); 3];
    }
    let w = &work[usize::from(link)];
    w.acceleration.at(sub(point, w.reference))
}

/// Velocity of a collider's point before the step.
#[inline(always)]
pub(crate) fn velocity_before<S: Scalar>(
    simd: S::Simd,
    link: u16,
    work: &[LinkData<S>],
    point: Vector<S>,
) -> Vector<S> {
    if link == WORLD {
        return [S::splat(simd, S::Real::from_f64(0.0)); 3];
    }
    let w = &work[usize::from(link)];
    w.velocity.at(sub(point, w.reference))
}

/// Predicted angular velocity of a link.
#[inline(always)]
pub(crate) fn spin<S: Scalar>(simd: S::Simd, link: u16, work: &[LinkData<S>]) -> Vector<S> {
    if link == WORLD {
        [S::splat(simd, S::Real::from_f64(0.0)); 3]
    } else {
        work[usize::from(link)].acceleration.angular
    }
}

/// Three unit forces on the links of a path.
type Pull<S> = [Spatial<S>; 3];

/// Carries three forces over one link towards its root: writes the row entries and returns how many.
#[inline(always)]
fn climb<S: Scalar>(
    model: &Model<S::Real>,
    link: u16,
    work: &[LinkData<S>],
    roots: &[Root<S>],
    inverse_sqrt_inertia: &[S],
    p: &mut Pull<S>,
    out: &mut [[S; 3]],
) -> usize {
    let l = &model.links[usize::from(link)];
    if l.motion == Motion::Floating {
        for k in 0..3 {
            let y = roots[usize::from(l.root)].factor.half(p[k]);
            for (o, y) in out.iter_mut().zip(&y) {
                o[k] = *y;
            }
        }
        return 6;
    }
    // The inward pass of the articulated bodies for a force alone: the joint takes s . p, as y = s . p / sqrt(D) in the
    // row, and passes p - U (s . p) / D on.
    let w = &work[usize::from(link)];
    let root = inverse_sqrt_inertia[usize::from(l.dof)];
    for k in 0..3 {
        let y = w.subspace.dot(p[k]);
        out[0][k] = y * root;
        p[k] = p[k] - w.column.scale(y * w.reciprocal);
    }
    1
}

/// Which unit loads the rows of a block are.
#[derive(Clone, Copy)]
pub(crate) enum Load<S> {
    /// Forces along the axes at a point.
    Forces(Vector<S>),
    /// Moments about the axes.
    Moments,
}

/// The block's unit loads on the link of one of the pair's colliders.
#[inline(always)]
fn pull<S: Scalar>(
    simd: S::Simd,
    model: &Model<S::Real>,
    collider: usize,
    work: &[LinkData<S>],
    load: Load<S>,
    axes: &[Vector<S>; 3],
) -> Pull<S> {
    let zero = Spatial::zero(simd);
    let link = model.colliders[collider].mount.link;
    if link == WORLD {
        return [zero; 3];
    }
    match load {
        Load::Moments => [
            Spatial { angular: axes[0], linear: zero.linear },
            Spatial { angular: axes[1], linear: zero.linear },
            Spatial { angular: axes[2], linear: zero.linear },
        ],
        Load::Forces(point) => {
            let arm = sub(point, work[usize::from(link)].reference);
            [Spatial::force_at(arm, axes[0]), Spatial::force_at(arm, axes[1]), Spatial::force_at(arm, axes[2])]
        }
    }
}

/// Writes the rows of three unit forces (or moments) on both sides of a pair, and their response.
#[inline(never)]
pub(crate) fn write_rows<S: Scalar>(
    simd: S::Simd,
    model: &Model<S::Real>,
    pair: &Pair<S::Real>,
    work: &[LinkData<S>],
    roots: &[Root<S>],
    inverse_sqrt_inertia: &[S],
    load: Load<S>,
    axes: &[Vector<S>; 3],
    rows: &mut [[S; 3]],
) -> [S; 6] {
    S::vectorize(
        simd,
        #[inline(always)]
        || write(simd, model, pair, work, roots, inverse_sqrt_inertia, load, axes, rows),
    )
}

#[inline(always)]
fn write<S: Scalar>(
    simd: S::Simd,
    model: &Model<S::Real>,
    pair: &Pair<S::Real>,
    work: &[LinkData<S>],
    roots: &[Root<S>],
    inverse_sqrt_inertia: &[S],
    load: Load<S>,
    axes: &[Vector<S>; 3],
    rows: &mut [[S; 3]],
) -> [S; 6] {
    // Equal and opposite loads climb from both links. Where the two paths join, the loads are added and continue as
    // one, so that velocities common to both sides get one entry.
    let reach = &pair.reach;
    let minus = S::splat(simd, S::Real::from_f64(-1.0));
    let first_entries = reach.dofs.len() - reach.second.iter().map(|l| entries(model, *l)).sum::<usize>();
    let other = pull(simd, model, pair.colliders[1], work, load, axes);
    let mut other = [other[0].scale(minus), other[1].scale(minus), other[2].scale(minus)];
    let mut at = first_entries;
    for &link in &reach.second {
        at += climb(model, link, work, roots, inverse_sqrt_inertia, &mut other, &mut rows[at..]);
    }
    let mut p = pull(simd, model, pair.colliders[0], work, load, axes);
    let mut at = 0;
    for (i, &link) in reach.first.iter().enumerate() {
        if i == reach.meet {
            for k in 0..3 {
                p[k] += other[k];
            }
        }
        at += climb(model, link, work, roots, inverse_sqrt_inertia, &mut p, &mut rows[at..]);
    }
    // The block of J M^-1 J^T: nn, 11, 22, n1, n2, 12.
    let mut a = [S::splat(simd, S::Real::from_f64(0.0)); 6];
    for y in rows.iter() {
        a[0] += y[0] * y[0];
        a[1] += y[1] * y[1];
        a[2] += y[2] * y[2];
        a[3] += y[0] * y[1];
        a[4] += y[0] * y[2];
        a[5] += y[1] * y[2];
    }
    a
}

fn entries<R: Real>(model: &Model<R>, link: u16) -> usize {
    if model.links[usize::from(link)].motion == Motion::Floating { 6 } else { 1 }
}

/// Returns whether two numbers are equal, false with a NaN.
#[inline(always)]
pub(crate) fn equal<S: Scalar>(a: S, b: S) -> S::Mask {
    a.le(b) & b.le(a)
}

/// The relative velocity of a block under the response so far.
#[inline(always)]
pub(crate) fn velocity<S: Scalar>(dofs: &[u16], rows: &[[S; 3]], mut v: [S; 3], response: &[S]) -> [S; 3] {
    // v + y^T z: the velocity without impulses, and what all impulses so far add.
    for (&d, y) in dofs.iter().zip(rows) {
        let z = response[usize::from(d)];
        v[0] += y[0] * z;
        v[1] += y[1] * z;
        v[2] += y[2] * z;
    }
    v
}

/// Adds a block's change of impulse to the response, in the lanes that have any.
///
/// A change of zero would leave the response unchanged (it is never -0). Most blocks of a batch are loaded in some
/// lanes only, and many in none.
#[inline(always)]
pub(crate) fn apply<S: Scalar>(dofs: &[u16], rows: &[[S; 3]], change: [S; 3], mask: S::Mask, response: &mut [S]) {
    // z += y dl contains the effect on all other points.
    let zero = change[0].constant(0.0);
    let none = equal(change[0], zero) & equal(change[1], zero) & equal(change[2], zero);
    let mask = mask & !none;
    if !mask.any() {
        return;
    }
    for (&d, y) in dofs.iter().zip(rows) {
        let z = &mut response[usize::from(d)];
        *z = S::select(mask, *z + (y[0] * change[0] + y[1] * change[1] + y[2] * change[2]), *z);
    }
}
