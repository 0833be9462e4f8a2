//! One control step: efforts, articulated bodies, contacts, integration, at every dynamics step.

use alloc::vec;
use alloc::vec::Vec;

use farsa_body::actuators::clamp_command;
use farsa_num::{Mask as _, Real, Scalar};

use crate::articulated::boxes::BOX_POINTS;
use crate::articulated::collision::{PlacedShape, Point};
use crate::articulated::contact::place_colliders;
use crate::articulated::external::Wrenches;
use crate::articulated::ground::{Rubbing, hold, set_up_grounds};
use crate::articulated::group::{Sphere, place_spheres};
use crate::articulated::halves::{fast_lanes, remember, take_back};
use crate::articulated::joint_laws::{JointMotion, store_joint_rows};
use crate::articulated::joint_row::JointRow;
use crate::articulated::link::{LinkData, Motion, WORLD};
use crate::articulated::model::{Model, POINT_WORDS};
use crate::articulated::solver::{Block, Solver};
use crate::articulated::spatial::{Spatial, Vector, add, matrix_of, rotate, scale, splat, sub};
use crate::articulated::stop::{Stop, set_up_stops};
use crate::articulated::tree::{Root, accelerations, forward_kinematics};

/// Temporary results of a step. You create this once for a model and reuse it for every step.
#[derive(Clone, Debug)]
pub struct Scratch<S: Scalar> {
    /// The present step's share of a whole dynamics step, one or a half, and the lanes that make it.
    share: S,
    live: S::Mask,
    /// The state between the halves of a dynamics step, for the lanes that made it whole.
    between: Vec<S>,
    pub(crate) links: Vec<LinkData<S>>,
    pub(crate) roots: Vec<Root<S>>,
    tau: Vec<S>,
    diagonal: Vec<S>,
    pub(crate) qdd: Vec<S>,
    inverse_sqrt_inertia: Vec<S>,
    response: Vec<S>,
    pub(crate) placed: Vec<PlacedShape<S>>,
    spheres: Vec<Sphere<S>>,
    manifold: [Point<S>; BOX_POINTS],
    blocks: Vec<Block<S>>,
    rolling: Vec<Block<S>>,
    rows: Vec<[S; 3]>,
    rolling_rows: Vec<[S; 3]>,
    active: Vec<(u16, u16)>,
    stops: Vec<Stop<S>>,
    stop_rows: Vec<S>,
    on_grounds: Vec<S::Mask>,
    rubbing: Vec<Rubbing<S>>,
    joint_rows: Vec<JointRow<S>>,
}

impl<S: Scalar> Scratch<S> {
    /// Allocates the results for a model.
    pub fn new(simd: S::Simd, model: &Model<S::Real>) -> Self {
        let zero = S::splat(simd, S::Real::from_f64(0.0));
        Self {
            share: S::splat(simd, S::Real::from_f64(1.0)),
            live: zero.le(zero),
            between: vec![zero; model.state_len()],
            links: vec![LinkData::new(simd); model.links.len()],
            roots: vec![Root::new(simd); model.roots],
            tau: vec![zero; model.dofs],
            diagonal: vec![zero; model.dofs],
            qdd: vec![zero; model.dofs],
            inverse_sqrt_inertia: vec![zero; model.dofs],
            response: vec![zero; model.dofs],
            placed: vec![PlacedShape::new(simd); model.colliders.len()],
            spheres: vec![Sphere::new(simd); model.clusters.len()],
            manifold: [Point::new(simd); BOX_POINTS],
            blocks: vec![Block::new(simd); model.points],
            rolling: vec![Block::new(simd); model.rolling],
            rows: vec![[zero; 3]; model.row_entries],
            rolling_rows: vec![[zero; 3]; model.rolling_entries],
            active: vec![(0, 0); model.points],
            stops: vec![Stop::new(simd); model.links.len()],
            stop_rows: vec![zero; model.stop_entries],
            on_grounds: vec![zero.lt(zero); model.grounds.len()],
            rubbing: vec![Rubbing::new(simd); model.grounds.len()],
            joint_rows: vec![JointRow::new(simd); model.joint_laws.len()],
        }
    }

    /// Gets the links in their current places, for the kernels of [`crate::articulated`]. Call
    /// [`Scratch::forward_kinematics`] or make a step first.
    pub fn links(&mut self) -> &mut [LinkData<S>] {
        &mut self.links
    }

    /// Gets the links and the factors of the floating ones, for [`crate::articulated::accelerations`].
    pub fn parts(&mut self) -> (&mut [LinkData<S>], &mut [Root<S>]) {
        (&mut self.links, &mut self.roots)
    }

