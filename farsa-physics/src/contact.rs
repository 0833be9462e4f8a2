//! Contacts: found, set up as rows over the articulated factor, and solved together.
//!
//! Every contact point is a spring and damper along its normal and friction across it, both taken implicitly: the
//! impulse of a step is a function of the velocity *after* it. The velocities after it are those without contacts plus
//! the response of the articulated bodies to all impulses, which [`crate::tree::accelerations`] has already factorised:
//! a row `y` along the path from link to root gives every product `J M^-1 J^T` that is needed. Sweeps of projected
//! Gauss-Seidel over the points keep non-negative normal impulses and the friction cone exactly, and every impulse acts
//! equally and oppositely on both sides, whether the sweeps have converged or not.

use farsa_num::{Mask, Real, Scalar};

use crate::collision::{
    Placed, Point, ball_box, ball_plane, balls, corner, distance_to_box, edge, nearest_of_segments, nearest_on_segment,
    segment_box,
};
use crate::model::{Form, Model, POINT_WORDS, Pair};
use crate::spatial::{Spatial, Vector, add, dot, product, rotate, scale, select, splat, sub};
use crate::stop::{Stop, relax_stop};
use crate::tree::{LinkWork, Motion, Root, WORLD};

/// One contact point's block of three rows: normal, two tangents (or spin and two rolling axes).
#[derive(Clone, Copy, Debug)]
pub(crate) struct Block<S: Scalar> {
    pub(crate) mask: S::Mask,
    pub(crate) axes: [Vector<S>; 3],
    /// Relative velocity along the axes without contact impulses.
    pub(crate) velocity: [S; 3],
    pub(crate) impulse: [S; 3],
    /// `J M^-1 J^T` of the block: nn, 11, 22, n1, n2, 12.
    pub(crate) response: [S; 6],
    /// Reciprocals of the diagonal response: of the normal row, or of all three rolling rows.
    pub(crate) inverse: [S; 3],
    /// The tangents' diagonal and the reciprocal of their determinant.
    pub(crate) stick: [S; 3],
    pub(crate) slide: S,
    /// Compliance and offset of the normal law.
    pub(crate) compliance: S,
    pub(crate) offset: S,
    pub(crate) gap: S,
    pub(crate) point: Vector<S>,
}

impl<S: Scalar> Block<S> {
    pub(crate) fn new(simd: S::Simd) -> Self {
        let o = S::splat(simd, S::Real::of(0.0));
        Self {
            mask: o.lt(o),
            axes: [[o; 3]; 3],
            velocity: [o; 3],
            impulse: [o; 3],
            response: [o; 6],
            inverse: [o; 3],
            stick: [o; 3],
            slide: o,
            compliance: o,
            offset: o,
            gap: o,
            point: [o; 3],
        }
    }
}

/// The colliders in the world.
#[inline(always)]
pub(crate) fn place_colliders<S: Scalar>(
    simd: S::Simd,
    model: &Model<S::Real>,
    work: &[LinkWork<S>],
    out: &mut [Placed<S>],
) {
    for (c, o) in model.colliders.iter().zip(out) {
        let own = c.mount.rotation.map(|row| splat::<S>(simd, row));
        let offset = splat::<S>(simd, c.mount.position);
        *o = if c.mount.link == WORLD {
            Placed { rotation: own, position: offset, velocity: [S::splat(simd, S::Real::of(0.0)); 3] }
        } else {
            let w = &work[usize::from(c.mount.link)];
            let position = add(w.position, rotate(&w.rotation, offset));
            let velocity = w.acceleration.at(sub(position, w.reference));
            Placed { rotation: product(&w.rotation, &own), position, velocity }
        };
    }
}

/// How much faster than their centres the surfaces of two shapes may approach [m/s]: a shape of 3 cm at 50 rad/s.
const TURNING: f64 = 1.5;

/// Distance between a pair's bounds [m]; nothing can touch while it is positive.
#[inline(always)]
fn clearance<S: Scalar>(simd: S::Simd, model: &Model<S::Real>, pair: &Pair<S::Real>, placed: &[Placed<S>]) -> S {
    let [a, b] = pair.colliders;
    let (pa, pb) = (&placed[a], &placed[b]);
    let bound = S::splat(simd, model.colliders[a].bound);
    match model.colliders[b].form {
        Form::Plane => dot(sub(pa.position, pb.position), pb.axis()) - bound,
        Form::Block { half } => distance_to_box(pa.position, pb, splat::<S>(simd, half)) - bound,
        _ => {
            let d = sub(pa.position, pb.position);
            dot(d, d).sqrt() - bound - S::splat(simd, model.colliders[b].bound)
        }
    }
}

