//! The contact solver: points that may carry an impulse, set up as rows over the articulated factor and solved together.
//!
//! Every contact point is a spring and damper along its normal and friction across it, both implicit: the impulse of a
//! step is a function of the velocity *after* it. The velocities after it are those without contacts plus the response
//! of the articulated bodies to all impulses ([`crate::articulated::rows`]). Sweeps of projected Gauss-Seidel over the
//! points keep non-negative normal impulses and the friction cone exactly. Every impulse acts equally and oppositely on
//! both sides, even if the sweeps have not converged.

use farsa_num::{Mask, Real, Scalar};

use crate::articulated::boxes::{BOX_POINTS, find_boxes, hand_over};
use crate::articulated::collision::{PlacedShape, Point};
use crate::articulated::contact::{clearance, find, halves_of_boxes, reach};
use crate::articulated::ground::Rubbing;
use crate::articulated::group::{Sphere, forget_group, forget_point, rolling_words, spheres_near, unknown_gap};
use crate::articulated::joint_row::JointRow;
use crate::articulated::link::LinkData;
use crate::articulated::model::{Model, POINT_WORDS, Pair};
use crate::articulated::rows::{Load, apply, spin, tangents, velocity, velocity_at, write_rows};
use crate::articulated::spatial::{Vector, add, dot, scale, select, sub};
use crate::articulated::stop::Stop;
use crate::articulated::tree::Root;

/// One contact point's block of three rows: normal, two tangents (or spin and two rolling axes).
#[derive(Clone, Copy, Debug)]
pub(crate) struct Block<S: Scalar> {
    pub(crate) mask: S::Mask,
    pub(crate) axes: [Vector<S>; 3],
    /// Relative velocity along the axes without contact impulses.
    pub(crate) velocity: [S; 3],
    pub(crate) impulse: [S; 3],
    /// `A = J M^-1 J^T` of the block: nn, 11, 22, n1, n2, 12.
    pub(crate) response: [S; 6],
    /// Reciprocals of the diagonal response: of the normal row, or of all three rolling rows.
    pub(crate) inverse: [S; 3],
    /// The tangents' diagonal and the reciprocal of their determinant.
    pub(crate) stick: [S; 3],
    pub(crate) slide: S,
    /// Compliance of friction.
    pub(crate) slip: S,
    /// Compliance and offset of the normal law.
    pub(crate) compliance: S,
    pub(crate) offset: S,
    pub(crate) gap: S,
    pub(crate) point: Vector<S>,
}

impl<S: Scalar> Block<S> {
    pub(crate) fn new(simd: S::Simd) -> Self {
        let o = S::splat(simd, S::Real::from_f64(0.0));
        Self {
            mask: o.lt(o),
            axes: [[o; 3]; 3],
            velocity: [o; 3],
            impulse: [o; 3],
            response: [o; 6],
            inverse: [o; 3],
            stick: [o; 3],
            slide: o,
            slip: o,
            compliance: o,
            offset: o,
            gap: o,
            point: [o; 3],
        }
    }

    /// Impulses of the edges of a pyramid, and the reciprocals of their responses. They use the words of a round cone.
    #[inline(always)]
    pub(crate) fn edges(&self) -> ([S; 4], [S; 4]) {
        let ([a, b, c], [d, e, f]) = (self.stick, self.inverse);
        ([a, b, c, self.slip], [d, e, f, self.slide])
    }

    #[inline(always)]
    pub(crate) fn set_edges(&mut self, [a, b, c, slip]: [S; 4], [d, e, f, slide]: [S; 4]) {
        (self.stick, self.inverse, self.slip, self.slide) = ([a, b, c], [d, e, f], slip, slide);
    }
}

/// A contact point that is near enough to be looked at.
#[derive(Clone, Copy)]
pub(crate) struct Candidate<S: Scalar> {
    pub(crate) point: Point<S>,
    /// Predicted velocity of the first shape's point relative to the second's.
    pub(crate) velocity: Vector<S>,
    /// In which lanes it may carry an impulse.
    pub(crate) mask: S::Mask,
    /// The gap for the next step.
    pub(crate) gap: S,
}

/// Law of a point with a round cone of friction.
pub(crate) struct ConeLaw<S> {
    pub(crate) compliance: S,
    pub(crate) offset: S,
    pub(crate) slip: S,
    /// Relative velocity along the axes without contact impulses.
    pub(crate) velocity: [S; 3],
}

