//! Joint stops while contacts push: one-sided rows next to the contacts'.
//!
//! A stop that a joint would reach by itself is part of the joint's implicit diagonal. A contact's impulse may drive a
//! joint into its stop within the step of that contact, so every joint near a stop also gets a row here.
//!
//! Few of them reach it. The impulses change a joint's speed by `y . z`, with its row y and the response z, which is at
//! most `|y| |z|`. The row is skipped while `|z|` is so small that the joint surely stays within its limits.

use farsa_num::{Mask, Real, Scalar};

use crate::articulated::link::{LinkData, Motion, WORLD};
use crate::articulated::model::Model;
use crate::articulated::rows::equal;
use crate::articulated::spatial::Spatial;
use crate::articulated::tree::Root;

/// Joints are watched when a change of speed of this size [rad/s or m/s] would bring them to a stop within a step.
const CHANGE: f64 = 20.0;
/// By how much a computed length is enlarged: more than the roundings of a sum of a thousand squares.
const LONGER: f64 = 1.001;
/// A part of a number that is more than what one rounding, of `f32`, changes it by.
const ROUNDING: f64 = 1.0 / 1_048_576.0;

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
    /// Length of the row, and the length of the response up to which the joint stays within its limits without an impulse.
    length: S,
    idle: S,
}

impl<S: Scalar> Stop<S> {
    pub(crate) fn new(simd: S::Simd) -> Self {
        let o = S::splat(simd, S::Real::from_f64(0.0));
        Self { mask: o.lt(o), link: 0, speed: o, position: o, impulse: o, response: o, gain: o, length: o, idle: o }
    }

    /// The stop of a joint at a position [rad or m] with a predicted speed, whose row has `entries` words and this response,
    /// in the lanes of `mask`.
    #[inline(always)]
    fn from_row(
        model: &Model<S::Real>,
        link: usize,
        mask: S::Mask,
        h: S,
        [position, speed]: [S; 2],
        entries: usize,
        response: S,
    ) -> Self {
        let simd = position.simd();
        let zero = S::splat(simd, S::Real::from_f64(0.0));
        let one = zero.constant(1.0);
        let limits = &model.links[link];
        // A stop is a spring at the end of the step, l = -h k (q + h v+ - q0). With v+ = v + A l, v without this stop,
        // that is l = -h k (q + h v - q0) / (1 + h^2 k A), or `gain` times the overrun without the stop.
        let stiffness = h * S::splat(simd, limits.limit_stiffness);
        let length = response.sqrt() * zero.constant(LONGER);
        // |y . z| <= |y| |z|, less what may be rounded: of the positions, and of a sum of the speed and `entries` products.
        let [lower, upper] = [S::splat(simd, limits.lower), S::splat(simd, limits.upper)];
        let ahead = position + h * speed;
        let positions = position.abs() + lower.abs().max(upper.abs());
        let room = (upper - ahead).min(ahead - lower) - positions * zero.constant(4.0 * ROUNDING);
        let speeds = speed.abs() * zero.constant((entries + 2) as f64 * ROUNDING);
        let idle = (room / h - speeds) / (length * zero.constant(LONGER));
        Self {
            mask,
            link: link as u16,
            speed,
            position,
            impulse: zero,
            response,
            gain: stiffness / (one + h * stiffness * response),
            length,
            idle: S::select(mask, idle, zero.constant(f64::INFINITY)),
        }
    }

    /// Returns whether the joint stays within its limits in every lane of `running`, at a response that is no longer than
    /// `length`.
    #[inline(always)]
    fn is_idle(&self, running: S::Mask, length: S) -> bool {
        (length.le(self.idle) | !running).all()
    }
}

/// The length of a response, or a little more.
#[inline(always)]
pub(crate) fn length_of<S: Scalar>(simd: S::Simd, response: &[S]) -> S {
    let mut squares = [S::splat(simd, S::Real::from_f64(0.0)); 4];
    let (parts, rest) = response.as_chunks::<4>();
    for part in parts {
        for (square, z) in squares.iter_mut().zip(part) {
            *square += *z * *z;
        }
    }
    for z in rest {
        squares[0] += *z * *z;
    }
    let [a, b, c, d] = squares;
    let sum = (a + b) + (c + d);
    sum.sqrt() * sum.constant(LONGER)
}

/// Sets up the rows of the joints near a stop. Returns how many there are.
///
/// `rows` (one word per entry) and `stops` [links] receive them. `v` are predicted velocities, `pushed` the lanes with
/// contacts on them.
#[inline(never)]
pub(crate) fn set_up_stops<S: Scalar>(
    simd: S::Simd,
    model: &Model<S::Real>,
    h: S,
    q: &[S],
    v: &[S],
    work: &[LinkData<S>],
    roots: &[Root<S>],
    inverse_sqrt_inertia: &[S],
    pushed: S::Mask,
    rows: &mut [S],
    stops: &mut [Stop<S>],
) -> usize {
    S::vectorize(
        simd,
        #[inline(always)]
        || watch(simd, model, h, q, v, work, roots, inverse_sqrt_inertia, pushed, rows, stops),
    )
}