/// For an edge of a box against a box: the distance left between the edge and the other's bound [m].
#[inline(always)]
fn edge_distance<S: Scalar>(
    simd: S::Simd,
    model: &Model<S::Real>,
    pair: &Pair<S::Real>,
    placed: &[Placed<S>],
    index: usize,
) -> Option<S> {
    let [a, b] = pair.colliders;
    match (model.colliders[a].form, model.colliders[b].form) {
        (Form::Block { .. }, Form::Block { half }) if index >= 8 => {
            let (middle, direction, length) = edge(&placed[b], splat::<S>(simd, half), index - 8);
            let near = nearest_on_segment(middle, direction, length, placed[a].position);
            let d = sub(near, placed[a].position);
            Some(dot(d, d).sqrt() - S::splat(simd, model.colliders[a].bound))
        }
        _ => None,
    }
}

/// Contact point `index` of a pair.
#[inline(always)]
fn find<S: Scalar>(
    simd: S::Simd,
    model: &Model<S::Real>,
    pair: &Pair<S::Real>,
    placed: &[Placed<S>],
    index: usize,
) -> Point<S> {
    let k = |x: S::Real| S::splat(simd, x);
    let [a, b] = pair.colliders;
    let (pa, pb) = (&placed[a], &placed[b]);
    let end = |half: S::Real| {
        let h = k(half);
        add(pa.position, scale(pa.axis(), if index == 0 { -h } else { h }))
    };
    match (model.colliders[a].form, model.colliders[b].form) {
        (Form::Ball { radius: ra }, Form::Ball { radius: rb }) => balls(pa.position, k(ra), pb.position, k(rb)),
        (Form::Ball { radius: ra }, Form::Capsule { radius: rb, half_length }) => {
            let near = nearest_on_segment(pb.position, pb.axis(), k(half_length), pa.position);
            balls(pa.position, k(ra), near, k(rb))
        }
        (Form::Ball { radius }, Form::Block { half }) => ball_box(pa.position, k(radius), pb, splat::<S>(simd, half)),
        (Form::Ball { radius }, Form::Plane) => ball_plane(pa.position, k(radius), pb),
        (Form::Capsule { radius: ra, half_length: la }, Form::Capsule { radius: rb, half_length: lb }) => {
            let (na, nb) = nearest_of_segments(pa.position, pa.axis(), k(la), pb.position, pb.axis(), k(lb));
            balls(na, k(ra), nb, k(rb))
        }
        (Form::Capsule { radius, half_length }, Form::Block { half }) => {
            let half = splat::<S>(simd, half);
            if index < 2 {
                ball_box(end(half_length), k(radius), pb, half)
            } else {
                segment_box(pa.position, pa.axis(), k(half_length), k(radius), pb, half)
            }
        }
        (Form::Capsule { radius, half_length }, _) => ball_plane(end(half_length), k(radius), pb),
        (Form::Block { half: ha }, Form::Block { half: hb }) => {
            let zero = k(S::Real::of(0.0));
            let (ha, hb) = (splat::<S>(simd, ha), splat::<S>(simd, hb));
            if index < 8 {
                ball_box(corner(pa, ha, index), zero, pb, hb)
            } else {
                let (middle, direction, length) = edge(pb, hb, index - 8);
                let mut found = segment_box(middle, direction, length, zero, pa, ha);
                found.normal = scale(found.normal, k(S::Real::of(-1.0)));
                found
            }
        }
        (Form::Block { half }, _) => ball_plane(corner(pa, splat::<S>(simd, half), index), k(S::Real::of(0.0)), pb),
        (Form::Plane, _) => ball_plane(pa.position, k(S::Real::of(0.0)), pb),
    }
}

/// Two unit vectors across a unit normal, without a branch [Duff2017].
#[inline(always)]
fn tangents<S: Scalar>(n: Vector<S>) -> [Vector<S>; 2] {
    let one = n[0].constant(1.0);
    let sign = S::select(n[2].lt(n[0].constant(0.0)), -one, one);
    let a = -(one / (sign + n[2]));
    let b = n[0] * n[1] * a;
    [[one + sign * n[0] * n[0] * a, sign * b, -(sign * n[0])], [b, sign + n[1] * n[1] * a, -n[1]]]
}

