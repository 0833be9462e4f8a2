//! A moving link: its constants, and what the sweeps compute for it.

use farsa_num::{Real, Scalar};

use crate::articulated::spatial::{Inertia, Matrix, Spatial, Vector};

/// The parent of a link that hangs on the world.
pub(crate) const WORLD: u16 = u16::MAX;

/// The motion of a link relative to its parent.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Motion {
    Revolute,
    Prismatic,
    Floating,
}

/// A moving link in the form that the kernels need. Each number of the description is rounded only once.
#[derive(Clone, Copy, Debug)]
pub struct Link<R> {
    pub(crate) parent: u16,
    pub(crate) motion: Motion,
    /// First position, first velocity.
    pub(crate) q: u16,
    pub(crate) dof: u16,
    /// The link of its tree whose center of mass is the tree's reference point.
    pub(crate) reference: u16,
    /// Number among the floating links.
    pub(crate) root: u16,
    /// Joint frame in the parent's frame.
    pub(crate) rotation: Matrix<R>,
    pub(crate) offset: Vector<R>,
    pub(crate) mass: R,
    pub(crate) centre: Vector<R>,
    pub(crate) inertia: [R; 6],
    pub(crate) armature: R,
    pub(crate) damping: R,
    /// The joint's spring, and the position at which it exerts no effort.
    pub(crate) stiffness: R,
    pub(crate) rest: R,
    pub(crate) friction: R,
    pub(crate) lower: R,
    pub(crate) upper: R,
    pub(crate) limit_stiffness: R,
    pub(crate) limit_damping: R,
    /// True if the description has the law of the stops. It is then a row, and the two numbers above are 0.
    pub(crate) has_own_stop: bool,
    /// The constants of a link that only slides, for short kernels.
    pub(crate) sliding: Option<Sliding<R>>,
}

/// Results that the sweeps compute for a single link.
#[derive(Clone, Copy, Debug)]
pub struct LinkData<S> {
    pub(crate) rotation: Matrix<S>,
    pub(crate) position: Vector<S>,
    /// Center of mass in the world.
    pub(crate) centre: Vector<S>,
    /// The tree's reference point in the world.
    pub(crate) reference: Vector<S>,
    pub(crate) subspace: Spatial<S>,
    pub(crate) velocity: Spatial<S>,
    /// Velocity-dependent acceleration of the joint.
    pub(crate) bias: Spatial<S>,
    pub(crate) inertia: Inertia<S>,
    pub(crate) force: Spatial<S>,
    /// Articulated inertia times subspace, and the reciprocal of the joint's articulated inertia.
    pub(crate) column: Spatial<S>,
    pub(crate) reciprocal: S,
    pub(crate) effort: S,
    pub(crate) acceleration: Spatial<S>,
}

impl<S: Scalar> LinkData<S> {
    /// Creates empty results.
    pub fn new(simd: S::Simd) -> Self {
        let o = S::splat(simd, S::Real::from_f64(0.0));
        let zero = Spatial::zero(simd);
        Self {
            rotation: [[o; 3]; 3],
            position: [o; 3],
            centre: [o; 3],
            reference: [o; 3],
            subspace: zero,
            velocity: zero,
            bias: zero,
            inertia: Inertia::zero(simd),
            force: zero,
            column: zero,
            reciprocal: o,
            effort: o,
            acceleration: zero,
        }
    }
}

/// The constants of a link that only slides, in the world's axes.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Sliding<R> {
    pub(crate) rotation: Matrix<R>,
    /// From the parent's origin, or the world's, to where the joint is at 0.
    pub(crate) offset: Vector<R>,
    /// From the link's origin to its center of mass.
    pub(crate) arm: Vector<R>,
}
