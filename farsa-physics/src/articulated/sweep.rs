//! The sweeps of projected Gauss-Seidel over the rows of contacts, joints, stops and grounds.

use farsa_num::{Mask, Real, Scalar};

use crate::articulated::ground::relax_ground;
use crate::articulated::model::{Model, Pair};
use crate::articulated::pyramid::relax_edges;
use crate::articulated::rows::{apply, velocity};
use crate::articulated::solver::{Solver, cap};
use crate::articulated::spatial::{dot, select, sub};
use crate::articulated::stop::{length_of, relax_stop};

impl<S: Scalar> Solver<'_, S> {
    /// Sweeps over the active points, forwards and backwards in turn, and over the joints, in the lanes of `running`.
    #[inline(never)]
    pub(crate) fn sweep(
        &mut self,
        simd: S::Simd,
        model: &Model<S::Real>,
        count: usize,
        stops: usize,
        running: S::Mask,
    ) {
        S::vectorize(
            simd,
            #[inline(always)]
            || self.sweep_all(simd, model, count, stops, running),
        );
    }

    #[inline(always)]
    fn sweep_all(&mut self, simd: S::Simd, model: &Model<S::Real>, count: usize, stops: usize, mut running: S::Mask) {
        // Symmetric projected Gauss-Seidel: backwards every other time, so that no point is always served last. A lane
        // ends with its own first sweep of small changes, whatever its neighbors do, so its bits are those of a world
        // alone. The warm start of the next step corrects the rest.
        let settled = S::splat(simd, model.settled) * self.h;
        for round in 0..model.sweeps {
            let mut change = S::splat(simd, S::Real::from_f64(0.0));
            for k in 0..count {
                let (p, index) = self.active[if round % 2 == 0 { k } else { count - 1 - k }];
                change = change.max(self.relax(simd, model, running, usize::from(p), usize::from(index)));
            }
            for k in 0..self.pyramids {
                let back = if round % 2 == 0 { k } else { self.pyramids - 1 - k };
                let (p, index) = self.active[model.points - 1 - back];
                change = change.max(self.relax_pyramid(simd, model, running, usize::from(p), usize::from(index)));
            }
            for (law, row) in model.joint_laws.iter().zip(&mut *self.joint_rows) {
                change = change.max(row.relax(simd, model, law, running, self.stop_rows, self.response));
            }
            if stops > 0 {
                let mut length = length_of(simd, self.response);
                for stop in &mut self.stops[..stops] {
                    let rows = self.stop_rows;
                    let moved = relax_stop(simd, model, self.h, running, stop, rows, self.response, &mut length);
                    change = change.max(moved);
                }
            }
            for (ground, rubbing) in model.grounds.iter().zip(&mut *self.rubbing) {
                let moved = relax_ground(simd, model, ground, self.share, running, rubbing, self.response);
                change = change.max(moved);
            }
            running = running & change.gt(settled);
            if !running.any() {
                break;
            }
        }
    }

    /// Brings one point's impulse to its law in the lanes of `running`, given all others. Returns by how much it changes the
    /// velocities there [m/s].
    #[inline(always)]
    fn relax(&mut self, simd: S::Simd, model: &Model<S::Real>, running: S::Mask, pair: usize, index: usize) -> S {
        let pair = &model.pairs[pair];
        let dofs = &pair.reach.dofs;
        let n = dofs.len();
        let zero = S::splat(simd, S::Real::from_f64(0.0));
        let block = &mut self.blocks[pair.point + index];
        let mask = block.mask & running;
        if !mask.any() {
            return zero;
        }
        let rows = &self.rows[pair.row + index * n..pair.row + (index + 1) * n];
        let mut v = velocity(dofs, rows, block.velocity, self.response);
        let [a00, a11, a22, a01, a02, a12] = block.response;
        // Normal row: l += -(v + c l + offset) / (A_nn + c), not below 0. The change acts across at once.
        let old = block.impulse;
        let normal = (old[0] - (v[0] + block.compliance * old[0] + block.offset) * block.inverse[0]).max(zero);
        let d0 = normal - old[0];
        v[1] += a01 * d0;
        v[2] += a02 * d0;
        // Sticking solves both tangents at once. Sliding steps against the velocity, alike in all directions, and is
        // projected onto the cone of the new normal impulse.
        let limit = S::splat(simd, pair.friction) * normal;
        let slip = block.slip;
        let (w1, w2) = (v[1] + slip * old[1], v[2] + slip * old[2]);
        let stick = [
            old[1] - (block.stick[1] * w1 - a12 * w2) * block.stick[2],
            old[2] - (block.stick[0] * w2 - a12 * w1) * block.stick[2],
            zero,
        ];
        let slide = [old[1] - w1 * block.slide, old[2] - w2 * block.slide, zero];
        let holds = dot(stick, stick).le(limit * limit);
        let across = select(holds, stick, cap(slide, limit));
        let new = select(mask, [normal, across[0], across[1]], old);
        block.impulse = new;
        let difference = sub(new, old);
        apply(dofs, rows, difference, mask, self.response);
        let along = |k: usize, response: S| difference[k].abs() * response;
        let moved = along(0, a00).max(along(1, a11)).max(along(2, a22));
        match pair.rolling {
            Some(first) => moved.max(self.relax_rolling(simd, model, pair, first, index, mask)),
            None => moved,
        }
    }

    /// The same for a point with a pyramid of friction.
    #[inline(never)]
    fn relax_pyramid(
        &mut self,
        simd: S::Simd,
        model: &Model<S::Real>,
        running: S::Mask,
        pair: usize,
        index: usize,
    ) -> S {
        S::vectorize(
            simd,
            #[inline(always)]
            || {
                let pair = &model.pairs[pair];
                let dofs = &pair.reach.dofs;
                let n = dofs.len();
                let block = &mut self.blocks[pair.point + index];
                let mask = block.mask & running;
                if !mask.any() {
                    return S::splat(simd, S::Real::from_f64(0.0));
                }
                let rows = &self.rows[pair.row + index * n..pair.row + (index + 1) * n];
                let v = velocity(dofs, rows, block.velocity, self.response);
                let change = relax_edges(block, S::splat(simd, pair.friction), v, mask);
                apply(dofs, rows, change, mask, self.response);
                let along = |k: usize| change[k].abs() * block.response[k];
                let moved = along(0).max(along(1)).max(along(2));
                match pair.rolling {
                    Some(first) => moved.max(self.relax_rolling(simd, model, pair, first, index, mask)),
                    None => moved,
                }
            },
        )
    }

    /// Brings the rolling impulse of a point to its law: each axis by its own diagonal, then the whole moment projected onto
    /// its limit. Returns by how much it changes the velocities there [m/s].
    #[inline(always)]
    fn relax_rolling(
        &mut self,
        simd: S::Simd,
        model: &Model<S::Real>,
        pair: &Pair<S::Real>,
        first: usize,
        index: usize,
        mask: S::Mask,
    ) -> S {
        let dofs = &pair.reach.dofs;
        let n = dofs.len();
        let limit = S::splat(simd, pair.rolling_friction) * self.blocks[pair.point + index].impulse[0];
        let block = &mut self.rolling[first + index];
        let rows = &self.rolling_rows[pair.rolling_row + index * n..pair.rolling_row + (index + 1) * n];
        let v = velocity(dofs, rows, block.velocity, self.response);
        let old = block.impulse;
        let change = [v[0] * block.inverse[0], v[1] * block.inverse[1], v[2] * block.inverse[2]];
        let new = select(mask, cap(sub(old, change), limit), old);
        block.impulse = new;
        let difference = sub(new, old);
        apply(dofs, rows, difference, mask, self.response);
        let turned = |k: usize| difference[k].abs() * block.response[k];
        let bound = S::splat(simd, model.colliders[pair.colliders[0]].bound);
        turned(0).max(turned(1)).max(turned(2)) * bound
    }
}
