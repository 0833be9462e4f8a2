//! Pairs of antagonistic muscles. Their tension depends on length, rate of length and activation.

use farsa_num::{Real, Scalar, exp};

use crate::actuators::effort::Effort;

/// The variant of the muscle model.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Default)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize), serde(rename_all = "kebab-case"))]
pub enum MuscleVariant {
    /// Model as printed in the thesis, with the full passive tension and b = 0.9. See [`MusclePair::thesis`].
    #[default]
    Thesis,
    /// Model of the original program. The passive tension is multiplied by 0.5 and by a reduction factor, and b =
    /// 1.0. See [`MusclePair::original`].
    Original,
}

/// A pair of antagonistic Hill-type muscles that act on one joint [Ferrauto2010].
///
/// When the joint moves from the lower to the upper end of its range, the agonist lengthens from
/// [`MusclePair::shortest`] to [`MusclePair::longest`] and the antagonist shortens. The agonist therefore pulls towards
/// the lower end. In the source, lengths have no unit.
///
/// Deviations: the difference of the tensions is multiplied by a moment arm, whereas the source uses it directly as
/// torque. Rates are computed from the speed of the joint and not from backward differences. Outside [shortest,
/// longest] the active tension is 0, and the formula of the passive tension continues to apply.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct MusclePair<R> {
    /// Largest active tension of each muscle, Tmax (in newtons).
    pub tension: R,
    /// Moment arm of the muscles (in meters).
    pub moment_arm: R,
    /// Joint position at which the agonist is shortest (in radians).
    pub lower: R,
    /// Joint position at which the agonist is longest (in radians).
    pub upper: R,
    /// Shortest length of a muscle.
    pub shortest: R,
    /// The rest length RL, at which the active tension is largest and the passive tension is zero.
    pub rest_length: R,
    /// Longest length of a muscle, Lmax.
    pub longest: R,
    /// Shape parameter of the passive tension, Ksh.
    pub shape: R,
    /// Passive tension at the longest length, divided by e^shape - 1 (in newtons).
    pub passive_scale: R,
    /// Viscosity b (in N per unit of length per second).
    pub viscosity: R,
}

/// The components of the tension of one muscle.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct Tension<S> {
    /// Tension that results from the activation (in newtons).
    pub active: S,
    /// Tension that results from the length (in newtons). Below the rest length it is negative, but never more than
    /// 5 % of the largest tension.
    pub passive: S,
    /// Tension that results from the rate of length (in newtons). It is negative while the muscle shortens.
    pub viscous: S,
}

impl<S: Scalar> Tension<S> {
    /// Returns the sum of the components (in newtons).
    #[inline(always)]
    pub fn total(self) -> S {
        self.active + self.passive + self.viscous
    }
}

impl<R: Real> MusclePair<R> {
    /// Creates a pair with the printed values Ksh = 3, RL = 2.5, lengths from 1.3 to 3.7 and b = 0.9
    /// [Ferrauto2010, chapter 2].
    ///
    /// The `tension` is Tmax in newtons, and the `moment_arm` is given in meters. The `range` contains the lower and
    /// the upper limit of the joint in radians.
    pub fn thesis(tension: R, moment_arm: R, range: [R; 2]) -> Self {
        Self::new(tension, moment_arm, range, R::from_f64(1.0), R::from_f64(0.9))
    }

    /// Creates a pair with the values of the original program. It differs from [`MusclePair::thesis`] in that b = 1.0
    /// and the passive tension is multiplied by 0.5 and by `reduction`.
    ///
    /// Note that there is no default for the reduction factor, because the value of the original program is not
    /// published.
    pub fn original(tension: R, moment_arm: R, range: [R; 2], reduction: R) -> Self {
        Self::new(tension, moment_arm, range, R::from_f64(0.5) * reduction, R::from_f64(1.0))
    }

    fn new(tension: R, moment_arm: R, [lower, upper]: [R; 2], passive: R, viscosity: R) -> Self {
        let shape = R::from_f64(3.0);
        Self {
            tension,
            moment_arm,
            lower,
            upper,
            shortest: R::from_f64(1.3),
            rest_length: R::from_f64(2.5),
            longest: R::from_f64(3.7),
            shape,
            passive_scale: passive * tension / (exp(shape) - R::from_f64(1.0)),
            viscosity,
        }
    }

    /// Returns the change of muscle length per unit of joint position, s (in 1/rad).
    #[inline(always)]
    pub fn gear(&self) -> R {
        (self.longest - self.shortest) / (self.upper - self.lower)
    }

    /// Returns the lengths of the agonist and the antagonist at joint position `q` (in radians).
    #[inline(always)]
    pub fn lengths<S: Scalar<Real = R>>(&self, q: S) -> [S; 2] {
        let stroke = q.like(self.gear()) * (q - q.like(self.lower));
        [q.like(self.shortest) + stroke, q.like(self.longest) - stroke]
    }

