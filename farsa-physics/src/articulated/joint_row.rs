//! Bounded rows of joints next to the contacts', for dry friction, largest speeds and soft stops.
//!
//! The impulse l of a row obeys `v+ + c l + o = 0` with the joint's speed v+ after the step, or has the size of a bound
//! where it would be beyond. That of a largest speed moves the joint to the nearest speed that is allowed.

use farsa_num::{Mask, Real, Scalar};

use crate::articulated::model::{JointLaw, Model};

/// One joint's row.
#[derive(Clone, Copy, Debug)]
pub(crate) struct JointRow<S> {
    /// Predicted speed of the joint.
    pub(crate) speed: S,
    pub(crate) impulse: S,
    /// `A = J M^-1 J^T`.
    pub(crate) response: S,
    pub(crate) compliance: S,
    pub(crate) offset: S,
    /// Reciprocal of the response and the compliance.
    pub(crate) inverse: S,
    pub(crate) bounds: [S; 2],
}

impl<S: Scalar> JointRow<S> {
    pub(crate) fn new(simd: S::Simd) -> Self {
        let o = S::splat(simd, S::Real::from_f64(0.0));
        Self { speed: o, impulse: o, response: o, compliance: o, offset: o, inverse: o, bounds: [o; 2] }
    }

    /// Brings the impulse to its law in the lanes of `running`, given all others. Returns by how much the joint's speed
    /// changes [rad/s or m/s].
    #[inline(always)]
    pub(crate) fn relax(
        &mut self,
        simd: S::Simd,
        model: &Model<S::Real>,
        law: &JointLaw<S::Real>,
        running: S::Mask,
        rows: &[S],
        response: &mut [S],
    ) -> S {
        let zero = S::splat(simd, S::Real::from_f64(0.0));
        let [low, high] = self.bounds;
        if !(running & low.lt(high)).any() {
            return zero;
        }
        let path = &model.stop_paths[usize::from(law.link())];
        let rows = &rows[path.row..path.row + path.dofs.len()];
        let mut speed = self.speed;
        for (&d, y) in path.dofs.iter().zip(rows) {
            speed += *y * response[usize::from(d)];
        }
        let wanted = if let JointLaw::Speed { limit, .. } = *law {
            // From the speed without this impulse, so that the impulse is exactly 0 below the limit.
            let (alone, limit) = (speed - self.response * self.impulse, S::splat(simd, limit));
            (alone.clamp(-limit, limit) - alone) * self.inverse
        } else {
            self.impulse - (speed + self.compliance * self.impulse + self.offset) * self.inverse
        };
        let new = wanted.clamp(low, high);
        let change = S::select(running, new - self.impulse, zero);
        self.impulse = S::select(running, new, self.impulse);
        for (&d, y) in path.dofs.iter().zip(rows) {
            response[usize::from(d)] += *y * change;
        }
        change.abs() * self.response
    }
}
