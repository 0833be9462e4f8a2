//! Friction on the ground below bodies that slide in a plane: rows next to the contacts'.
//!
//! The ground carries a body's weight, and no joint moves the body along that weight. So friction is limited by a
//! constant load. As in a contact it is the impulse that leaves the body at rest, or one of the limit's size against
//! the motion where that is smaller. A step ends with the ground's rows, so a held body stays at rest under any push
//! below the limit.

use farsa_num::{Mask, Real, Scalar};

use crate::articulated::link::LinkData;
use crate::articulated::model::{Ground, Model};
use crate::articulated::spatial::Spatial;

/// The rows of one ground: two of the sliding joints, and one of the turn.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Rubbing<S: Scalar> {
    /// In which lanes the body moves or is touched.
    pub(crate) mask: S::Mask,
    /// In which lanes it was left at rest, and does not turn.
    held: S::Mask,
    held_turning: S::Mask,
    /// Predicted speeds of the sliding joints and of the turn.
    velocity: [S; 3],
    impulse: [S; 3],
    /// The rows' entries: of the first joint its own. The second has its own, then the first's. The turn has its own,
    /// then the second's and the first's.
    first: S,
    second: [S; 2],
    turn: [S; 3],
    /// `J M^-1 J^T` of the two: 11, 22, 12, and the reciprocal of its determinant.
    response: [S; 4],
    /// The reciprocal of a bound of its largest eigenvalue, and of the turn's own response.
    slide: S,
    turning: S,
}

impl<S: Scalar> Rubbing<S> {
    pub(crate) fn new(simd: S::Simd) -> Self {
        let o = S::splat(simd, S::Real::from_f64(0.0));
        let none = o.lt(o);
        Self {
            mask: none,
            held: none,
            held_turning: none,
            velocity: [o; 3],
            impulse: [o; 3],
            first: o,
            second: [o; 2],
            turn: [o; 3],
            response: [o; 4],
            slide: o,
            turning: o,
        }
    }
}

/// Sets up the rows of bodies that move under their predicted velocities `v`, or that something touches according to
/// `touched`. Returns the lanes that have any.
#[inline(never)]
pub(crate) fn set_up_grounds<S: Scalar>(
    simd: S::Simd,
    model: &Model<S::Real>,
    v: &[S],
    work: &[LinkData<S>],
    inverse_sqrt_inertia: &[S],
    touched: &[S::Mask],
    rubbing: &mut [Rubbing<S>],
) -> S::Mask {
    S::vectorize(
        simd,
        #[inline(always)]
        || set_up(simd, model, v, work, inverse_sqrt_inertia, touched, rubbing),
    )
}

#[inline(always)]
fn set_up<S: Scalar>(
    simd: S::Simd,
    model: &Model<S::Real>,
    v: &[S],
    work: &[LinkData<S>],
    inverse_sqrt_inertia: &[S],
    touched: &[S::Mask],
    rubbing: &mut [Rubbing<S>],
) -> S::Mask {
    let zero = S::splat(simd, S::Real::from_f64(0.0));
    let one = S::splat(simd, S::Real::from_f64(1.0));
    let mut any = zero.lt(zero);
    for ((ground, touched), rubbing) in model.grounds.iter().zip(touched).zip(rubbing) {
        let dof = |link: u16| usize::from(model.links[usize::from(link)].dof);
        let [one_at, other_at] = [dof(ground.sliders[0]), dof(ground.sliders[1])];
        let turn_at = match ground.turn {
            Some(turn) => dof(turn),
            None => other_at,
        };
        let turning = if ground.turn.is_some() { v[turn_at] } else { zero };
        let velocity = [v[one_at], v[other_at], turning];
        let speed = velocity[0].abs() + velocity[1].abs() + velocity[2].abs();
        let mask = *touched | speed.gt(zero);
        rubbing.mask = mask;
        if !mask.any() {
            continue;
        }
        any = any | mask;
        // The row of a unit effort at a joint, as for a stop: 1 / sqrt(D) for itself, and -U / D climbs on to the root.
        let [first, second] = [&work[usize::from(ground.sliders[0])], &work[usize::from(ground.sliders[1])]];
        let minus = -one;
        let diagonal = inverse_sqrt_inertia[one_at];
        let on_first = |p: Spatial<S>| first.subspace.dot(p) * diagonal;
        let climbing = second.column.scale(minus * second.reciprocal);
        let row = [inverse_sqrt_inertia[other_at], on_first(climbing)];
        if let Some(turn) = ground.turn {
            let w = &work[usize::from(turn)];
            let p = w.column.scale(minus * w.reciprocal);
            let s = second.subspace.dot(p);
            let above = p - second.column.scale(s * second.reciprocal);
            rubbing.turn = [inverse_sqrt_inertia[turn_at], s * inverse_sqrt_inertia[other_at], on_first(above)];
            let [a, b, c] = rubbing.turn;
            rubbing.turning = one / (a * a + b * b + c * c);
        }
        let (a1, a2, a12) = (diagonal * diagonal, row[0] * row[0] + row[1] * row[1], diagonal * row[1]);
        rubbing.first = diagonal;
        rubbing.second = row;
        rubbing.response = [a1, a2, a12, one / (a1 * a2 - a12 * a12)];
        rubbing.slide = one / (a1.max(a2) + a12.abs());
        rubbing.velocity = velocity;
        rubbing.impulse = [zero; 3];
    }
    any
}

