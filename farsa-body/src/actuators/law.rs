//! Actuator laws. They compute an effort and its derivatives from the state of a joint and a command.

use farsa_num::{Real, Scalar};

use crate::actuators::effort::Effort;
use crate::actuators::muscle::MusclePair;

/// A position servo that acts like a spring and a damper. The effort is limited.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct Servo<R> {
    /// Position gain (in N m/rad or N/m).
    pub stiffness: R,
    /// Velocity gain (in N m s/rad or N s/m).
    pub damping: R,
    /// Largest effort that the servo can exert (in newton meters or newtons).
    pub limit: R,
}

/// A motor that exerts the commanded torque up to a limit.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct Torque<R> {
    /// Largest effort that the motor can exert (in newton meters or newtons).
    pub limit: R,
}

/// A motor that keeps a commanded speed. Its torque is proportional to the speed error up to a limit.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct Velocity<R> {
    /// Torque per unit of speed error (in N m s/rad or N s/m).
    pub gain: R,
    /// Largest effort that the motor can exert (in newton meters or newtons).
    pub limit: R,
}

/// A custom law evaluated by the user once per control step. It combines the commanded torque with constant stiffness
/// and damping.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct Held<R> {
    /// Stiffness around the position given by the second command (in N m/rad or N/m).
    pub stiffness: R,
    /// Damping of the joint (in N m s/rad or N s/m).
    pub damping: R,
}

/// The law of an actuator.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize), serde(rename_all = "kebab-case"))]
pub enum Law<R> {
    /// A pair of antagonistic muscles.
    MusclePair(MusclePair<R>),
    /// A position servo.
    Servo(Servo<R>),
    /// A torque motor.
    Torque(Torque<R>),
    /// A motor that keeps a commanded speed.
    Velocity(Velocity<R>),
    /// A custom law whose result is held during a control step.
    Held(Held<R>),
}

/// Clamps the first command of an actuator to its range. NaN does not change.
#[inline(always)]
pub fn clamp_command<S: Scalar>([low, high]: [S::Real; 2], command: S) -> S {
    command.like(high).min(command.like(low).max(command))
}

impl<R: Real> Servo<R> {
    /// Computes the effort at position `q` and speed `qdot`. The desired position is `command[0]`.
    ///
    /// This function also decides if the servo is saturated. A saturated servo has neither stiffness nor damping.
    #[inline(always)]
    pub fn effort<S: Scalar<Real = R>>(&self, q: S, qdot: S, command: [S; 2]) -> Effort<S> {
        let limit = q.like(self.limit);
        let stiffness = q.like(self.stiffness);
        let damping = q.like(self.damping);
        let wanted = stiffness * (command[0] - q) - damping * qdot;
        let free = wanted.abs().lt(limit);
        let zero = q.constant(0.0);
        Effort {
            torque: wanted.clamp(-limit, limit),
            stiffness: S::select(free, stiffness, zero),
            damping: S::select(free, damping, zero),
        }
    }
}

impl<R: Real> Velocity<R> {
    /// Computes the effort at speed `qdot`. The desired speed is `command[0]`.
    ///
    /// The damping of a saturated motor is limit / |speed error|. This is the slope between the present effort and zero
    /// effort at the desired speed. Therefore a strong motor on a light joint reaches its speed within one step
    /// without overshooting, and it never exceeds the limit.
    #[inline(always)]
    pub fn effort<S: Scalar<Real = R>>(&self, qdot: S, command: [S; 2]) -> Effort<S> {
        let (limit, gain) = (qdot.like(self.limit), qdot.like(self.gain));
        let lack = command[0] - qdot;
        let wanted = gain * lack;
        let (zero, one) = (qdot.constant(0.0), qdot.constant(1.0));
        let saturated = wanted.abs().gt(limit);
        let damping = S::select(saturated, limit / S::select(saturated, lack.abs(), one), gain);
        Effort { torque: wanted.clamp(-limit, limit), stiffness: zero, damping }
    }
}

impl<R: Real> Law<R> {
    /// Computes the effort at position `q` and speed `qdot`. See [`crate::ports::Actuated::command`] for the meaning of
    /// `command`.
    #[inline(always)]
    pub fn effort<S: Scalar<Real = R>>(&self, q: S, qdot: S, command: [S; 2]) -> Effort<S> {
        let zero = q.constant(0.0);
        match self {
            Self::MusclePair(law) => law.effort(q, qdot, command),
            Self::Servo(law) => law.effort(q, qdot, command),
            Self::Torque(law) => {
                let limit = q.like(law.limit);
                Effort { torque: command[0].clamp(-limit, limit), stiffness: zero, damping: zero }
            }
            Self::Velocity(law) => law.effort(qdot, command),
            Self::Held(law) => {
                let (stiffness, damping) = (q.like(law.stiffness), q.like(law.damping));
                Effort { torque: command[0] - stiffness * (q - command[1]) - damping * qdot, stiffness, damping }
            }
        }
    }