    /// Computes the tension of one muscle. The `rate` of length is positive while the muscle lengthens (in 1/s), and
    /// `activation` is between 0 and 1.
    #[inline(always)]
    pub fn tension_at<S: Scalar<Real = R>>(&self, length: S, rate: S, activation: S) -> Tension<S> {
        let (active, passive, _) = self.elastic(length, activation);
        Tension { active, passive, viscous: length.like(self.viscosity) * rate }
    }

    /// Active tension, passive tension and the derivative of their sum by the length.
    #[inline(always)]
    fn elastic<S: Scalar<Real = R>>(&self, length: S, activation: S) -> (S, S, S) {
        let zero = length.constant(0.0);
        let per_width = length.like(R::from_f64(1.0) / (self.longest - self.rest_length));
        let e = (length - length.like(self.rest_length)) * per_width;
        let pull = activation * length.like(self.tension);
        let parabola = length.constant(1.0) - e * e;
        let within = parabola.gt(zero);
        let scale = length.like(self.passive_scale);
        let shape = length.like(self.shape);
        let growth = scale * exp(shape * e);
        let active_slope = S::select(within, -((pull + pull) * e), zero);
        (S::select(within, pull * parabola, zero), growth - scale, (active_slope + growth * shape) * per_width)
    }

    /// Computes the effort of the pair at joint position `q` (in radians) and speed `qdot` (in rad/s). The command
    /// contains the activations of agonist and antagonist, each between 0 and 1. They are not clamped.
    ///
    /// Let s be the [`gear`](MusclePair::gear), r the moment arm and T1, T2 the tensions. Then the torque is r (T2 -
    /// T1), the damping is 2 r s b, and the stiffness is max(0, -dtorque/dq). The derivative becomes negative where the
    /// active tension decreases with length. In this region it must not be integrated implicitly.
    #[inline(always)]
    pub fn effort<S: Scalar<Real = R>>(&self, q: S, qdot: S, command: [S; 2]) -> Effort<S> {
        let [x1, x2] = self.lengths(q);
        let (active1, passive1, slope1) = self.elastic(x1, command[0]);
        let (active2, passive2, slope2) = self.elastic(x2, command[1]);
        let arm = q.like(self.moment_arm);
        let leverage = self.moment_arm * self.gear();
        let damping = q.like((leverage + leverage) * self.viscosity);
        Effort {
            torque: arm * ((active2 + passive2) - (active1 + passive1)) - damping * qdot,
            stiffness: (q.like(leverage) * (slope1 + slope2)).max(q.constant(0.0)),
            damping,
        }
    }