/// The parts of the scratch that the contact solver uses.
pub(crate) struct Solver<'a, S: Scalar> {
    /// Duration of the present step [s], and its share of a whole dynamics step, one or a half.
    pub(crate) h: S,
    pub(crate) share: S,
    /// The lanes that make the step.
    pub(crate) live: S::Mask,
    pub(crate) placed: &'a [PlacedShape<S>],
    pub(crate) spheres: &'a [Sphere<S>],
    /// The points of the present pair of boxes.
    pub(crate) manifold: &'a mut [Point<S>; BOX_POINTS],
    pub(crate) work: &'a [LinkData<S>],
    pub(crate) roots: &'a [Root<S>],
    /// Square roots of the reciprocals of the joints' articulated inertias [dofs].
    pub(crate) inverse_sqrt_inertia: &'a [S],
    pub(crate) blocks: &'a mut [Block<S>],
    pub(crate) rolling: &'a mut [Block<S>],
    pub(crate) rows: &'a mut [[S; 3]],
    pub(crate) rolling_rows: &'a mut [[S; 3]],
    /// Response of all impulses so far, in the factor's coordinates [dofs].
    pub(crate) response: &'a mut [S],
    /// Pair and point of the active points, those with pyramids from the end.
    pub(crate) active: &'a mut [(u16, u16)],
    pub(crate) pyramids: usize,
    pub(crate) stops: &'a mut [Stop<S>],
    pub(crate) stop_rows: &'a [S],
    /// In which lanes something touches the body on each ground.
    pub(crate) on_grounds: &'a mut [S::Mask],
    pub(crate) rubbing: &'a mut [Rubbing<S>],
    pub(crate) joint_rows: &'a mut [JointRow<S>],
}

/// Distance between a pair's bounds, and the distance within which its surfaces are looked at [m].
#[inline(always)]
fn bounds<S: Scalar>(
    simd: S::Simd,
    model: &Model<S::Real>,
    h: S,
    pair: &Pair<S::Real>,
    placed: &[PlacedShape<S>],
) -> [S; 2] {
    let [a, b] = pair.colliders;
    let approach = sub(placed[a].velocity, placed[b].velocity);
    [clearance(simd, model, pair, placed), reach(simd, model, h, dot(approach, approach).sqrt())]
}

#[inline(always)]
pub(crate) fn links_of_pair<R>(model: &Model<R>, pair: &Pair<R>) -> [u16; 2] {
    let [a, b] = pair.colliders;
    [model.colliders[a].mount.link, model.colliders[b].mount.link]
}

/// Returns the number of pairs whose surfaces were examined in the step that left the colliders at these places.
pub(crate) fn near_pairs<R: Real>(model: &Model<R>, placed: &[PlacedShape<R>]) -> usize {
    let near = |pair: &&Pair<R>| {
        let [far, reach] = bounds((), model, model.h, pair, placed);
        far <= reach
    };
    model.pairs.iter().filter(near).count()
}

