//! What every program for a microcontroller needs before it can be safe: a panic handler, a measured stack, a line to the
//! host; and the report that all of them print.
//!
//! `unsafe` is here and in no other crate but the programs' few lines of start-up; each use is argued for.
#![no_std]

mod line;
mod panic;
mod report;
mod stack;

pub use line::{exit, say, say_hex};
pub use report::{report, report_arm, report_e_puck, report_fixed};
pub use stack::{paint, used};