/// Predicted velocity of a collider's point.
#[inline(always)]
fn velocity_at<S: Scalar>(simd: S::Simd, link: u16, work: &[LinkWork<S>], point: Vector<S>) -> Vector<S> {
    if link == WORLD {
        return [S::splat(simd, S::Real::of(0.0)); 3];
    }
    let w = &work[usize::from(link)];
    w.acceleration.at(sub(point, w.reference))
}

/// Predicted angular velocity of a link.
#[inline(always)]
fn spin<S: Scalar>(simd: S::Simd, link: u16, work: &[LinkWork<S>]) -> Vector<S> {
    if link == WORLD { [S::splat(simd, S::Real::of(0.0)); 3] } else { work[usize::from(link)].acceleration.angular }
}

/// Three unit forces on the links of a path.
type Pull<S> = [Spatial<S>; 3];

/// Carries three forces over one link towards its root: writes the row entries and returns how many.
#[inline(always)]
fn climb<S: Scalar>(
    model: &Model<S::Real>,
    link: u16,
    work: &[LinkWork<S>],
    roots: &[Root<S>],
    root_of: &[S],
    p: &mut Pull<S>,
    out: &mut [[S; 3]],
) -> usize {
    let l = &model.links[usize::from(link)];
    if l.motion == Motion::Floating {
        for k in 0..3 {
            let y = roots[usize::from(l.root)].factor.half(p[k]);
            for (o, y) in out.iter_mut().zip(y) {
                o[k] = y;
            }
        }
        return 6;
    }
    let w = &work[usize::from(link)];
    let root = root_of[usize::from(l.dof)];
    for k in 0..3 {
        let y = w.subspace.dot(p[k]);
        out[0][k] = y * root;
        p[k] = p[k] - w.column.scale(y * w.reciprocal);
    }
    1
}

/// Which unit loads the rows of a block are.
#[derive(Clone, Copy)]
enum Load<S> {
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
    work: &[LinkWork<S>],
    load: Load<S>,
    axes: &[Vector<S>; 3],
) -> Pull<S> {
    let zero = Spatial::zero(simd);
    let link = model.colliders[collider].mount.link;
    if link == WORLD {
        return [zero; 3];
    }
    match load {
        Load::Moments => axes.map(|axis| Spatial { angular: axis, linear: zero.linear }),
        Load::Forces(point) => {
            let arm = sub(point, work[usize::from(link)].reference);
            [Spatial::force_at(arm, axes[0]), Spatial::force_at(arm, axes[1]), Spatial::force_at(arm, axes[2])]
        }
    }
}

/// Writes the rows of three unit forces (or moments) on both sides of a pair, and their response.
#[inline(always)]
fn write_rows<S: Scalar>(
    simd: S::Simd,
    model: &Model<S::Real>,
    pair: &Pair<S::Real>,
    work: &[LinkWork<S>],
    roots: &[Root<S>],
    root_of: &[S],
    load: Load<S>,
    axes: &[Vector<S>; 3],
    rows: &mut [[S; 3]],
) -> [S; 6] {
    let reach = &pair.reach;
    let minus = S::splat(simd, S::Real::of(-1.0));
    let first_entries = reach.dofs.len() - reach.second.iter().map(|l| entries(model, *l)).sum::<usize>();
    let other = pull(simd, model, pair.colliders[1], work, load, axes);
    let mut other = [other[0].scale(minus), other[1].scale(minus), other[2].scale(minus)];
    let mut at = first_entries;
    for &link in &reach.second {
        at += climb(model, link, work, roots, root_of, &mut other, &mut rows[at..]);
    }
    let mut p = pull(simd, model, pair.colliders[0], work, load, axes);
    let mut at = 0;
    for (i, &link) in reach.first.iter().enumerate() {
        if i == reach.meet {
            for k in 0..3 {
                p[k] += other[k];
            }
        }
        at += climb(model, link, work, roots, root_of, &mut p, &mut rows[at..]);
    }
    let mut a = [S::splat(simd, S::Real::of(0.0)); 6];
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

/// The parts of the scratch that the contact solver uses.
pub(crate) struct Solver<'a, S: Scalar> {
    pub(crate) placed: &'a [Placed<S>],
    pub(crate) work: &'a [LinkWork<S>],
    pub(crate) roots: &'a [Root<S>],
    /// Square roots of the reciprocals of the joints' articulated inertias [dofs].
    pub(crate) root_of: &'a [S],
    pub(crate) blocks: &'a mut [Block<S>],
    pub(crate) rolling: &'a mut [Block<S>],
    pub(crate) rows: &'a mut [[S; 3]],
    pub(crate) rolling_rows: &'a mut [[S; 3]],
    /// Response of all impulses so far, in the factor's coordinates [dofs].
    pub(crate) response: &'a mut [S],
    /// Pair and point of the active points.
    pub(crate) active: &'a mut [(u16, u16)],
    pub(crate) stops: &'a mut [Stop<S>],
    pub(crate) stop_rows: &'a [S],
}