impl<S: Scalar> Solver<'_, S> {
    /// Finds the points that may carry an impulse and sets their rows up. Returns how many there are, and in which
    /// lanes there are any and any that push a joint with a stop.
    #[inline(never)]
    pub(crate) fn set_up(
        &mut self,
        simd: S::Simd,
        model: &Model<S::Real>,
        points: &mut [S],
        rolling_impulses: &mut [S],
    ) -> (usize, [S::Mask; 2]) {
        S::vectorize(
            simd,
            #[inline(always)]
            || self.set_up_all(simd, model, points, rolling_impulses),
        )
    }

    #[inline(always)]
    fn set_up_all(
        &mut self,
        simd: S::Simd,
        model: &Model<S::Real>,
        points: &mut [S],
        rolling_impulses: &mut [S],
    ) -> (usize, [S::Mask; 2]) {
        let zero = S::splat(simd, S::Real::from_f64(0.0));
        let mut count = 0;
        let mut touched = [zero.lt(zero); 2];
        for mask in self.on_grounds.iter_mut() {
            *mask = zero.lt(zero);
        }
        for group in &model.groups {
            // In which lanes a group's spheres are near: in the others its pairs are not looked at.
            let within = group
                .clusters
                .map(|[a, b]| self.live & spheres_near(simd, model, self.h, &self.spheres[a], &self.spheres[b]));
            if within.is_some_and(|within| !within.any()) {
                forget_group(simd, model, group, points, rolling_impulses);
                continue;
            }
            for (p, pair) in model.pairs[group.pairs.clone()].iter().enumerate() {
                let own = &mut points[POINT_WORDS * pair.point..POINT_WORDS * (pair.point + pair.points)];
                let number = group.pairs.start + p;
                count = self.set_up_pair(simd, model, number, within, own, rolling_impulses, count, &mut touched);
            }
        }
        (count, touched)
    }

    /// The points of one pair, in the lanes of its group that are near. Returns how many are active now.
    #[inline(always)]
    fn set_up_pair(
        &mut self,
        simd: S::Simd,
        model: &Model<S::Real>,
        p: usize,
        within: Option<S::Mask>,
        own: &mut [S],
        rolling_impulses: &mut [S],
        mut count: usize,
        touched: &mut [S::Mask; 2],
    ) -> usize {
        // Broad phase: most pairs are far apart, and cost one distance. Every way out of here writes the words of all
        // points, or an impulse of an earlier step would start a later contact.
        let pair = &model.pairs[p];
        let [far, reach] = bounds(simd, model, self.h, pair, self.placed);
        // Overlapping bounds do not imply a contact of the surfaces.
        let (mut near, mut far) = (self.live & far.le(reach), far.max(S::splat(simd, S::Real::from_f64(0.0))));
        if let Some(within) = within {
            near = near & within;
            far = S::select(within, far, unknown_gap(simd));
        }
        if !near.any() {
            for (index, words) in own.chunks_exact_mut(POINT_WORDS).enumerate() {
                forget_point(words, rolling_words(pair, index, rolling_impulses), far);
            }
            return count;
        }
        let boxes = halves_of_boxes(model, pair);
        if let Some(halves) = boxes {
            let places = pair.colliders.map(|collider| &self.placed[collider]);
            far = S::select(near, find_boxes(simd, places, halves, self.manifold), far);
            hand_over(self.manifold, own);
        }
        for (index, words) in own.chunks_exact_mut(POINT_WORDS).enumerate() {
            let rolling = rolling_words(pair, index, rolling_impulses);
            let point = match boxes {
                Some(_) => self.manifold[index],
                None => find(simd, model, pair, self.placed, index),
            };
            let candidate = self.gap_and_mask(simd, model, pair, &point, near, far);
            if !candidate.mask.any() {
                forget_point(words, rolling, candidate.gap);
                continue;
            }
            let old = scale([words[0], words[1], words[2]], self.share);
            match &pair.soft {
                None => self.normal_block(simd, model, pair, index, &candidate, old),
                Some(soft) => self.soft_block(simd, model, (pair, soft), index, &candidate, old),
            }
            if pair.restitution.is_some() {
                self.bounce(simd, model, pair, index, &candidate);
            }
            if let [x, y, z] = *rolling {
                self.rolling_block(simd, model, pair, index, scale([x, y, z], self.share));
            }
            touched[0] = touched[0] | candidate.mask;
            if pair.at_stops {
                touched[1] = touched[1] | candidate.mask;
            }
            for ground in pair.grounds.into_iter().flatten() {
                let mask = &mut self.on_grounds[usize::from(ground)];
                *mask = *mask | candidate.mask;
            }
            if pair.is_pyramid {
                self.pyramids += 1;
                self.active[model.points - self.pyramids] = (p as u16, index as u16);
            } else {
                self.active[count] = (p as u16, index as u16);
                count += 1;
            }
        }
        count
    }

    /// Returns one contact point, and the lanes in which it may carry an impulse. `far` is the distance of
    /// the pair's bounds, stored as the gap in lanes without a computed one.
    #[inline(always)]
    fn gap_and_mask(
        &self,
        simd: S::Simd,
        model: &Model<S::Real>,
        pair: &Pair<S::Real>,
        point: &Point<S>,
        near: S::Mask,
        far: S,
    ) -> Candidate<S> {
        let zero = S::splat(simd, S::Real::from_f64(0.0));
        let margin = S::splat(simd, model.margin);
        let links = links_of_pair(model, pair);
        let velocity = sub(
            velocity_at(simd, links[0], self.work, point.position),
            velocity_at(simd, links[1], self.work, point.position),
        );
        // Speculative contact: the point counts when gap + h v_n, its predicted gap at the end of the step, is below
        // the margin. A fast shape is then stopped before it is inside. A separating velocity does not count,
        // because contacts pushed by others may need the point all the same.
        let closing = dot(velocity, point.normal).min(zero);
        let ahead = point.gap + self.h * closing;
        let within = match &pair.soft {
            None => ahead.lt(margin),
            Some(soft) => soft.counts(simd, margin, [point.gap, ahead], pair.is_pyramid),
        };
        let mask = near & point.valid & within;
        // The memory of a lane must not depend on its neighbors.
        let gap = S::select(near & point.valid, point.gap, far);
        Candidate { point: *point, velocity, mask, gap }
    }

    /// Sets up the normal and friction rows of a point and starts them from the impulse `old` of the last step, given in
    /// the world's axes.
    #[inline(always)]
    fn normal_block(
        &mut self,
        simd: S::Simd,
        model: &Model<S::Real>,
        pair: &Pair<S::Real>,
        index: usize,
        candidate: &Candidate<S>,
        old: [S; 3],
    ) {
        let zero = S::splat(simd, S::Real::from_f64(0.0));
        let one = S::splat(simd, S::Real::from_f64(1.0));
        let h = self.h;
        let Candidate { point, velocity: v, .. } = *candidate;
        let [t1, t2] = tangents(point.normal);
        let axes = [point.normal, t1, t2];
        let n = pair.reach.dofs.len();
        let rows = &mut self.rows[pair.row + index * n..pair.row + (index + 1) * n];
        let load = Load::Forces(point.position);
        let response =
            write_rows(simd, model, pair, self.work, self.roots, self.inverse_sqrt_inertia, load, &axes, rows);

        // The normal law is f = max(0, -k (gap + h v+) - d v+), with v+ the velocity after the step. As a row of impulses
        // l = h f it is v+ + l / (h r) + k gap / r = 0 where it pushes, with the rate r = h k + d. The second term is
        // `compliance`, the third `offset`. Implicit in v+, so that stiff contacts of light bodies gain no energy.
        // Above the surface only the spring at the end of the step counts, below it also the damper.
        let stiffness = h * S::splat(simd, pair.stiffness);
        let touching = point.gap.le(zero);
        let rate = S::select(touching, stiffness + S::splat(simd, pair.damping), stiffness);
        let law = ConeLaw {
            compliance: one / (h * rate),
            offset: point.gap * S::splat(simd, pair.stiffness) / rate,
            slip: S::splat(simd, model.friction_compliance),
            velocity: [dot(v, axes[0]), dot(v, axes[1]), dot(v, axes[2])],
        };
        let block = cone_block(simd, pair, candidate, &axes, response, &law, old);
        self.blocks[pair.point + index] = block;
        apply(&pair.reach.dofs, rows, block.impulse, block.mask, self.response);
    }

    /// Sets up the rolling rows of a point whose normal block is there: unit moments about the same axes, limited by
    /// `rolling_friction` [m] times the normal impulse.
    #[inline(always)]
    fn rolling_block(
        &mut self,
        simd: S::Simd,
        model: &Model<S::Real>,
        pair: &Pair<S::Real>,
        index: usize,
        old: [S; 3],
    ) {
        let Some(first) = pair.rolling else { return };
        let zero = S::splat(simd, S::Real::from_f64(0.0));
        let one = S::splat(simd, S::Real::from_f64(1.0));
        let links = links_of_pair(model, pair);
        let block = self.blocks[pair.point + index];
        let axes = block.axes;
        let turning = sub(spin(simd, links[0], self.work), spin(simd, links[1], self.work));
        let n = pair.reach.dofs.len();
        let rows = &mut self.rolling_rows[pair.rolling_row + index * n..pair.rolling_row + (index + 1) * n];
        let response =
            write_rows(simd, model, pair, self.work, self.roots, self.inverse_sqrt_inertia, Load::Moments, &axes, rows);
        let limit = S::splat(simd, pair.rolling_friction) * block.impulse[0];
        let wanted = cap([dot(old, axes[0]), dot(old, axes[1]), dot(old, axes[2])], limit);
        let impulse = select(block.mask, wanted, [zero; 3]);
        // About an axis that neither side can turn about a moment does nothing, and none is needed.
        let inverse = |a: S| S::select(a.gt(zero), one / a, zero);
        self.rolling[first + index] = Block {
            velocity: [dot(turning, axes[0]), dot(turning, axes[1]), dot(turning, axes[2])],
            impulse,
            response,
            inverse: [inverse(response[0]), inverse(response[1]), inverse(response[2])],
            ..block
        };
        apply(&pair.reach.dofs, rows, impulse, block.mask, self.response);
    }

    /// Writes the impulses into the state, as those of whole dynamics steps with the same forces.
    #[inline(always)]
    pub(crate) fn store(
        &self,
        simd: S::Simd,
        model: &Model<S::Real>,
        count: usize,
        points: &mut [S],
        rolling_impulses: &mut [S],
    ) {
        let zero = S::splat(simd, S::Real::from_f64(0.0));
        let whole = zero.constant(1.0) / self.share;
        let (round, pyramids) = (&self.active[..count], &self.active[model.points - self.pyramids..]);
        for &(p, index) in round.iter().chain(pyramids) {
            let (pair, index) = (&model.pairs[usize::from(p)], usize::from(index));
            let block = &self.blocks[pair.point + index];
            let words = &mut points[POINT_WORDS * (pair.point + index)..POINT_WORDS * (pair.point + index + 1)];
            let total = combine(&block.axes, scale(block.impulse, whole));
            for k in 0..3 {
                words[k] = S::select(block.mask, total[k], zero);
                words[4 + k] = S::select(block.mask, block.point[k], zero);
            }
            words[3] = block.impulse[0] * whole;
            // The gap at the end of the step: that is where the poses are, and what the force belongs to.
            let n = pair.reach.dofs.len();
            let rows = &self.rows[pair.row + index * n..pair.row + (index + 1) * n];
            let v = velocity(&pair.reach.dofs, rows, block.velocity, self.response);
            words[7] = S::select(block.mask, block.gap + self.h * v[0], block.gap);
            if let Some(first) = pair.rolling {
                let roll = &self.rolling[first + index];
                let total = combine(&roll.axes, scale(roll.impulse, whole));
                for k in 0..3 {
                    rolling_impulses[3 * (first + index) + k] = S::select(roll.mask, total[k], zero);
                }
            }
        }
    }
}

