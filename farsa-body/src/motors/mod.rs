//! Motors that convert values in [0, 1] to the commands of actuators.
//!
//! | to drive | use | channels |
//! |---|---|---|
//! | a pair of muscles | [`Muscles`] | 2 |
//! | one or several servos together | [`ServoGroup`] of [`ServoRange`]s | 1 |
//! | a torque motor | [`TorqueMotor`] | 1 |
//! | a joint at a speed | [`VelocityMotor`] | 1 |
//! | two wheels, each by itself | [`WheelVelocity`] | 2 |
//! | two wheels, by speed and turn | [`SpeedAndTurn`] | 2 |
//! | LEDs | [`Leds`] | 1 each |
//! | a signal for other robots | [`SignalMotor`] | 1 |
//! | a gripper or another attachment device | [`AttachmentMotor`] | 1 |
//!
//! All motors implement [`Motor`](crate::ports::Motor) for any world that supports the required ports. Tuples, arrays
//! and `Vec`s of motors are motors, too. Values outside [0, 1] are clamped, and NaN is treated as 0. Use a
//! [wrapper](crate::wrappers) to add noise, delay or damage. Note that [`HeadTracking`] is a reflex and not a motor,
//! since it moves two servos without a controller.

/// Devices that hold on to things: the motor that switches one and the sensor that reads whether it holds.
pub(crate) mod attachment;
/// A reflex that turns a head towards a thing.
pub(crate) mod head_tracking;
/// Motors of joints: muscles, servos, torques, speeds.
pub(crate) mod joints;
/// LEDs and signals.
pub(crate) mod leds;
/// Motors of two wheels.
pub(crate) mod wheels;

pub use attachment::AttachmentMotor;
pub use head_tracking::HeadTracking;
pub use joints::{Muscles, ServoGroup, ServoRange, TorqueMotor, VelocityMotor};
pub use leds::{Leds, SignalMotor};
pub use wheels::{SpeedAndTurn, WheelVelocity};
