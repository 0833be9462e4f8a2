//! Actuator laws. They are pure functions that compute an [`Effort`] from the state of a joint and a command.
//!
//! | you want | law | `command[0]`, `command[1]` |
//! |---|---|---|
//! | two antagonist muscles, as in an animal's joint | [`MusclePair`] | activations of agonist and antagonist in [0, 1] |
//! | a joint that goes to a position | [`Servo`] | desired position [rad or m], unused |
//! | a joint that pushes as hard as commanded | [`Torque`] | effort [N m or N], unused |
//! | a motor that holds a speed | [`Velocity`] | desired speed [rad/s or m/s], unused |
//! | a custom law, computed once per control step | [`Held`] | effort, and the position at which it holds |
//!
//! A [`Law`] is one of these laws. It can be part of the description of a [`Robot`](crate::robot::Robot) or used on its
//! own. All laws support plain floats as well as SIMD lanes and produce identical bits.

/// The torque of an actuator, with its stiffness and damping.
pub(crate) mod effort;
/// The laws: servo, torque, held, and the choice among all.
pub(crate) mod law;
/// The pair of muscles: tension from length, rate and activation.
pub(crate) mod muscle;

pub use effort::Effort;
pub use law::{Held, Law, Servo, Torque, Velocity, clamp_command};
pub use muscle::{MusclePair, MuscleVariant, Tension};
