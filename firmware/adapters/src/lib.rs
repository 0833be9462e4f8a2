//! Sensors and motors of `farsa-body` over `embedded-hal` 1.0: pulses, switches, converters, registers on an I2C bus; and the guard
//! between a network and its motors.
//!
//! `Sensor::read` and `Motor::drive` return no error: the loop has no place for one. An adapter keeps its last fault instead,
//! and the loop asks for it once per tick and hands it to the [`Guard`], which then drives what is safe.
#![no_std]
#![forbid(unsafe_code)]

mod converters;
mod fault;
mod guard;
mod period;
mod pulses;
mod registers;
mod switches;

pub use converters::{Converter, Converters, CurveError};
pub use fault::Fault;
pub use guard::{Guard, GuardError};
pub use period::Period;
pub use pulses::Pulses;
pub use registers::Registers;
pub use switches::Switches;
