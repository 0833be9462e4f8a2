//! Joint stops while contacts push: one-sided rows beside the contacts'.
//!
//! A stop that a joint would run into by itself is part of the joint's implicit diagonal. A contact's impulse may drive
//! a joint into its stop within the step that the contact is found in, so every joint near a stop also gets a row here.

use farsa_num::{Mask, Real, Scalar};

use crate::articulated::link::{LinkData, Motion, WORLD};
use crate::articulated::model::Model;
use crate::articulated::rows::equal;
use crate::articulated::spatial::Spatial;

/// Joints are watched when a change of speed of this size [rad/s or m/s] would bring them to a stop within a step.
const CHANGE: f64 = 20.0;

/// One joint's row.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Stop<S: Scalar> {
    pub(crate) mask: S::Mask,
    pub(crate) link: u16,
    /// Predicted speed and position of the joint.
    speed: S,
    position: S,
    impulse: S,
    /// `J M^-1 J^T`, and impulse per predicted overrun.
    response: S,
    gain: S,
}

impl<S: Scalar> Stop<S> {
    pub(crate) fn new(simd: S::Simd) -> Self {
        let o = S::splat(simd, S::Real::from_f64(0.0));
        Self { mask: o.lt(o), link: 0, speed: o, position: o, impulse: o, response: o, gain: o }
    }
}

/// Sets up the rows of the joints near a stop; returns how many there are.
///
/// `rows` (one word per entry) and `stops` [links] receive them; `v` are predicted velocities, `pushed` the
/// lanes with contacts on them.
#[inline(never)]
pub(crate) fn set_up_stops<S: Scalar>(
    simd: S::Simd,
    model: &Model<S::Real>,
    q: &[S],
    v: &[S],
    work: &[LinkData<S>],
    roots: &[crate::articulated::tree::Root<S>],
    inverse_sqrt_inertia: &[S],
    pushed: S::Mask,
    rows: &mut [S],
    stops: &mut [Stop<S>],
) -> usize {
    S::vectorize(
        simd,
        #[inline(always)]
        || watch(simd, model, q, v, work, roots, inverse_sqrt_inertia, pushed, rows, stops),
    )
}

#[inline(always)]
fn watch<S: Scalar>(
    simd: S::Simd,
    model: &Model<S::Real>,
    q: &[S],
    v: &[S],
    work: &[LinkData<S>],
    roots: &[crate::articulated::tree::Root<S>],
    inverse_sqrt_inertia: &[S],
    pushed: S::Mask,
    rows: &mut [S],
    stops: &mut [Stop<S>],
) -> usize {
    let one = S::splat(simd, S::Real::from_f64(1.0));
    let zero = S::splat(simd, S::Real::from_f64(0.0));
    let h = S::splat(simd, model.h);
    let minus = -one;
    let mut count = 0;
    if !pushed.any() {
        return count;
    }
    for (i, link) in model.links.iter().enumerate() {
        if link.motion == Motion::Floating || !model.stops[i] {
            continue;
        }
        let (x, speed) = (q[usize::from(link.q)], v[usize::from(link.dof)]);
        let ahead = x + h * speed;
        let reach = h * h.constant(CHANGE);
        let near = (ahead + reach).gt(S::splat(simd, link.upper)) | (ahead - reach).lt(S::splat(simd, link.lower));
        let mask = pushed & near;
        if !mask.any() {
            continue;
        }
        // The row of a unit effort at the joint: 1 / sqrt(D) for itself, and -U / D climbs on towards the root.
        let path = &model.stop_paths[i];
        let rows = &mut rows[path.row..path.row + path.dofs.len()];
        let mut y = inverse_sqrt_inertia[usize::from(link.dof)];
        rows[0] = y;
        let mut response = y * y;
        let mut p: Spatial<S> = work[i].column.scale(minus * work[i].reciprocal);
        let mut at = 1;
        let mut next = link.parent;
        while next != WORLD {
            let l = &model.links[usize::from(next)];
            if l.motion == Motion::Floating {
                let half = roots[usize::from(l.root)].factor.half(p);
                for y in &half {
                    rows[at] = *y;
                    response += *y * *y;
                    at += 1;
                }
            } else {
                let w = &work[usize::from(next)];
                let s = w.subspace.dot(p);
                y = s * inverse_sqrt_inertia[usize::from(l.dof)];
                rows[at] = y;
                response += y * y;
                at += 1;
                p = p - w.column.scale(s * w.reciprocal);
            }
            next = l.parent;
        }
        // A stop is a spring at the end of the step, l = -h k (q + h v+ - q0). With v+ = v + A l, v without this stop, that is
        // l = -h k (q + h v - q0) / (1 + h^2 k A): `gain` times the overrun that there would be without it.
        let stiffness = h * S::splat(simd, link.limit_stiffness);
        stops[count] = Stop {
            mask,
            link: i as u16,
            speed,
            position: x,
            impulse: zero,
            response,
            gain: stiffness / (one + h * stiffness * response),
        };
        count += 1;
    }
    count
}

/// Brings one stop's impulse to its law, given all others.
#[inline(always)]
pub(crate) fn relax_stop<S: Scalar>(
    simd: S::Simd,
    model: &Model<S::Real>,
    stop: &mut Stop<S>,
    rows: &[S],
    response: &mut [S],
) {
    let link = &model.links[usize::from(stop.link)];
    let path = &model.stop_paths[usize::from(stop.link)];
    let rows = &rows[path.row..path.row + path.dofs.len()];
    let zero = S::splat(simd, S::Real::from_f64(0.0));
    let mut speed = stop.speed;
    for (&d, y) in path.dofs.iter().zip(rows) {
        speed += *y * response[usize::from(d)];
    }
    // Where the joint would be without this stop.
    let ahead = stop.position + S::splat(simd, model.h) * (speed - stop.response * stop.impulse);
    let over = (ahead - S::splat(simd, link.upper)).max(zero);
    let under = (S::splat(simd, link.lower) - ahead).max(zero);
    let new = S::select(stop.mask, (under - over) * stop.gain, zero);
    let change = new - stop.impulse;
    stop.impulse = new;
    // As for contacts: most joints near a stop do not run into it.
    let mask = stop.mask & !equal(change, zero);
    if !mask.any() {
        return;
    }
    for (&d, y) in path.dofs.iter().zip(rows) {
        let z = &mut response[usize::from(d)];
        *z = S::select(mask, *z + *y * change, *z);
    }
}