impl<S: Scalar> Solver<'_, S> {
    /// Finds the points that may carry an impulse and sets their rows up; returns how many there are and
    /// in which lanes there are any,
    /// and any that push a joint with a stop.
    #[inline(always)]
    pub(crate) fn set_up(
        &mut self,
        simd: S::Simd,
        model: &Model<S::Real>,
        points: &mut [S],
        turns: &mut [S],
    ) -> (usize, [S::Mask; 2]) {
        let zero = S::splat(simd, S::Real::of(0.0));
        let one = S::splat(simd, S::Real::of(1.0));
        let h = S::splat(simd, model.h);
        let margin = S::splat(simd, model.margin);
        let mut count = 0;
        let mut touched = [zero.lt(zero); 2];
        for (p, pair) in model.pairs.iter().enumerate() {
            let own = &mut points[POINT_WORDS * pair.point..POINT_WORDS * (pair.point + pair.points)];
            let far = clearance(simd, model, pair, self.placed);
            // The bounds close by the centres' relative velocity, and a little more for turning.
            let [a, b] = pair.colliders;
            let approach = sub(self.placed[a].velocity, self.placed[b].velocity);
            let reach = margin + h * (dot(approach, approach).sqrt() + h.constant(TURNING));
            let near = far.le(reach);
            // Overlapping bounds say nothing of the surfaces.
            let far = far.max(zero);
            if !near.any() {
                for w in own.chunks_exact_mut(POINT_WORDS) {
                    forget(w, zero, far);
                }
                if let Some(first) = pair.rolling {
                    for w in &mut turns[3 * first..3 * (first + pair.points)] {
                        *w = zero;
                    }
                }
                continue;
            }
            let links = pair.colliders.map(|c| model.colliders[c].mount.link);
            for (index, words) in own.chunks_exact_mut(POINT_WORDS).enumerate() {
                let near = match edge_distance(simd, model, pair, self.placed, index) {
                    Some(distance) => near & distance.le(reach),
                    None => near,
                };
                if !near.any() {
                    forget(words, zero, far);
                    continue;
                }
                let point = find(simd, model, pair, self.placed, index);
                let v = sub(
                    velocity_at(simd, links[0], self.work, point.position),
                    velocity_at(simd, links[1], self.work, point.position),
                );
                let closing = dot(v, point.normal).min(zero);
                let mask = near & point.valid & (point.gap + h * closing).lt(margin);
                // What a lane remembers must not depend on its neighbours.
                let gap = S::select(near & point.valid, point.gap, far);
                if !mask.any() {
                    forget(words, zero, gap);
                    if let Some(first) = pair.rolling {
                        for w in &mut turns[3 * (first + index)..3 * (first + index + 1)] {
                            *w = zero;
                        }
                    }
                    continue;
                }
                let [t1, t2] = tangents(point.normal);
                let axes = [point.normal, t1, t2];
                let i = pair.point + index;
                let n = pair.reach.dofs.len();
                let rows = &mut self.rows[pair.row + index * n..pair.row + (index + 1) * n];
                let response = write_rows(
                    simd,
                    model,
                    pair,
                    self.work,
                    self.roots,
                    self.root_of,
                    Load::Forces(point.position),
                    &axes,
                    rows,
                );
                // Above the surface only the spring at the end of the step counts, below it also the damper.
                let stiffness = h * S::splat(simd, pair.stiffness);
                let touching = point.gap.le(zero);
                let rate = S::select(touching, stiffness + S::splat(simd, pair.damping), stiffness);
                let compliance = one / (h * rate);
                let offset = point.gap * S::splat(simd, pair.stiffness) / rate;
                let old = [words[0], words[1], words[2]];
                let slip = S::splat(simd, model.slip);
                let friction = S::splat(simd, pair.friction);
                let normal = dot(old, axes[0]).max(zero);
                let across = cap([dot(old, axes[1]), dot(old, axes[2]), zero], friction * normal);
                let impulse = [normal, across[0], across[1]].map(|x| S::select(mask, x, zero));
                let (a1, a2) = (response[1] + slip, response[2] + slip);
                self.blocks[i] = Block {
                    mask,
                    axes,
                    velocity: [dot(v, axes[0]), dot(v, axes[1]), dot(v, axes[2])],
                    impulse,
                    response,
                    inverse: [one / (response[0] + compliance); 3],
                    stick: [a1, a2, one / (a1 * a2 - response[5] * response[5])],
                    slide: one / (a1.max(a2) + response[5].abs()),
                    compliance,
                    offset,
                    gap,
                    point: point.position,
                };
                apply(&pair.reach.dofs, rows, impulse, mask, self.response);
                if let Some(first) = pair.rolling {
                    let turning = sub(spin(simd, links[0], self.work), spin(simd, links[1], self.work));
                    let rows = &mut self.rolling_rows[pair.rolling_row + index * n..pair.rolling_row + (index + 1) * n];
                    let response =
                        write_rows(simd, model, pair, self.work, self.roots, self.root_of, Load::Moments, &axes, rows);
                    let words = &turns[3 * (first + index)..3 * (first + index) + 3];
                    let old = [words[0], words[1], words[2]];
                    let limit = S::splat(simd, pair.rolling_friction) * impulse[0];
                    let impulse = cap([dot(old, axes[0]), dot(old, axes[1]), dot(old, axes[2])], limit)
                        .map(|x| S::select(mask, x, zero));
                    self.rolling[first + index] = Block {
                        velocity: [dot(turning, axes[0]), dot(turning, axes[1]), dot(turning, axes[2])],
                        impulse,
                        response,
                        inverse: [one / response[0], one / response[1], one / response[2]],
                        ..self.blocks[i]
                    };
                    apply(&pair.reach.dofs, rows, impulse, mask, self.response);
                }
                touched[0] = touched[0] | mask;
                if pair.at_stops {
                    touched[1] = touched[1] | mask;
                }
                self.active[count] = (p as u16, index as u16);
                count += 1;
            }
        }
        (count, touched)
    }

    /// Sweeps over the active points, forwards and backwards in turn, and over the stops.
    #[inline(always)]
    pub(crate) fn sweep(&mut self, simd: S::Simd, model: &Model<S::Real>, count: usize, stops: usize) {
        for round in 0..model.sweeps {
            for k in 0..count {
                let (p, index) = self.active[if round % 2 == 0 { k } else { count - 1 - k }];
                self.relax(simd, model, usize::from(p), usize::from(index));
            }
            for stop in &mut self.stops[..stops] {
                relax_stop(simd, model, stop, self.stop_rows, self.response);
            }
        }
    }

    /// Brings one point's impulse to its law, given all others.
    #[inline(always)]
    fn relax(&mut self, simd: S::Simd, model: &Model<S::Real>, pair: usize, index: usize) {
        let pair = &model.pairs[pair];
        let dofs = &pair.reach.dofs;
        let n = dofs.len();
        let zero = S::splat(simd, S::Real::of(0.0));
        let slip = S::splat(simd, model.slip);
        let block = &mut self.blocks[pair.point + index];
        let rows = &self.rows[pair.row + index * n..pair.row + (index + 1) * n];
        let mut v = velocity(dofs, rows, block.velocity, self.response);
        let [_, _, _, a01, a02, a12] = block.response;
        let old = block.impulse;
        let normal = (old[0] - (v[0] + block.compliance * old[0] + block.offset) * block.inverse[0]).max(zero);
        let d0 = normal - old[0];
        v[1] += a01 * d0;
        v[2] += a02 * d0;
        // Sticking solves both tangents at once; sliding steps against the velocity, alike in all directions.
        let limit = S::splat(simd, pair.friction) * normal;
        let (w1, w2) = (v[1] + slip * old[1], v[2] + slip * old[2]);
        let stick = [
            old[1] - (block.stick[1] * w1 - a12 * w2) * block.stick[2],
            old[2] - (block.stick[0] * w2 - a12 * w1) * block.stick[2],
            zero,
        ];
        let slide = [old[1] - w1 * block.slide, old[2] - w2 * block.slide, zero];
        let holds = dot(stick, stick).le(limit * limit);
        let across = select(holds, stick, cap(slide, limit));
        let new = [normal, across[0], across[1]].map(|x| S::select(block.mask, x, zero));
        block.impulse = new;
        apply(dofs, rows, sub(new, old), block.mask, self.response);
        if let Some(first) = pair.rolling {
            let limit = S::splat(simd, pair.rolling_friction) * new[0];
            let block = &mut self.rolling[first + index];
            let rows = &self.rolling_rows[pair.rolling_row + index * n..pair.rolling_row + (index + 1) * n];
            let v = velocity(dofs, rows, block.velocity, self.response);
            let old = block.impulse;
            let wanted = [0, 1, 2].map(|k: usize| old[k] - v[k] * block.inverse[k]);
            let new = cap(wanted, limit).map(|x| S::select(block.mask, x, zero));
            block.impulse = new;
            apply(dofs, rows, sub(new, old), block.mask, self.response);
        }
    }

    /// Writes the impulses into the state.
    #[inline(always)]
    pub(crate) fn store(&self, simd: S::Simd, model: &Model<S::Real>, count: usize, points: &mut [S], turns: &mut [S]) {
        let zero = S::splat(simd, S::Real::of(0.0));
        for &(p, index) in &self.active[..count] {
            let (pair, index) = (&model.pairs[usize::from(p)], usize::from(index));
            let block = &self.blocks[pair.point + index];
            let words = &mut points[POINT_WORDS * (pair.point + index)..POINT_WORDS * (pair.point + index + 1)];
            let total = combine(&block.axes, block.impulse);
            for k in 0..3 {
                words[k] = S::select(block.mask, total[k], zero);
                words[4 + k] = S::select(block.mask, block.point[k], zero);
            }
            words[3] = block.impulse[0];
            // The gap at the end of the step: that is where the poses are, and what the force belongs to.
            let n = pair.reach.dofs.len();
            let rows = &self.rows[pair.row + index * n..pair.row + (index + 1) * n];
            let v = velocity(&pair.reach.dofs, rows, block.velocity, self.response);
            words[7] = S::select(block.mask, block.gap + S::splat(simd, model.h) * v[0], block.gap);
            if let Some(first) = pair.rolling {
                let roll = &self.rolling[first + index];
                let total = combine(&roll.axes, roll.impulse);
                for k in 0..3 {
                    turns[3 * (first + index) + k] = S::select(roll.mask, total[k], zero);
                }
            }
        }
    }
}

