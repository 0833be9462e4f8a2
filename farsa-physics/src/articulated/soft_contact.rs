//! Contacts that stop motion gradually, as those of MuJoCo do: with an inertia, a margin and an impedance.

use farsa_num::{Real, Scalar};

use crate::articulated::model::{Model, Pair, Soft};
use crate::articulated::pyramid::{EdgeLaw, edge_tangents};
use crate::articulated::rows::{Load, apply, tangents, velocity_before, write_rows};
use crate::articulated::solver::{Block, Candidate, ConeLaw, Solver, cone_block, links_of_pair};
use crate::articulated::spatial::{Vector, dot, sub};

impl<R: Real> Soft<R> {
    /// In which lanes a point with this gap, and with the gap `ahead` at the end of the step, counts.
    ///
    /// Pyramids count below their own margin `alone`, as in MuJoCo, others like contacts that count below `margin`.
    #[inline(always)]
    pub(crate) fn counts<S: Scalar<Real = R>>(
        &self,
        simd: S::Simd,
        margin: S,
        [gap, ahead]: [S; 2],
        alone: bool,
    ) -> S::Mask {
        let own = S::splat(simd, self.margin);
        let near = ahead.lt(margin + own);
        if alone { near & gap.lt(own) } else { near }
    }
}

impl<S: Scalar> Solver<'_, S> {
    /// Sets up the rows of a point and starts them from the impulse `old` of the last step, given in the world's axes.
    #[inline(never)]
    pub(crate) fn soft_block(
        &mut self,
        simd: S::Simd,
        model: &Model<S::Real>,
        of: (&Pair<S::Real>, &Soft<S::Real>),
        index: usize,
        candidate: &Candidate<S>,
        old: [S; 3],
    ) {
        S::vectorize(
            simd,
            #[inline(always)]
            || self.block_of(simd, model, of, index, candidate, old),
        );
    }

    #[inline(always)]
    fn block_of(
        &mut self,
        simd: S::Simd,
        model: &Model<S::Real>,
        (pair, soft): (&Pair<S::Real>, &Soft<S::Real>),
        index: usize,
        candidate: &Candidate<S>,
        old: [S; 3],
    ) {
        let zero = S::splat(simd, S::Real::from_f64(0.0));
        let one = S::splat(simd, S::Real::from_f64(1.0));
        let h = self.h;
        let Candidate { point, velocity: v, mask, gap } = *candidate;
        let [t1, t2] = if pair.is_pyramid { edge_tangents(point.normal) } else { tangents(point.normal) };
        let axes = [point.normal, t1, t2];
        let n = pair.reach.dofs.len();
        let rows = &mut self.rows[pair.row + index * n..pair.row + (index + 1) * n];
        let load = Load::Forces(point.position);
        let response =
            write_rows(simd, model, pair, self.work, self.roots, self.inverse_sqrt_inertia, load, &axes, rows);
        let links = links_of_pair(model, pair);
        let before = sub(
            velocity_before(simd, links[0], self.work, point.position),
            velocity_before(simd, links[1], self.work, point.position),
        );
        let along = |x: Vector<S>| [dot(x, axes[0]), dot(x, axes[1]), dot(x, axes[2])];
        // The contact begins at the margin. Before, only the spring at the end of the step counts.
        let height = point.gap - S::splat(simd, soft.margin);
        let touching = height.le(zero);
        let mut stiffness = h * S::splat(simd, pair.stiffness);
        let mut damping = S::select(touching, S::splat(simd, pair.damping), zero);
        let mut inertia = S::select(touching, S::splat(simd, soft.inertia), zero);
        let [mut b, mut m] = soft.friction.map(|x| S::splat(simd, x));
        if let Some(curve) = &soft.curve {
            let [factor, of_spring] = curve.factors(simd, -height);
            (damping, inertia, b, m) = (damping * factor, inertia * factor, b * factor, m * factor);
            stiffness *= of_spring;
        }
        let block = if pair.is_pyramid {
            let block = Block { mask, axes, response, gap, point: point.position, ..Block::new(simd) };
            let friction = S::splat(simd, pair.friction);
            let law = EdgeLaw { friction, h, height, spring: stiffness, damping, inertia };
            law.block(block, along(v), along(before), along(old))
        } else {
            // An inertia m adds -m (v+ - v) / h to a force, with v the velocity before the step.
            let (compliance, slip) = (one / (h * (stiffness + damping) + inertia), one / (h * b + m));
            let (v, before) = (along(v), along(before));
            let law = ConeLaw {
                compliance,
                offset: (stiffness * height - inertia * before[0]) * compliance,
                slip,
                velocity: [v[0], v[1] - m * slip * before[1], v[2] - m * slip * before[2]],
            };
            cone_block(simd, pair, candidate, &axes, response, &law, old)
        };
        self.blocks[pair.point + index] = block;
        apply(&pair.reach.dofs, rows, block.impulse, mask, self.response);
    }
}
