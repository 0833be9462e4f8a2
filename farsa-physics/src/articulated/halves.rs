//! Dynamics steps in halves, for the lanes in which a link is fast.

use core::ops::Range;

use farsa_num::{Real, Scalar};

use crate::articulated::group::is_clear;
use crate::articulated::link::{LinkData, Motion};
use crate::articulated::model::{Model, POINT_WORDS};
use crate::articulated::spatial::{dot, sub};

/// In which lanes a link would leave its tangent by more than [`Options::path_error`](crate::articulated::Options) in a
/// whole dynamics step.
#[inline(always)]
pub(crate) fn fast_lanes<S: Scalar>(simd: S::Simd, model: &Model<S::Real>, work: &[LinkData<S>]) -> S::Mask {
    let mut largest = S::splat(simd, S::Real::from_f64(0.0));
    let Some(fast) = model.fast else { return largest.lt(largest) };
    if model.points > 0 {
        // Contacts move along tangents within a step. The center of a floating body does so exactly.
        for (link, w) in model.links.iter().zip(work) {
            if link.motion != Motion::Floating && link.sliding.is_none() {
                let (spin, speed) = (w.velocity.angular, w.velocity.at(sub(w.centre, w.reference)));
                largest = largest.max(dot(spin, spin) * dot(speed, speed));
            }
        }
    }
    largest.gt(S::splat(simd, fast))
}

/// Copies the words of a state that [`take_back`] reads. It reads one point of a group that is far in all lanes.
#[inline(always)]
pub(crate) fn remember<S: Scalar>(simd: S::Simd, model: &Model<S::Real>, state: &[S], before: &mut [S]) {
    let mut copy = |range: Range<usize>| before[range.clone()].copy_from_slice(&state[range]);
    let first = model.first_point();
    copy(0..model.first_command());
    for group in &model.groups {
        let start = group.points.start;
        let end = if is_clear(simd, &state[first..], group) { start + 1 } else { group.points.end };
        copy(first + POINT_WORDS * start..first + POINT_WORDS * end);
    }
    copy(first + POINT_WORDS * model.points..state.len());
}

/// Returns the lanes that do not make a second half to their state before it.
#[inline(always)]
pub(crate) fn take_back<S: Scalar>(
    simd: S::Simd,
    model: &Model<S::Real>,
    halved: S::Mask,
    before: &[S],
    state: &mut [S],
) {
    let mut keep = |range: Range<usize>| {
        for (x, before) in state[range.clone()].iter_mut().zip(&before[range]) {
            *x = S::select(halved, *x, *before);
        }
    };
    let first = model.first_point();
    keep(0..model.first_command());
    for group in &model.groups {
        // Where a group was far in all lanes, it still is in these.
        if !is_clear(simd, &before[first..], group) {
            keep(first + POINT_WORDS * group.points.start..first + POINT_WORDS * group.points.end);
        }
    }
    keep(first + POINT_WORDS * model.points..before.len());
}
