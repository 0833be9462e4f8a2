//! Sensors and motors of `farsa-body` over `embedded-hal` 1.0: pulses, switches, converters, registers on an I2C bus. A guard limits
//! the commands between a network and its motors.
//!
//! `Sensor::read` and `Motor::drive` return no error. An adapter stores its last fault instead. The loop reads it once per tick and
//! passes it to the [`Guard`], which then drives the safe command.
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