    /// Computes the places of the links from `state` [`Model::state_len`]. You need to call this once before the first
    /// step and whenever the state was changed from outside.
    #[inline(always)]
    pub fn forward_kinematics(&mut self, simd: S::Simd, model: &Model<S::Real>, state: &[S]) {
        let (q, rest) = state.split_at(model.positions);
        place_links(simd, model, q, rest, &mut self.links);
    }
}

/// Precision of a [`crate::articulated::World`]. Use `f32` for speed and `f64` as a reference.
///
/// The step is compiled here, once for each, and not again in every crate that steps a world.
pub trait Precision: Real {
    /// [`step`] for one world, under external forces, which are then discarded.
    fn step(model: &Model<Self>, state: &mut [Self], scratch: &mut Scratch<Self>, forces: &mut Wrenches<Self>);
    /// [`Scratch::forward_kinematics`] for one world.
    fn forward_kinematics(model: &Model<Self>, state: &[Self], scratch: &mut Scratch<Self>);
}

impl Precision for f32 {
    fn step(model: &Model<f32>, state: &mut [f32], scratch: &mut Scratch<f32>, forces: &mut Wrenches<f32>) {
        step_one(model, state, scratch, forces);
    }
    fn forward_kinematics(model: &Model<f32>, state: &[f32], scratch: &mut Scratch<f32>) {
        scratch.forward_kinematics((), model, state);
    }
}

impl Precision for f64 {
    fn step(model: &Model<f64>, state: &mut [f64], scratch: &mut Scratch<f64>, forces: &mut Wrenches<f64>) {
        step_one(model, state, scratch, forces);
    }
    fn forward_kinematics(model: &Model<f64>, state: &[f64], scratch: &mut Scratch<f64>) {
        scratch.forward_kinematics((), model, state);
    }
}

/// The parts of a state.
pub(crate) struct Parts<'a, S> {
    pub(crate) q: &'a mut [S],
    pub(crate) v: &'a mut [S],
    pub(crate) commands: &'a mut [S],
    pub(crate) points: &'a mut [S],
    pub(crate) rolling_impulses: &'a mut [S],
    /// The impulses of joints.
    pub(crate) joint_impulses: &'a mut [S],
}

pub(crate) fn parts<'a, R: Real, S>(model: &Model<R>, state: &'a mut [S]) -> Parts<'a, S> {
    let (q, rest) = state.split_at_mut(model.positions);
    let (v, rest) = rest.split_at_mut(model.dofs);
    let (commands, rest) = rest.split_at_mut(2 * model.actuators.len());
    let (points, rest) = rest.split_at_mut(POINT_WORDS * model.points);
    let (rolling_impulses, joint_impulses) = rest.split_at_mut(3 * model.rolling);
    Parts { q, v, commands, points, rolling_impulses, joint_impulses }
}

/// Advances every lane of `state` [`Model::state_len`] by one control step.
///
/// `scratch` must have been made for the model, and [`Scratch::forward_kinematics`] called once since `state` was
/// changed from outside.
///
/// # Panics
/// If `state` is shorter than [`Model::state_len`], or `scratch` is another model's.
#[inline(always)]
pub fn step<S: Scalar>(simd: S::Simd, model: &Model<S::Real>, state: &mut [S], scratch: &mut Scratch<S>) {
    advance(simd, model, state, scratch, |_, _| {});
}

/// Makes one control step of one world under external forces, which act at every dynamics step and are then discarded.
#[inline(always)]
fn step_one<R: Real + Scalar<Real = R, Simd = ()>>(
    model: &Model<R>,
    state: &mut [R],
    scratch: &mut Scratch<R>,
    forces: &mut Wrenches<R>,
) {
    advance((), model, state, scratch, |state, scratch| {
        if forces.any() {
            push(model, state, scratch, forces);
        }
    });
    forces.clear();
}

/// Makes the dynamics steps of a control step, each after `before`: whole, or in halves in the lanes where a link is fast.
#[inline(always)]
fn advance<S: Scalar>(
    simd: S::Simd,
    model: &Model<S::Real>,
    state: &mut [S],
    s: &mut Scratch<S>,
    mut before: impl FnMut(&mut [S], &mut Scratch<S>),
) {
    let one = S::splat(simd, S::Real::from_f64(1.0));
    for &(word, range) in &model.command_ranges {
        state[word] = clamp_command(range, state[word]);
    }
    for _ in 0..model.substeps {
        let halved = fast_lanes(simd, model, &s.links);
        s.share = S::select(halved, one.constant(0.5), one);
        s.live = one.le(one);
        let parts = if halved.any() { 2 } else { 1 };
        for part in 0..parts {
            if part == 1 {
                s.live = halved;
                remember(simd, model, state, &mut s.between);
            }
            before(state, s);
            substep(simd, model, state, s);
            if part == 1 {
                take_back(simd, model, halved, &s.between, state);
            }
            let (q, rest) = state.split_at(model.positions);
            place_links(simd, model, q, rest, &mut s.links);
        }
    }
}