    /// Converts the law to a different precision. Each number is rounded once.
    pub fn cast<Q: Real>(&self) -> Law<Q> {
        let c = |x: R| Q::from_f64(x.to_f64());
        match self {
            Self::MusclePair(m) => Law::MusclePair(MusclePair {
                tension: c(m.tension),
                moment_arm: c(m.moment_arm),
                lower: c(m.lower),
                upper: c(m.upper),
                rest_length: c(m.rest_length),
                longest: c(m.longest),
                shortest: c(m.shortest),
                shape: c(m.shape),
                passive_scale: c(m.passive_scale),
                viscosity: c(m.viscosity),
            }),
            Self::Servo(s) => Law::Servo(Servo { stiffness: c(s.stiffness), damping: c(s.damping), limit: c(s.limit) }),
            Self::Torque(t) => Law::Torque(Torque { limit: c(t.limit) }),
            Self::Velocity(v) => Law::Velocity(Velocity { gain: c(v.gain), limit: c(v.limit) }),
            Self::Held(h) => Law::Held(Held { stiffness: c(h.stiffness), damping: c(h.damping) }),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn servo<R: Real>() -> Servo<R> {
        Servo { stiffness: R::from_f64(2.0), damping: R::from_f64(0.5), limit: R::from_f64(0.75) }
    }

    fn servo_is_a_capped_spring<R: Real>() {
        let effort = |q: f64, w: f64, wanted: f64| {
            let e = servo::<R>().effort(R::from_f64(q), R::from_f64(w), [R::from_f64(wanted), R::from_f64(9.0)]);
            [e.torque, e.stiffness, e.damping].map(Real::to_f64)
        };
        // Numbers that both precisions hold exactly.
        assert_eq!(effort(0.25, 0.5, 0.5), [0.25, 2.0, 0.5], "within the cap");
        assert_eq!(effort(0.0, 0.0, 1.0), [0.75, 0.0, 0.0], "stalled: no spring left");
        assert_eq!(effort(0.0, 0.0, -1.0), [-0.75, 0.0, 0.0]);
        assert_eq!(effort(0.0, 0.0, 0.375), [0.75, 0.0, 0.0], "at the cap it counts as saturated");
        assert_eq!(effort(0.0, 2.0, 0.5), [0.0, 2.0, 0.5], "damped to a standstill");
        assert_eq!(effort(0.5, -3.0, 0.5), [0.75, 0.0, 0.0], "damping is under the cap too");
    }

    #[test]
    fn servo_pulls_until_it_stalls() {
        servo_is_a_capped_spring::<f32>();
        servo_is_a_capped_spring::<f64>();
    }

    #[test]
    fn torque_is_capped_and_held_is_a_spring() {
        let motor = Law::Torque(Torque { limit: 1.5 });
        for (command, torque) in [(0.5, 0.5), (2.0, 1.5), (-9.0, -1.5)] {
            assert_eq!(motor.effort(0.3, -0.2, [command, 7.0]), Effort { torque, stiffness: 0.0, damping: 0.0 });
        }
        let held = Law::Held(Held { stiffness: 4.0, damping: 0.5 });
        // The second command is the position at which the first was meant.
        assert_eq!(held.effort(0.75, 2.0, [3.0, 0.5]), Effort { torque: 1.0, stiffness: 4.0, damping: 0.5 });
        assert_eq!(held.effort(0.5, 0.0, [3.0, 0.5]).torque, 3.0);
    }

    #[test]
    fn velocity_motors_lack_no_speed_at_theirs() {
        let motor = Law::Velocity(Velocity { gain: 4.0, limit: 1.5 });
        let effort = |qdot: f64, wanted: f64| motor.effort(0.3, qdot, [wanted, 9.0]);
        assert_eq!(effort(0.5, 0.5), Effort { torque: 0.0, stiffness: 0.0, damping: 4.0 });
        assert_eq!(effort(0.5, 0.75), Effort { torque: 1.0, stiffness: 0.0, damping: 4.0 });
        assert_eq!(effort(0.5, 2.0), Effort { torque: 1.5, stiffness: 0.0, damping: 1.0 }, "saturated");
        assert_eq!(effort(3.0, 0.0), Effort { torque: -1.5, stiffness: 0.0, damping: 0.5 });
        let endless = Law::Velocity(Velocity { gain: 4.0, limit: f64::INFINITY });
        let held = Law::Held(Held { stiffness: 0.0, damping: 4.0 });
        assert_eq!(endless.effort(0.1, 0.25, [1.0, 0.0]), held.effort(0.1, 0.25, [4.0, 0.0]));
    }

    #[test]
    fn casting_rounds_each_number_once() {
        let laws: [Law<f64>; 5] = [
            Law::MusclePair(MusclePair::thesis(300.1, 0.0103, [-2.1, 0.7])),
            Law::Servo(Servo { stiffness: 0.1, damping: 0.2, limit: 0.3 }),
            Law::Torque(Torque { limit: 0.7 }),
            Law::Held(Held { stiffness: 0.9, damping: 1.1 }),
            Law::Velocity(Velocity { gain: 0.7, limit: 0.9 }),
        ];
        for law in laws {
            let narrow = law.cast::<f32>();
            assert_eq!(law.cast::<f64>(), law);
            assert_eq!(narrow.cast::<f64>().cast::<f32>(), narrow);
            let (wide, narrow) = (law.effort(0.2, 0.1, [0.3, 0.4]), narrow.effort(0.2f32, 0.1, [0.3, 0.4]));
            assert!((wide.torque - f64::from(narrow.torque)).abs() < 1e-5);
            assert!((wide.stiffness - f64::from(narrow.stiffness)).abs() < 1e-5);
        }
    }

    #[test]
    fn commands_stay_within_their_range() {
        let clamped = |command: f64| clamp_command([-0.5, 2.0], command);
        for (command, expected) in [(-0.75, -0.5), (-0.5, -0.5), (0.25, 0.25), (2.0, 2.0), (f64::INFINITY, 2.0)] {
            assert_eq!(clamped(command), expected);
        }
        assert!(clamped(f64::NAN).is_nan(), "a lost command stays lost");
        assert_eq!(clamp_command([f64::NEG_INFINITY, 1.0], -1e300), -1e300);
    }

    #[test]
    fn a_lost_joint_stays_lost() {
        let pair = Law::MusclePair(MusclePair::thesis(300.0f32, 0.01, [-1.0, 1.0]));
        assert!(pair.effort(f32::NAN, 0.0, [0.0; 2]).torque.is_nan());
    }
}
