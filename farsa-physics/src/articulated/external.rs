//! External forces that act during one control step.

use alloc::vec;
use alloc::vec::Vec;

use farsa_num::{Real, Scalar};

use crate::articulated::link::{LinkData, Motion};
use crate::articulated::model::Model;
use crate::articulated::spatial::{Vector, cross, sub};
use crate::articulated::tree::jacobian;

/// Forces of a control step, together with the data that turns them into changes of velocity.
#[derive(Clone, Debug)]
pub struct Wrenches<R> {
    /// The moment about each link's center of mass and the force, in the world's axes.
    of_links: Vec<[R; 6]>,
    any: bool,
    /// Per degree of freedom: nothing, joint efforts, what is added to the joint-space inertia, accelerations.
    pub(crate) zeros: Vec<R>,
    pub(crate) tau: Vec<R>,
    pub(crate) diagonal: Vec<R>,
    pub(crate) qdd: Vec<R>,
    jacobian: Vec<R>,
}

impl<R: Real> Wrenches<R> {
    /// Creates an empty set of forces for a model. [`Precision::step`](crate::articulated::Precision::step) requires
    /// one.
    pub fn new(model: &Model<R>) -> Self {
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

    /// Adds a force [N] at a point [m] of a link whose center of mass is at `centre` [m], all in the world's axes.
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

    /// Returns whether there is any.
    pub(crate) fn any(&self) -> bool {
        self.any
    }

    /// Discards all.
    pub(crate) fn clear(&mut self) {
        if self.any {
            self.of_links.fill([R::from_f64(0.0); 6]);
            self.any = false;
        }
    }

    /// The joint efforts `J^T f` of the forces \[dofs\]. `links` must be placed.
    pub(crate) fn efforts(&mut self, model: &Model<R>, links: &[LinkData<R>])
    where
        R: Scalar<Real = R, Simd = ()>,
    {
        let zero = R::from_f64(0.0);
        let Self { of_links, tau, jacobian: matrix, .. } = self;
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
    }
}
