//! Forces from outside that act during one control step.

use alloc::vec;
use alloc::vec::Vec;

use farsa_num::{Real, Scalar};

use crate::articulated::link::Motion;
use crate::articulated::model::Model;
use crate::articulated::spatial::{Vector, cross, sub};
use crate::articulated::step::{Scratch, accelerate, place_links};
use crate::articulated::tree::jacobian;

/// The forces of a control step, and what turns them into changes of velocity.
#[derive(Clone, Debug)]
pub struct Wrenches<R> {
    /// Of each link the moment about its centre of mass and the force, in the world's axes.
    of_links: Vec<[R; 6]>,
    any: bool,
    /// Per degree of freedom: nothing, joint efforts, what is added to the joint-space inertia, accelerations.
    zeros: Vec<R>,
    tau: Vec<R>,
    diagonal: Vec<R>,
    qdd: Vec<R>,
    jacobian: Vec<R>,
}

impl<R: Real> Wrenches<R> {
    /// None yet, of one model.
    pub(crate) fn new(model: &Model<R>) -> Self {
        let zero = R::from_f64(0.0);
        let mut diagonal = vec![zero; model.dofs];
        for link in model.links.iter().filter(|link| link.motion != Motion::Floating) {
            diagonal[usize::from(link.dof)] = link.armature;
        }
        Self {
            of_links: vec![[zero; 6]; model.links.len()],
            any: false,
            zeros: vec![zero; model.dofs],
            tau: vec![zero; model.dofs],
            diagonal,
            qdd: vec![zero; model.dofs],
            jacobian: vec![zero; 6 * model.dofs],
        }
    }

    /// Adds a force [N] at a point [m] of a link whose centre of mass is at `centre` [m], all in the world's axes.
    pub(crate) fn add(&mut self, link: usize, centre: Vector<R>, point: Vector<R>, force: Vector<R>) {
        // No force changes no bit, not even the sign of a zero.
        if force.iter().all(|x| *x == R::from_f64(0.0)) {
            return;
        }
        let moment = cross(sub(point, centre), force);
        for k in 0..3 {
            self.of_links[link][k] += moment[k];
            self.of_links[link][3 + k] += force[k];
        }
        self.any = true;
    }

    /// Whether there is any.
    pub(crate) fn any(&self) -> bool {
        self.any
    }

    /// Forgets all.
    pub(crate) fn clear(&mut self) {
        if self.any {
            self.of_links.fill([R::from_f64(0.0); 6]);
            self.any = false;
        }
    }
}

/// Adds to the velocities what the forces do in one dynamics step: `v += h M^-1 J^T f`.
///
/// Source: own (articulated bodies [Featherstone2008] table 7.1 without gravity and velocities, under the efforts `J^T f`).
/// The links of `scratch` must be placed, and are afterwards.
#[inline(never)]
pub(crate) fn push<R: Real + Scalar<Real = R, Simd = ()>>(
    model: &Model<R>,
    state: &mut [R],
    scratch: &mut Scratch<R>,
    forces: &mut Wrenches<R>,
) {
    let zero = R::from_f64(0.0);
    let Wrenches { of_links, zeros, tau, diagonal, qdd, jacobian: matrix, .. } = forces;
    let (q, v) = state.split_at_mut(model.positions);
    let (links, roots) = scratch.parts();
    place_links((), model, q, zeros, links);
    tau.fill(zero);
    for (link, wrench) in of_links.iter().enumerate() {
        if wrench.iter().all(|x| *x == zero) {
            continue;
        }
        jacobian((), &model.links, links, link, links[link].centre, matrix);
        for (row, x) in matrix.chunks_exact(model.dofs).zip(wrench) {
            for (tau, column) in tau.iter_mut().zip(row) {
                *tau += *column * *x;
            }
        }
    }
    accelerate((), model, [zero; 3], tau, diagonal, links, roots, qdd);
    for (v, a) in v.iter_mut().zip(qdd) {
        *v += model.h * *a;
    }
    place_links((), model, q, v, links);
}
