//! The effect of an actuator on its joint.

/// The effect of an actuator on its joint at one instant.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct Effort<S> {
    /// Torque [N m] or force [N], positive towards a growing joint position.
    pub torque: S,
    /// The part of -dtorque/dposition that may be taken implicitly, never negative [N m/rad or N/m].
    pub stiffness: S,
    /// -dtorque/dspeed, never negative [N m s/rad or N s/m].
    pub damping: S,
}