/// Adds to the velocities what the forces do in a dynamics step, or a half: `v += h M^-1 J^T f`.
///
/// Source: own (articulated bodies [Featherstone2008] table 7.1 without gravity and velocities, under the efforts `J^T f`).
/// The links of `scratch` must be placed, and are afterwards.
#[inline(never)]
fn push<R: Real + Scalar<Real = R, Simd = ()>>(
    model: &Model<R>,
    state: &mut [R],
    scratch: &mut Scratch<R>,
    forces: &mut Wrenches<R>,
) {
    let h = model.h * scratch.share;
    let (q, v) = state.split_at_mut(model.positions);
    let (links, roots) = scratch.parts();
    place_links((), model, q, &forces.zeros, links);
    forces.efforts(model, links);
    let Wrenches { tau, diagonal, qdd, .. } = forces;
    accelerate((), model, [R::from_f64(0.0); 3], tau, diagonal, links, roots, qdd);
    for (v, a) in v.iter_mut().zip(qdd) {
        *v += h * *a;
    }
    place_links((), model, q, v, links);
}

/// The large pieces are separate functions, which compile in a fraction of the time of one function.
#[inline(always)]
fn substep<S: Scalar>(simd: S::Simd, model: &Model<S::Real>, state: &mut [S], s: &mut Scratch<S>) {
    let zero = S::splat(simd, S::Real::from_f64(0.0));
    let h = S::splat(simd, model.h) * s.share;
    let state = parts(model, state);
    // Velocities without contacts: v += h qdd, with qdd from the articulated bodies, whose factor stays in `links` and
    // `roots` for the contacts.
    efforts(simd, model, h, state.q, state.v, state.commands, &mut s.tau, &mut s.diagonal);
    accelerate(simd, model, model.gravity, &s.tau, &s.diagonal, &mut s.links, &mut s.roots, &mut s.qdd);
    for (v, a) in state.v.iter_mut().zip(&s.qdd) {
        *v += h * *a;
    }
    // Contacts use the predicted velocities at the old places. Their rows are in the factor's coordinates: M^-1 = B B^T
    // with B from the articulated bodies, so a joint's column of B begins with D^-1/2, D its articulated inertia.
    if model.points > 0 || !model.grounds.is_empty() || !model.joint_laws.is_empty() {
        predict(simd, model, state.v, &mut s.links);
        place_colliders(simd, model, &s.links, &mut s.placed);
        place_spheres(simd, model, &s.placed, &mut s.spheres);
        for (link, w) in model.links.iter().zip(&s.links) {
            if link.motion != Motion::Floating {
                s.inverse_sqrt_inertia[usize::from(link.dof)] = w.reciprocal.sqrt();
            }
        }
        for z in &mut s.response {
            *z = zero;
        }
        let mut solver = Solver {
            h,
            share: s.share,
            live: s.live,
            placed: &s.placed,
            spheres: &s.spheres,
            manifold: &mut s.manifold,
            work: &s.links,
            roots: &s.roots,
            inverse_sqrt_inertia: &s.inverse_sqrt_inertia,
            blocks: &mut s.blocks,
            rolling: &mut s.rolling,
            rows: &mut s.rows,
            rolling_rows: &mut s.rolling_rows,
            response: &mut s.response,
            active: &mut s.active,
            stops: &mut s.stops,
            stop_rows: &[],
            on_grounds: &mut s.on_grounds,
            rubbing: &mut s.rubbing,
            joint_rows: &mut s.joint_rows,
            pyramids: 0,
        };
        let (count, [touched, pushed]) = solver.set_up(simd, model, state.points, state.rolling_impulses);
        let isq = solver.inverse_sqrt_inertia;
        let moved = set_up_grounds(simd, model, state.v, solver.work, isq, solver.on_grounds, solver.rubbing);
        let motion = JointMotion { q: state.q, v: state.v, qdd: &s.qdd };
        let held = solver.set_up_joint_rows(simd, model, motion, state.joint_impulses, &mut s.stop_rows);
        if count + solver.pyramids > 0 || moved.any() || held.any() {
            let stops = set_up_stops(
                simd,
                model,
                h,
                state.q,
                state.v,
                solver.work,
                solver.roots,
                solver.inverse_sqrt_inertia,
                pushed | held,
                &mut s.stop_rows,
                solver.stops,
            );
            solver.stop_rows = &s.stop_rows;
            let changed = touched | moved | held;
            solver.sweep(simd, model, count, stops, changed & s.live);
            solver.store(simd, model, count, state.points, state.rolling_impulses);
            respond(simd, model, &s.response, &s.inverse_sqrt_inertia, changed, &mut s.links, &s.roots, state.v);
            hold(simd, model, &s.rubbing, state.v);
        }
        store_joint_rows(s.share, &s.joint_rows, state.joint_impulses);
    }
    // Semi-implicit Euler: positions move by the new velocities.
    integrate(simd, model, h, state.q, state.v, &s.links);
}

