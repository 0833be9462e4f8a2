//! Restitution: a fast approach ends in one step, and the point leaves with a share of its speed.
//!
//! Newton's law `v+ = -e v` with the normal speeds v before and v+ after the step replaces the compliant law of a point in
//! the step in which its surfaces would touch. As a row of impulses l it is `v+ + e v >= 0`, `l >= 0`, without compliance.
//! Approaches below [`Model::bounce`](crate::articulated::Model) end in spring and damper, so that bodies come to rest.

use farsa_num::{Mask as _, Real as _, Scalar};

use crate::articulated::model::{Model, Pair};
use crate::articulated::rows::velocity_before;
use crate::articulated::solver::{Candidate, Solver, links_of_pair};
use crate::articulated::spatial::{dot, sub};

impl<S: Scalar> Solver<'_, S> {
    /// Replaces the normal law of a point whose block is there by that of restitution in the lanes that bounce.
    #[inline(never)]
    pub(crate) fn bounce(
        &mut self,
        simd: S::Simd,
        model: &Model<S::Real>,
        pair: &Pair<S::Real>,
        index: usize,
        candidate: &Candidate<S>,
    ) {
        let Some(restitution) = pair.restitution else { return };
        S::vectorize(
            simd,
            #[inline(always)]
            || {
                let zero = S::splat(simd, S::Real::from_f64(0.0));
                let Candidate { point, velocity, mask, .. } = *candidate;
                let [first, second] =
                    links_of_pair(model, pair).map(|link| velocity_before(simd, link, self.work, point.position));
                let before = dot(sub(first, second), point.normal);
                let margin = pair.soft.as_ref().map_or(zero, |soft| S::splat(simd, soft.margin));
                let ahead = point.gap - margin + self.h * dot(velocity, point.normal);
                let bounces = mask & before.lt(-S::splat(simd, model.bounce)) & ahead.le(zero);
                if !bounces.any() {
                    return;
                }
                let block = &mut self.blocks[pair.point + index];
                let rigid = zero.constant(1.0) / block.response[0];
                block.compliance = S::select(bounces, zero, block.compliance);
                block.offset = S::select(bounces, S::splat(simd, restitution) * before, block.offset);
                block.inverse[0] = S::select(bounces, rigid, block.inverse[0]);
            },
        );
    }
}