/// Brings the impulses of one ground to their law in the lanes of `running`, given all others, for this share of a
/// dynamics step. Returns by how much the body's speeds change [m/s or rad/s].
#[inline(always)]
pub(crate) fn relax_ground<S: Scalar>(
    simd: S::Simd,
    model: &Model<S::Real>,
    ground: &Ground<S::Real>,
    share: S,
    running: S::Mask,
    rubbing: &mut Rubbing<S>,
    response: &mut [S],
) -> S {
    let zero = S::splat(simd, S::Real::from_f64(0.0));
    let mask = rubbing.mask & running;
    if !mask.any() {
        return zero;
    }
    let dof = |link: u16| usize::from(model.links[usize::from(link)].dof);
    let [one_at, other_at] = [dof(ground.sliders[0]), dof(ground.sliders[1])];
    let one = S::splat(simd, S::Real::from_f64(1.0));
    let old = rubbing.impulse;
    let (y, [y1, y0]) = (rubbing.first, rubbing.second);
    let v0 = rubbing.velocity[0] + y * response[one_at];
    let v1 = rubbing.velocity[1] + (y1 * response[other_at] + y0 * response[one_at]);
    // At rest after the step where that takes no more than the limit. Else against the motion, alike in all directions.
    let [a1, a2, a12, determinant] = rubbing.response;
    let rest = [old[0] - (a2 * v0 - a12 * v1) * determinant, old[1] - (a1 * v1 - a12 * v0) * determinant];
    let slide = [old[0] - v0 * rubbing.slide, old[1] - v1 * rubbing.slide];
    let limit = S::splat(simd, ground.limit) * share;
    let held = (rest[0] * rest[0] + rest[1] * rest[1]).le(limit * limit);
    let length = (slide[0] * slide[0] + slide[1] * slide[1]).sqrt();
    let over = length.gt(limit);
    let shrink = S::select(over, limit / S::select(over, length, one), one);
    rubbing.held = (held & mask) | (rubbing.held & !mask);
    let mut new = old;
    for k in 0..2 {
        new[k] = S::select(mask, S::select(held, rest[k], slide[k] * shrink), old[k]);
    }
    let [d0, d1] = [new[0] - old[0], new[1] - old[1]];
    let mut change = (d0.abs() * a1).max(d1.abs() * a2);
    response[one_at] = S::select(mask, response[one_at] + (y * d0 + y0 * d1), response[one_at]);
    response[other_at] = S::select(mask, response[other_at] + y1 * d1, response[other_at]);
    if let Some(turn) = ground.turn {
        let turn_at = dof(turn);
        let [t2, t1, t0] = rubbing.turn;
        let w = rubbing.velocity[2] + (t2 * response[turn_at] + t1 * response[other_at] + t0 * response[one_at]);
        let limit = S::splat(simd, ground.turning_limit) * share;
        let rest = old[2] - w * rubbing.turning;
        rubbing.held_turning = (rest.abs().le(limit) & mask) | (rubbing.held_turning & !mask);
        new[2] = S::select(mask, rest.clamp(-limit, limit), old[2]);
        let d = new[2] - old[2];
        change = change.max(d.abs() / rubbing.turning);
        for (at, row) in [(turn_at, t2), (other_at, t1), (one_at, t0)] {
            response[at] = S::select(mask, response[at] + row * d, response[at]);
        }
    }
    rubbing.impulse = new;
    change
}

/// Leaves bodies that are held exactly at rest, where rounding would let them creep.
#[inline(always)]
pub(crate) fn hold<S: Scalar>(simd: S::Simd, model: &Model<S::Real>, rubbing: &[Rubbing<S>], v: &mut [S]) {
    let zero = S::splat(simd, S::Real::from_f64(0.0));
    let dof = |link: u16| usize::from(model.links[usize::from(link)].dof);
    for (ground, rubbing) in model.grounds.iter().zip(rubbing) {
        if !rubbing.mask.any() {
            continue;
        }
        let held = rubbing.held & rubbing.mask;
        for slider in ground.sliders {
            v[dof(slider)] = S::select(held, zero, v[dof(slider)]);
        }
        if let Some(turn) = ground.turn {
            v[dof(turn)] = S::select(rubbing.held_turning & rubbing.mask, zero, v[dof(turn)]);
        }
    }
}
