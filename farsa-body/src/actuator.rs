//! Actuator laws: from a joint's position, speed and a command to an effort and its derivatives.

use farsa_num::{Real, Scalar, exp};

/// What an actuator does to its joint at one instant.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Effort<S> {
    /// Torque [N m] or force [N], positive towards a growing joint position.
    pub torque: S,
    /// The part of -dtorque/dposition that may be taken implicitly, never negative [N m/rad or N/m].
    pub stiffness: S,
    /// -dtorque/dspeed, never negative [N m s/rad or N s/m].
    pub damping: S,
}

/// Which reading of the muscle model: the printed one or that of the original program.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Default)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize), serde(rename_all = "kebab-case"))]
pub enum MuscleVariant {
    /// As printed in the thesis: passive force in full, b = 0.9.
    #[default]
    Thesis,
    /// As in the original program: passive force times 0.5 and a reduction factor, b = 1.0.
    Original,
}

/// An antagonist pair of Hill-type muscles on one joint [Ferrauto2010].
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct MusclePair<R> {
    /// Largest active force of each muscle [N].
    pub tension: R,
    /// Moment arm [m].
    pub moment_arm: R,
    /// Joint position at which the agonist is shortest [rad].
    pub lower: R,
    /// Joint position at which the agonist is longest [rad].
    pub upper: R,
    /// Length at which active force is largest and passive force begins.
    pub rest_length: R,
    /// Longest length.
    pub longest: R,
    /// Shortest length.
    pub shortest: R,
    /// Shape of the passive force.
    pub shape: R,
    /// Viscosity [N per unit of length per second].
    pub viscosity: R,
    /// Factor on the passive force.
    pub passive: R,
}

/// A position servo: a spring and damper to the commanded position, with a capped effort.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct Servo<R> {
    /// Position gain [N m/rad or N/m].
    pub stiffness: R,
    /// Speed gain [N m s/rad or N s/m].
    pub damping: R,
    /// Largest effort [N m or N].
    pub limit: R,
}

/// A motor that exerts the commanded torque, capped.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct Torque<R> {
    /// Largest effort [N m or N].
    pub limit: R,
}

/// A user's own law, evaluated once per control step: the commanded torque with constant stiffness and damping.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct Held<R> {
    /// Stiffness around the position at which the second command was given [N m/rad or N/m].
    pub stiffness: R,
    /// Damping [N m s/rad or N s/m].
    pub damping: R,
}

/// The law of one actuator.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize), serde(rename_all = "kebab-case"))]
pub enum Law<R> {
    /// Two muscles that pull against each other.
    MusclePair(MusclePair<R>),
    /// A position servo.
    Servo(Servo<R>),
    /// A torque motor.
    Torque(Torque<R>),
    /// A law of the user's, held over the control step.
    Held(Held<R>),
}

impl<R: Real> MusclePair<R> {
    /// The pair's effort at joint position `q` [rad], speed `qdot` [rad/s] and activations [agonist, antagonist] in [0, 1].
    #[inline(always)]
    pub fn effort<S: Scalar<Real = R>>(&self, q: S, qdot: S, command: [S; 2]) -> Effort<S> {
        let zero = q.constant(0.0);
        let one = q.constant(1.0);
        let [shortest, longest, rest] = [self.shortest, self.longest, self.rest_length].map(|x| q.like(x));
        let slope = (longest - shortest) / (q.like(self.upper) - q.like(self.lower));
        let x1 = shortest + slope * (q - q.like(self.lower));
        let x2 = shortest + longest - x1;
        let tension = q.like(self.tension);
        let width = longest - rest;
        let shape = q.like(self.shape);
        let scale = q.like(self.passive) * tension / (exp(shape) - one);
        let active = |x: S, a: S| {
            let e = (x - rest) / width;
            (a * tension * (one - e * e)).max(zero)
        };
        let passive = |x: S| {
            let e = exp(shape * ((x - rest) / width));
            (scale * (e - one), scale * e * shape / width)
        };
        let (p1, s1) = passive(x1);
        let (p2, s2) = passive(x2);
        let b = q.like(self.viscosity);
        let arm = q.like(self.moment_arm);
        let viscous = (b + b) * slope * arm;
        Effort {
            torque: arm * ((active(x2, command[1]) + p2) - (active(x1, command[0]) + p1)) - viscous * qdot,
            stiffness: arm * slope * (s1 + s2),
            damping: viscous,
        }
    }
}

impl<R: Real> Servo<R> {
    /// The servo's effort at position `q` and speed `qdot`, with the desired position in `command[0]`.
    ///
    /// Whether it saturates is decided here; a saturated servo has no stiffness and no damping.
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

impl<R: Real> Law<R> {
    /// The effort at position `q` and speed `qdot` under `command`, as [`crate::Actuated::command`] describes it.
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
            Self::Held(law) => {
                let (stiffness, damping) = (q.like(law.stiffness), q.like(law.damping));
                Effort { torque: command[0] - stiffness * (q - command[1]) - damping * qdot, stiffness, damping }
            }
        }
    }

    /// The same law in another precision, each number rounded once.
    pub fn cast<Q: Real>(&self) -> Law<Q> {
        let c = |x: R| Q::of(x.to_f64());
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
                viscosity: c(m.viscosity),
                passive: c(m.passive),
            }),
            Self::Servo(s) => {
                Law::Servo(Servo { stiffness: c(s.stiffness), damping: c(s.damping), limit: c(s.limit) })
            }
            Self::Torque(t) => Law::Torque(Torque { limit: c(t.limit) }),
            Self::Held(h) => Law::Held(Held { stiffness: c(h.stiffness), damping: c(h.damping) }),
        }
    }
}