#[inline(always)]
fn watch<S: Scalar>(
    simd: S::Simd,
    model: &Model<S::Real>,
    h: S,
    q: &[S],
    v: &[S],
    work: &[LinkData<S>],
    roots: &[Root<S>],
    inverse_sqrt_inertia: &[S],
    pushed: S::Mask,
    rows: &mut [S],
    stops: &mut [Stop<S>],
) -> usize {
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
        let path = &model.stop_paths[i];
        let rows = &mut rows[path.row..path.row + path.dofs.len()];
        let response = write_joint_row(model, i, work, roots, inverse_sqrt_inertia, rows);
        stops[count] = Stop::from_row(model, i, mask, h, [x, speed], rows.len(), response);
        count += 1;
    }
    count
}

/// Writes the row of a unit effort at the joint of a link, and returns its response.
#[inline(always)]
pub(crate) fn write_joint_row<S: Scalar>(
    model: &Model<S::Real>,
    link: usize,
    work: &[LinkData<S>],
    roots: &[Root<S>],
    inverse_sqrt_inertia: &[S],
    rows: &mut [S],
) -> S {
    // 1 / sqrt(D) for the joint itself, and -U / D climbs on towards the root.
    let mut y = inverse_sqrt_inertia[usize::from(model.links[link].dof)];
    let minus = -y.constant(1.0);
    rows[0] = y;
    let mut response = y * y;
    let mut p: Spatial<S> = work[link].column.scale(minus * work[link].reciprocal);
    let mut at = 1;
    let mut next = model.links[link].parent;
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
    response
}

