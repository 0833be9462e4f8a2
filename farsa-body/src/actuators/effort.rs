//! The torque that an actuator exerts on its joint, and its derivatives.

/// The torque that an actuator exerts on its joint at one instant. The derivatives are used for implicit integration.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct Effort<S> {
    /// Torque (in N m) or force (in newtons). Positive values increase the joint position.
    pub torque: S,
    /// Part of -dtorque/dposition that can be integrated implicitly (in N m/rad or N/m). It is never negative.
    pub stiffness: S,
    /// Value of -dtorque/dspeed (in N m s/rad or N s/m). It is never negative.
    pub damping: S,
}
