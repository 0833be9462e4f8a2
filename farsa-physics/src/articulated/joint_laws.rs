//! The laws of joints' rows: dry friction, largest speeds, and soft stops, whose law is in the description.
//!
//! *Dry friction* is Coulomb's law with the same limit F at rest and in motion: no compliance, and bounds `-h F, h F`.
//!
//! *A largest speed* V is the constraint `-V <= u+ <= V` on the speed after the step, without compliance or a bound of
//! the impulse.
//!
//! *A soft stop* with stiffness K, damping B and inertia I acts on a joint that is beyond a limit by r at the start of
//! a step. Its inward force is `K (r - h u+) - B u+ - I (u+ - u) / h`, at least 0, with the inward speeds u before and
//! u+ after the step. This is MuJoCo's law `(aref - a) d / ((1 - d) w)` of limits, taken at the end of the step. As a
//! row of impulses it has the rate `R = h^2 K + h B + I`, the compliance `1 / R` and the offset `-(h K r + I u) / R`.

use farsa_num::{Mask as _, Real, Scalar};

use crate::articulated::joint_row::JointRow;
use crate::articulated::model::{JointLaw, Model};
use crate::articulated::solver::Solver;
use crate::articulated::stop::write_joint_row;

/// Positions, predicted speeds and accelerations of the joints.
#[derive(Clone, Copy)]
pub(crate) struct JointMotion<'a, S> {
    pub(crate) q: &'a [S],
    pub(crate) v: &'a [S],
    pub(crate) qdd: &'a [S],
}

impl<S: Scalar> Solver<'_, S> {
    /// Sets up the rows of all joints with such laws, and starts them from the impulses of the last step. Returns the lanes
    /// in which a row may have an impulse. `rows` receives one word per entry.
    #[inline(never)]
    pub(crate) fn set_up_joint_rows(
        &mut self,
        simd: S::Simd,
        model: &Model<S::Real>,
        motion: JointMotion<'_, S>,
        impulses: &[S],
        rows: &mut [S],
    ) -> S::Mask {
        S::vectorize(
            simd,
            #[inline(always)]
            || {
                let zero = S::splat(simd, S::Real::from_f64(0.0));
                let mut any = zero.lt(zero);
                for ((law, old), row) in model.joint_laws.iter().zip(impulses).zip(&mut *self.joint_rows) {
                    let link = &model.links[usize::from(law.link())];
                    let at = usize::from(link.dof);
                    let speed = motion.v[at];
                    *row = JointRow { speed, ..JointRow::new(simd) };
                    let active = match *law {
                        JointLaw::Friction { limit, .. } => {
                            let limit = S::splat(simd, limit) * self.share;
                            row.bounds = [-limit, limit];
                            self.live
                        }
                        JointLaw::Speed { .. } => {
                            let endless = zero.constant(f64::INFINITY);
                            row.bounds = [-endless, endless];
                            self.live
                        }
                        JointLaw::Stop { stiffness, damping, inertia, curve, .. } => {
                            let x = motion.q[usize::from(link.q)];
                            let [under, over] = [S::splat(simd, link.lower) - x, x - S::splat(simd, link.upper)];
                            let beyond = self.live & (under.gt(zero) | over.gt(zero));
                            if beyond.any() {
                                let [mut k, mut b, mut i] = [stiffness, damping, inertia].map(|x| S::splat(simd, x));
                                if let Some(curve) = &curve {
                                    let [factor, of_spring] = curve.factors(simd, under.max(over));
                                    (k, b, i) = (k * of_spring, b * factor, i * factor);
                                }
                                let [h, one] = [self.h, zero.constant(1.0)];
                                // Along the axis, a stop below pushes and a stop above pulls.
                                let [depth, endless] =
                                    [S::select(over.gt(zero), -over, under), zero.constant(f64::INFINITY)];
                                let rate = h * h * k + h * b + i;
                                let before = speed - h * motion.qdd[at];
                                row.compliance = one / rate;
                                row.offset = -(h * k * depth + i * before) / rate;
                                row.bounds = [
                                    S::select(beyond & over.gt(zero), -endless, zero),
                                    S::select(beyond & under.gt(zero), endless, zero),
                                ];
                            }
                            beyond
                        }
                    };
                    if !active.any() {
                        continue;
                    }
                    any = any | active;
                    let path = &model.stop_paths[usize::from(law.link())];
                    let entries = &mut rows[path.row..path.row + path.dofs.len()];
                    let link = usize::from(law.link());
                    row.response =
                        write_joint_row(model, link, self.work, self.roots, self.inverse_sqrt_inertia, entries);
                    row.inverse = zero.constant(1.0) / (row.response + row.compliance);
                    row.impulse = S::select(active, (*old * self.share).clamp(row.bounds[0], row.bounds[1]), zero);
                    for (&d, y) in path.dofs.iter().zip(&*entries) {
                        self.response[usize::from(d)] += *y * row.impulse;
                    }
                }
                any
            },
        )
    }
}

/// Writes the impulses of joints into the state, as those of whole dynamics steps with the same forces.
#[inline(always)]
pub(crate) fn store_joint_rows<S: Scalar>(share: S, rows: &[JointRow<S>], impulses: &mut [S]) {
    for (row, word) in rows.iter().zip(impulses) {
        *word = row.impulse / share;
    }
}