/// [`forward_kinematics`] as a separate function.
#[inline(never)]
fn place_links<S: Scalar>(simd: S::Simd, model: &Model<S::Real>, q: &[S], v: &[S], work: &mut [LinkData<S>]) {
    S::vectorize(
        simd,
        #[inline(always)]
        || forward_kinematics(simd, &model.links, q, v, work),
    );
}

/// [`accelerations`] as a separate function.
#[inline(never)]
fn accelerate<S: Scalar>(
    simd: S::Simd,
    model: &Model<S::Real>,
    gravity: [S::Real; 3],
    tau: &[S],
    diagonal: &[S],
    work: &mut [LinkData<S>],
    roots: &mut [Root<S>],
    qdd: &mut [S],
) {
    S::vectorize(
        simd,
        #[inline(always)]
        || accelerations(simd, &model.links, gravity, tau, diagonal, work, roots, qdd),
    );
}

/// Efforts and implicit diagonals of actuators, joint damping, springs and stops.
#[inline(always)]
fn efforts<S: Scalar>(
    simd: S::Simd,
    model: &Model<S::Real>,
    h: S,
    q: &[S],
    v: &[S],
    commands: &[S],
    tau: &mut [S],
    diagonal: &mut [S],
) {
    let zero = S::splat(simd, S::Real::from_f64(0.0));
    for link in &model.links {
        let at = usize::from(link.dof);
        if link.motion == Motion::Floating {
            for j in at..at + 6 {
                tau[j] = zero;
                diagonal[j] = zero;
            }
            continue;
        }
        // A force -k (q - q0) - d v is taken implicitly, at q + h v' and v' = v + h qdd. Its part in qdd goes to the
        // diagonal as h d + h^2 k, the rest stays as the effort -k (q + h v - q0) - d v.
        let (x, speed) = (q[usize::from(link.q)], v[at]);
        let damping = S::splat(simd, link.damping);
        // A stop acts where the joint would be at the end of the step.
        let ahead = x + h * speed;
        let over = ahead.gt(S::splat(simd, link.upper));
        let under = ahead.lt(S::splat(simd, link.lower));
        let bound = S::select(over, S::splat(simd, link.upper), S::splat(simd, link.lower));
        let hard = over | under;
        let stiffness = S::splat(simd, link.limit_stiffness);
        let stop = S::splat(simd, link.limit_damping);
        tau[at] = S::select(hard, -(stiffness * (ahead - bound)) - stop * speed, zero) - damping * speed;
        diagonal[at] =
            S::splat(simd, link.armature) + h * damping + S::select(hard, h * stop + h * h * stiffness, zero);
        // Most joints have no spring.
        if link.stiffness > S::Real::from_f64(0.0) {
            let spring = S::splat(simd, link.stiffness);
            tau[at] -= spring * (ahead - S::splat(simd, link.rest));
            diagonal[at] += h * h * spring;
        }
    }
    // Actuators, linearised at the start of the step: tau(q, v) and the -k h v that its stiffness adds by the end of it.
    for (actuator, command) in model.actuators.iter().zip(commands.chunks_exact(2)) {
        let link = &model.links[usize::from(actuator.link)];
        let at = usize::from(link.dof);
        let speed = v[at];
        let e = actuator.law.effort(q[usize::from(link.q)], speed, [command[0], command[1]]);
        tau[at] += e.torque - h * e.stiffness * speed;
        diagonal[at] += h * e.damping + h * h * e.stiffness;
    }
}