/// Returns the block of a point with a round cone of friction, with the impulse from which it starts.
#[inline(always)]
pub(crate) fn cone_block<S: Scalar>(
    simd: S::Simd,
    pair: &Pair<S::Real>,
    candidate: &Candidate<S>,
    axes: &[Vector<S>; 3],
    response: [S; 6],
    law: &ConeLaw<S>,
    old: [S; 3],
) -> Block<S> {
    let zero = S::splat(simd, S::Real::from_f64(0.0));
    let one = S::splat(simd, S::Real::from_f64(1.0));
    let Candidate { point, mask, gap, .. } = *candidate;
    let ConeLaw { compliance, offset, slip, velocity } = *law;
    // Warm start: the last step's impulse along the new axes, brought back into the friction cone |l_t| <= mu l_n.
    let friction = S::splat(simd, pair.friction);
    let normal = dot(old, axes[0]).max(zero);
    let across = cap([dot(old, axes[1]), dot(old, axes[2]), zero], friction * normal);
    let impulse = select(mask, [normal, across[0], across[1]], [zero; 3]);

    // Friction is the row v_t + slip l_t = 0 inside the cone. `slip` on the diagonal makes it regular. Sticking needs the
    // inverse of the 2 x 2 block, sliding a bound of its largest eigenvalue, max(a1, a2) + |a12| (Gershgorin).
    let (a1, a2) = (response[1] + slip, response[2] + slip);
    Block {
        mask,
        axes: *axes,
        velocity,
        impulse,
        response,
        inverse: [one / (response[0] + compliance); 3],
        slip,
        stick: [a1, a2, one / (a1 * a2 - response[5] * response[5])],
        slide: one / (a1.max(a2) + response[5].abs()),
        compliance,
        offset,
        gap,
        point: point.position,
    }
}

#[inline(always)]
fn combine<S: Scalar>(axes: &[Vector<S>; 3], x: [S; 3]) -> Vector<S> {
    add(add(scale(axes[0], x[0]), scale(axes[1], x[1])), scale(axes[2], x[2]))
}

/// A vector shortened to `limit` where it is longer.
#[inline(always)]
pub(crate) fn cap<S: Scalar>(x: [S; 3], limit: S) -> [S; 3] {
    let length = dot(x, x).sqrt();
    let over = length.gt(limit);
    let one = length.constant(1.0);
    scale(x, S::select(over, limit / S::select(over, length, one), one))
}