/// The state words of a point that carries nothing.
#[inline(always)]
fn forget<S: Scalar>(words: &mut [S], zero: S, gap: S) {
    for w in words.iter_mut() {
        *w = zero;
    }
    words[7] = gap;
}

#[inline(always)]
fn combine<S: Scalar>(axes: &[Vector<S>; 3], x: [S; 3]) -> Vector<S> {
    add(add(scale(axes[0], x[0]), scale(axes[1], x[1])), scale(axes[2], x[2]))
}

/// A vector shortened to `limit` where it is longer.
#[inline(always)]
fn cap<S: Scalar>(x: [S; 3], limit: S) -> [S; 3] {
    let length = dot(x, x).sqrt();
    let over = length.gt(limit);
    let one = length.constant(1.0);
    scale(x, S::select(over, limit / S::select(over, length, one), one))
}

/// The relative velocity of a block under the response so far.
#[inline(always)]
fn velocity<S: Scalar>(dofs: &[u16], rows: &[[S; 3]], mut v: [S; 3], response: &[S]) -> [S; 3] {
    for (&d, y) in dofs.iter().zip(rows) {
        let z = response[usize::from(d)];
        v[0] += y[0] * z;
        v[1] += y[1] * z;
        v[2] += y[2] * z;
    }
    v
}

/// Adds a block's change of impulse to the response.
#[inline(always)]
fn apply<S: Scalar>(dofs: &[u16], rows: &[[S; 3]], change: [S; 3], mask: S::Mask, response: &mut [S]) {
    for (&d, y) in dofs.iter().zip(rows) {
        let z = &mut response[usize::from(d)];
        *z = S::select(mask, *z + (y[0] * change[0] + y[1] * change[1] + y[2] * change[2]), *z);
    }
}

#[cfg(test)]
#[path = "contact_oracles.rs"]
mod oracles;