/// Velocities of the links under the predicted joint velocities, into the links' acceleration fields.
#[inline(always)]
fn predict<S: Scalar>(simd: S::Simd, model: &Model<S::Real>, v: &[S], work: &mut [LinkData<S>]) {
    for (i, link) in model.links.iter().enumerate() {
        let at = usize::from(link.dof);
        let parent =
            if link.parent == WORLD { Spatial::zero(simd) } else { work[usize::from(link.parent)].acceleration };
        let w = &mut work[i];
        w.acceleration = if link.motion == Motion::Floating {
            Spatial { angular: [v[at], v[at + 1], v[at + 2]], linear: [v[at + 3], v[at + 4], v[at + 5]] }
        } else {
            parent + w.subspace.scale(v[at])
        };
    }
}

/// Adds the velocities that the impulses give, in the lanes that have any.
///
/// The second half of the solution with the factor: from the root outwards, `dv_i = D_i^-1/2 z_i - D_i^-1 U_i . dv_parent`,
/// with z the response, D the joint's articulated inertia and U its column. It is the last pass of [`accelerations`], for
/// a change of velocity.
#[inline(always)]
fn respond<S: Scalar>(
    simd: S::Simd,
    model: &Model<S::Real>,
    response: &[S],
    inverse_sqrt_inertia: &[S],
    touched: S::Mask,
    work: &mut [LinkData<S>],
    roots: &[Root<S>],
    v: &mut [S],
) {
    for (i, link) in model.links.iter().enumerate() {
        let at = usize::from(link.dof);
        if link.motion == Motion::Floating {
            let mut y = [S::splat(simd, S::Real::from_f64(0.0)); 6];
            y.copy_from_slice(&response[at..at + 6]);
            let change = roots[usize::from(link.root)].factor.other_half(y);
            for k in 0..3 {
                v[at + k] = S::select(touched, v[at + k] + change.angular[k], v[at + k]);
                v[at + 3 + k] = S::select(touched, v[at + 3 + k] + change.linear[k], v[at + 3 + k]);
            }
            work[i].acceleration = change;
            continue;
        }
        let parent =
            if link.parent == WORLD { Spatial::zero(simd) } else { work[usize::from(link.parent)].acceleration };
        let w = &mut work[i];
        let x = inverse_sqrt_inertia[at] * response[at] - w.reciprocal * w.column.dot(parent);
        v[at] = S::select(touched, v[at] + x, v[at]);
        w.acceleration = parent + w.subspace.scale(x);
    }
}

/// Positions from the new velocities.
#[inline(always)]
fn integrate<S: Scalar>(simd: S::Simd, model: &Model<S::Real>, h: S, q: &mut [S], v: &[S], work: &[LinkData<S>]) {
    for (link, w) in model.links.iter().zip(work) {
        let (iq, at) = (usize::from(link.q), usize::from(link.dof));
        if link.motion != Motion::Floating {
            q[iq] += h * v[at];
            continue;
        }
        // Quaternion: q' = q + (h / 2) (w, 0) q with the spin w in the world's axes, brought back to unit length. A step
        // turns by 2 atan(h |w| / 2), less than h |w| by (h |w|)^3 / 12.
        let turn: Vector<S> = scale([v[at], v[at + 1], v[at + 2]], h * h.constant(0.5));
        let [x, y, z, r] = [q[iq + 3], q[iq + 4], q[iq + 5], q[iq + 6]];
        let new = [
            x + (turn[0] * r + turn[1] * z - turn[2] * y),
            y + (turn[1] * r + turn[2] * x - turn[0] * z),
            z + (turn[2] * r + turn[0] * y - turn[1] * x),
            r - (turn[0] * x + turn[1] * y + turn[2] * z),
        ];
        let one = h.constant(1.0);
        let length = (new[0] * new[0] + new[1] * new[1] + new[2] * new[2] + new[3] * new[3]).sqrt();
        let shrink = one / length;
        let new = [new[0] * shrink, new[1] * shrink, new[2] * shrink, new[3] * shrink];
        q[iq + 3..iq + 7].copy_from_slice(&new);
        // The velocity is that of the center of mass, the position that of the origin. The origin moves by h v and by
        // the effect of the turn about the center on the vector between them, R c before less R' c after.
        let centre = splat::<S>(simd, link.centre);
        let before = sub(w.centre, w.position);
        let after = rotate(&matrix_of(new), centre);
        let moved = add(scale([v[at + 3], v[at + 4], v[at + 5]], h), sub(before, after));
        for k in 0..3 {
            q[iq + k] += moved[k];
        }
    }
}