    /// Computes the activations of agonist and antagonist that hold `torque` (in N m) at rest at the position `q` (in
    /// radians), with minimal co-contraction. The second result is true if both are within [0, 1]. Otherwise they are
    /// clamped.
    ///
    /// One of the two activations is always 0. At the ends of the range there is no active tension, so only the passive
    /// torque can be held there.
    pub fn activations(&self, q: R, torque: R) -> ([R; 2], bool) {
        let (zero, one) = (R::from_f64(0.0), R::from_f64(1.0));
        let [x1, x2] = self.lengths(q);
        let (full1, passive1, _) = self.elastic(x1, one);
        let (full2, passive2, _) = self.elastic(x2, one);
        let missing = torque - self.moment_arm * (passive2 - passive1);
        let agonist = missing < zero;
        let wanted = missing.abs() / (self.moment_arm * if agonist { full1 } else { full2 });
        // 0/0, nothing desired where nothing is left to give, is held by doing nothing. `clamp` makes 0 of NaN.
        let given = wanted.clamp(zero, one);
        (if agonist { [given, zero] } else { [zero, given] }, wanted <= one || missing == zero)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const DEG: f64 = core::f64::consts::PI / 180.0;

    fn pairs<R: Real>() -> [MusclePair<R>; 4] {
        let elbow = [R::from_f64(-170.0 * DEG), R::from_f64(0.0)];
        let shoulder = [R::from_f64(-110.0 * DEG), R::from_f64(90.0 * DEG)];
        let arm = R::from_f64(0.01);
        [
            MusclePair::thesis(R::from_f64(300.0), arm, elbow),
            MusclePair::thesis(R::from_f64(3000.0), arm, shoulder),
            MusclePair::original(R::from_f64(300.0), arm, elbow, R::from_f64(1.0)),
            MusclePair::original(R::from_f64(3000.0), arm, shoulder, R::from_f64(0.4)),
        ]
    }

    fn close<R: Real>(a: R, b: f64, tolerance: f64, what: &str) {
        assert!((a.to_f64() - b).abs() <= tolerance, "{what}: {a:?} instead of {b}");
    }

    /// A bound on a few rounding errors of numbers around 1.
    fn eps<R: Real>() -> f64 {
        if R::from_f64(1.0 + 1e-12) > R::from_f64(1.0) { 1e-13 } else { 2e-6 }
    }

    fn published_points<R: Real>() {
        let tolerance = eps::<R>();
        let factors = [1.0, 1.0, 0.5, 0.5 * 0.4];
        let viscosities = [0.9, 0.9, 1.0, 1.0];
        for ((m, factor), b) in pairs::<R>().iter().zip(factors).zip(viscosities) {
            let full = m.tension.to_f64();
            let zero = R::from_f64(0.0);
            let t = |x: f64, a: f64| m.tension_at(R::from_f64(x), zero, R::from_f64(a));
            for a in [0.0, 0.3, 1.0] {
                close(t(2.5, a).active, a * full, tolerance * full, "T_A(2.5)");
                for x in [1.3, 3.7, 1.2, 3.9] {
                    close(t(x, a).active, 0.0, 10.0 * tolerance * full, "T_A at and beyond the ends");
                }
                close(t(3.1, a).active, 0.75 * a * full, 10.0 * tolerance * full, "T_A half way");
            }
            close(t(2.5, 1.0).passive, 0.0, tolerance * full, "T_P(2.5)");
            close(t(3.7, 1.0).passive, factor * full, 10.0 * tolerance * full, "T_P(3.7)");
            close(t(1.3, 1.0).passive, -0.049_787_068_367_863_94 * factor * full, 10.0 * tolerance * full, "T_P(1.3)");
            assert!(t(3.9, 0.0).passive.to_f64() > 1.5 * factor * full, "the passive part continues");
            close(m.tension_at(R::from_f64(2.5), R::from_f64(2.0), zero).viscous, 2.0 * b, 10.0 * tolerance, "T_V");
            let all = m.tension_at(R::from_f64(3.0), R::from_f64(2.0), R::from_f64(0.5));
            assert_eq!(all.total(), all.active + all.passive + all.viscous);
        }
    }

    #[test]
    fn tension_at_the_published_points() {
        published_points::<f32>();
        published_points::<f64>();
    }

    fn mapping<R: Real>() {
        for m in pairs::<R>() {
            let tolerance = 10.0 * eps::<R>();
            let [x1, x2] = m.lengths(m.lower);
            close(x1, 1.3, tolerance, "agonist at the lower limit");
            close(x2, 3.7, tolerance, "antagonist at the lower limit");
            let [x1, x2] = m.lengths(m.upper);
            close(x1, 3.7, tolerance, "agonist at the upper limit");
            close(x2, 1.3, tolerance, "antagonist at the upper limit");
            close(m.gear(), 2.4 / (m.upper - m.lower).to_f64(), tolerance, "gear");
        }
    }

    #[test]
    fn range_maps_to_lengths() {
        mapping::<f32>();
        mapping::<f64>();
    }

    /// A grid over and beyond the range, activations and speeds.
    fn grid<R: Real>(m: &MusclePair<R>, mut f: impl FnMut(R, R, [R; 2])) {
        let half = (m.upper - m.lower) / R::from_f64(2.0);
        let middle = (m.upper + m.lower) / R::from_f64(2.0);
        for e in [-1.07, -0.93, -0.71, -0.4, -0.1, 0.0, 0.2, 0.55, 0.87, 1.04] {
            for w in [-12.0, -1.0, 0.0, 0.5, 17.0] {
                for a in [0.0, 0.3, 1.0] {
                    for b in [0.0, 0.45, 1.0] {
                        f(middle + R::from_f64(e) * half, R::from_f64(w), [R::from_f64(a), R::from_f64(b)]);
                    }
                }
            }
        }
    }

    fn properties<R: Real>() {
        let tolerance = eps::<R>();
        for m in pairs::<R>() {
            let scale = 10.0 * (m.tension * m.moment_arm).to_f64();
            let sum = m.lower + m.upper;
            let slack = m.effort(sum / R::from_f64(2.0), R::from_f64(0.0), [R::from_f64(0.5), R::from_f64(0.5)]);
            close(slack.torque, 0.0, tolerance * scale, "balance in the middle");
            grid(&m, |q, w, [a, b]| {
                let one = m.effort(q, w, [a, b]);
                let mirrored = m.effort(sum - q, -w, [b, a]);
                close(one.torque, -mirrored.torque.to_f64(), tolerance * scale, "antisymmetry");
                let still = m.effort(q, R::from_f64(0.0), [a, b]);
                assert!((one.torque - still.torque) * w <= R::from_f64(0.0), "viscous power is dissipated");
                assert!(one.stiffness >= R::from_f64(0.0) && one.damping > R::from_f64(0.0));
                // The parts that are exposed make up the torque.
                let [x1, x2] = m.lengths(q);
                let v = m.gear() * w;
                let difference = m.tension_at(x2, -v, b).total() - m.tension_at(x1, v, a).total();
                close(one.torque, (m.moment_arm * difference).to_f64(), tolerance * scale, "difference of tensions");
                // Equal activations cancel.
                let relaxed = m.effort(q, w, [R::from_f64(0.0); 2]);
                let tense = m.effort(q, w, [a, a]);
                close(tense.torque, relaxed.torque.to_f64(), tolerance * scale, "co-contraction adds no torque");
                close(
                    tense.stiffness,
                    relaxed.stiffness.to_f64(),
                    4.0 * tolerance * scale,
                    "co-contraction adds no stiffness",
                );
            });
        }
    }

    #[test]
    fn pair_is_antisymmetric_passive_and_the_sum_of_its_parts() {
        properties::<f32>();
        properties::<f64>();
    }

    #[test]
    fn derivatives_are_central_differences() {
        for m in pairs::<f64>() {
            let scale = m.tension * m.moment_arm;
            let h = 1e-5;
            let mut negative = 0;
            grid(&m, |q, w, c| {
                let e = m.effort(q, w, c);
                let by_q = (m.effort(q + h, w, c).torque - m.effort(q - h, w, c).torque) / (2.0 * h);
                let by_w = (m.effort(q, w + h, c).torque - m.effort(q, w - h, c).torque) / (2.0 * h);
                negative += i32::from(by_q > 0.0);
                close(e.stiffness, (-by_q).max(0.0), 1e-6 * scale, "stiffness");
                close(e.damping, -by_w, 1e-6 * scale, "damping");
            });
            assert!(negative > 0, "the grid meets negative stiffness");
        }
        // f32 against f64, which the differences have checked.
        for (m, n) in pairs::<f32>().iter().zip(pairs::<f64>()) {
            let scale = n.tension * n.moment_arm;
            grid(&n, |q, w, c| {
                let (e, f) = (m.effort(q as f32, w as f32, c.map(|a| a as f32)), n.effort(q, w, c));
                close(e.torque, f.torque, 2e-5 * scale, "f32 torque");
                close(e.stiffness, f.stiffness, 2e-4 * scale, "f32 stiffness");
                close(e.damping, f.damping, 2e-6 * scale, "f32 damping");
            });
        }
    }

    fn statics<R: Real>() {
        for m in pairs::<R>() {
            let largest = m.tension * m.moment_arm;
            let tolerance = 20.0 * eps::<R>() * largest.to_f64();
            let (half, middle) = ((m.upper - m.lower) / R::from_f64(2.0), (m.upper + m.lower) / R::from_f64(2.0));
            let zero = R::from_f64(0.0);
            for e in [-0.7, -0.3, 0.0, 0.4, 0.7] {
                let q = middle + R::from_f64(e) * half;
                for t in [-0.3, -0.1, 0.0, 0.2] {
                    let torque = R::from_f64(t) * largest;
                    let (command, reached) = m.activations(q, torque);
                    assert!(
                        command.iter().all(|a| *a >= zero && *a <= R::from_f64(1.0)) && command[0] * command[1] == zero
                    );
                    let got = m.effort(q, zero, command).torque;
                    if reached {
                        close(got, torque.to_f64(), tolerance, "held torque");
                    } else {
                        assert!(
                            command[0] == R::from_f64(1.0) || command[1] == R::from_f64(1.0),
                            "as much as there is"
                        );
                    }
                }
            }
            let (command, reached) = m.activations(middle, R::from_f64(2.0) * largest);
            assert!(!reached && command == [zero, R::from_f64(1.0)], "clamped");
            let passive = m.effort(m.upper, zero, [zero; 2]).torque;
            let (command, reached) = m.activations(m.upper, passive);
            assert!(reached || command.iter().any(|a| *a > zero), "at the end only the passive torque is held");
        }
        // Without any load the thesis's muscles hold 0.7 of the half range, not 0.75.
        let m = pairs::<R>()[0];
        let (half, middle) = ((m.upper - m.lower) / R::from_f64(2.0), (m.upper + m.lower) / R::from_f64(2.0));
        assert!(m.activations(middle + R::from_f64(0.70) * half, R::from_f64(0.0)).1);
        assert!(!m.activations(middle + R::from_f64(0.75) * half, R::from_f64(0.0)).1);
    }

    #[test]
    fn activations_invert_the_torque() {
        statics::<f32>();
        statics::<f64>();
    }
}
