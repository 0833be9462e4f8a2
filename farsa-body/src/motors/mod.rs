//! Motors: from values in [0, 1] to the commands of actuators. Which one do I need?
//!
//! | to drive | take | channels |
//! |---|---|---|
//! | a pair of muscles | [`Muscles`] | 2 |
//! | one or several servos together | [`ServoGroup`] of [`ServoRange`]s | 1 |
//! | a torque motor | [`TorqueMotor`] | 1 |
//! | a joint at a speed | [`VelocityMotor`] | 1 |
//! | two wheels, each by itself | [`WheelVelocity`] | 2 |
//! | two wheels, by speed and turn | [`SpeedAndTurn`] | 2 |
//! | LEDs | [`Leds`] | 1 each |
//! | a signal that other robots hear | [`SignalMotor`] | 1 |
//! | a gripper or another attachment device | [`AttachmentMotor`] | 1 |
//!
//! All implement [`Motor`](crate::ports::Motor) for any world with the ports that they name. Tuples, arrays and `Vec`s of motors
//! are motors. A value outside [0, 1] drives like the nearer end, NaN like 0. For noise, delay or damage put a
//! [wrapper](crate::wrappers) around one. [`HeadTracking`] is no motor but a reflex: it moves two servos by itself.

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