/// Brings one stop's impulse to its law in the lanes of `running`, given all others. `length` is that of the response or
/// more, also afterwards. Returns by how much the joint's speed changes [rad/s or m/s].
#[inline(always)]
pub(crate) fn relax_stop<S: Scalar>(
    simd: S::Simd,
    model: &Model<S::Real>,
    h: S,
    running: S::Mask,
    stop: &mut Stop<S>,
    rows: &[S],
    response: &mut [S],
    length: &mut S,
) -> S {
    let zero = S::splat(simd, S::Real::from_f64(0.0));
    if stop.is_idle(running, *length) {
        return zero;
    }
    let link = &model.links[usize::from(stop.link)];
    let path = &model.stop_paths[usize::from(stop.link)];
    let rows = &rows[path.row..path.row + path.dofs.len()];
    let mut speed = stop.speed;
    for (&d, y) in path.dofs.iter().zip(rows) {
        speed += *y * response[usize::from(d)];
    }
    // Where the joint would be without this stop.
    let ahead = stop.position + h * (speed - stop.response * stop.impulse);
    let over = (ahead - S::splat(simd, link.upper)).max(zero);
    let under = (S::splat(simd, link.lower) - ahead).max(zero);
    let new = S::select(stop.mask & running, (under - over) * stop.gain, stop.impulse);
    let change = new - stop.impulse;
    stop.impulse = new;
    // As for contacts: most joints near a stop do not run into it.
    let mask = stop.mask & !equal(change, zero);
    if !mask.any() {
        return zero;
    }
    // From now on there is an impulse that may have to become smaller.
    stop.idle = S::select(mask, zero.constant(-1.0), stop.idle);
    *length = (*length + stop.length * change.abs()) * zero.constant(1.0 + ROUNDING);
    for (&d, y) in path.dofs.iter().zip(rows) {
        let z = &mut response[usize::from(d)];
        *z = S::select(mask, *z + *y * change, *z);
    }
    change.abs() * stop.response
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]

    use alloc::vec;
    use alloc::vec::Vec;

    use farsa_body::robots::ArmAndHand;
    use farsa_num::{Domain, Stream, exp};
    use proptest::prelude::*;

    use super::{Stop, length_of, relax_stop};
    use crate::articulated::model::{Model, Options};

    fn model() -> Model<f32> {
        Model::new(&ArmAndHand::default().robot().unwrap(), &Options::default()).unwrap()
    }

    /// The stops of all joints, of rows drawn for bodies of grams and of kilograms, at positions near the limits.
    fn drawn(model: &Model<f32>, stream: &mut Stream) -> (Vec<Stop<f32>>, Vec<f32>) {
        let mut rows = vec![0.0; model.stop_entries];
        for y in &mut rows {
            let size = exp(stream.range(-4.6, 4.6));
            *y = stream.range(-1.0, 1.0) * size;
        }
        let links = (0..model.links.len()).filter(|link| model.stops[*link]);
        let stops = links.map(|link| {
            let (limits, path) = (&model.links[link], &model.stop_paths[link]);
            let row = &rows[path.row..path.row + path.dofs.len()];
            let position = [limits.lower, limits.upper][link % 2] + 0.02 * stream.range(-1.0, 1.0);
            let response = row.iter().map(|y| y * y).sum();
            Stop::from_row(model, link, true, model.h, [position, stream.range(-1.0, 1.0)], row.len(), response)
        });
        (stops.collect(), rows)
    }

    #[test]
    fn what_is_passed_over_would_not_have_changed() {
        let model = model();
        let (mut idle, mut pushing) = (0, 0);
        for trial in 0..200 {
            let stream = &mut Stream::new(1, Domain::General, trial, 0, 0);
            let (mut stops, rows) = drawn(&model, stream);
            let mut every: Vec<Stop<f32>> = stops.iter().map(|stop| Stop { idle: -1.0, ..*stop }).collect();
            let mut response: Vec<f32> = (0..model.dofs).map(|_| stream.range(-0.1, 0.1)).collect();
            let mut other = response.clone();
            let mut size = 1.0;
            for sweep in 0..60 {
                // A contact's row, and impulses that decrease with the sweeps.
                let change = stream.range(-1.0, 1.0) * size;
                size *= 0.8;
                for (z, other) in response.iter_mut().zip(&mut other) {
                    let y = stream.range(-1.0, 1.0);
                    *z += y * change;
                    *other += y * change;
                }
                let mut length = length_of((), &response);
                for (stop, looked_at) in stops.iter_mut().zip(&mut every) {
                    idle += usize::from(stop.is_idle(true, length));
                    relax_stop((), &model, model.h, true, stop, &rows, &mut response, &mut length);
                    relax_stop((), &model, model.h, true, looked_at, &rows, &mut other, &mut f32::INFINITY.clone());
                    pushing += usize::from(stop.impulse != 0.0);
                    assert_eq!(stop.impulse.to_bits(), looked_at.impulse.to_bits(), "trial {trial}, sweep {sweep}");
                    assert!(length_of((), &response) <= length * 1.001, "trial {trial}, sweep {sweep}");
                }
                assert!(response.iter().zip(&other).all(|(a, b)| a.to_bits() == b.to_bits()));
            }
        }
        assert!(idle > 10_000 && pushing > 10_000, "{idle} idle, {pushing} pushing");
    }

    #[test]
    fn what_has_pushed_is_looked_at_again() {
        let model = model();
        let (stops, rows) = drawn(&model, &mut Stream::new(2, Domain::General, 0, 0, 0));
        for stop in stops {
            let (limits, path) = (&model.links[usize::from(stop.link)], &model.stop_paths[usize::from(stop.link)]);
            let row = &rows[path.row..path.row + path.dofs.len()];
            let position = limits.upper - 0.01 * (limits.upper - limits.lower);
            let mut stop = Stop::from_row(
                &model,
                usize::from(stop.link),
                true,
                model.h,
                [position, 0.0],
                row.len(),
                stop.response,
            );
            // A contact drives the joint a little beyond its limit and then lets go: so must the stop.
            let contact: Vec<f32> = row.iter().map(|y| 1.02 * stop.idle / stop.length * y).collect();
            let mut response = vec![0.0; model.dofs];
            for pushes in [true, false] {
                for (d, z) in path.dofs.iter().zip(&contact) {
                    response[usize::from(*d)] += if pushes { *z } else { -z };
                }
                let mut length = length_of((), &response);
                let idle = stop.is_idle(true, length);
                relax_stop((), &model, model.h, true, &mut stop, &rows, &mut response, &mut length);
                assert!(!idle && (stop.impulse < 0.0) == pushes && (stop.impulse == 0.0) != pushes, "{stop:?}");
            }
        }
    }

    proptest! {
        /// The worst response is along the row. As long as a stop may be it does nothing, and a little longer it acts.
        #[test]
        fn the_bound_holds_and_is_near(
            seed in any::<u64>(),
            link in any::<prop::sample::Index>(),
            share in 1e-3_f32..0.4,
            upper in any::<bool>(),
        ) {
            let model = model();
            let stream = &mut Stream::new(seed, Domain::General, 0, 0, 0);
            let (stops, rows) = drawn(&model, stream);
            let link = usize::from(link.get(&stops).link);
            let (limits, path) = (&model.links[link], &model.stop_paths[link]);
            let row = &rows[path.row..path.row + path.dofs.len()];
            let square: f32 = row.iter().map(|y| y * y).sum();
            let room = share * (limits.upper - limits.lower);
            let position = if upper { limits.upper - room } else { limits.lower + room };
            let impulse = |part: f32| {
                let mut stop = Stop::from_row(&model, link, true, model.h, [position, 0.0], row.len(), square);
                let size = part * stop.idle / square.sqrt() * if upper { 1.0 } else { -1.0 };
                let mut response = vec![0.0; model.dofs];
                for (d, y) in path.dofs.iter().zip(row) {
                    response[usize::from(*d)] = size * y;
                }
                stop.idle = -1.0;
                relax_stop((), &model, model.h, true, &mut stop, &rows, &mut response, &mut 0.0);
                stop.impulse
            };
            prop_assert_eq!(impulse(1.0), 0.0);
            prop_assert!(impulse(1.01 + 3e-5 / room).abs() > 0.0);
        }
    }
}
