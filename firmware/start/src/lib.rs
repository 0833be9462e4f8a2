//! The basis of a safe program for a microcontroller: a panic handler, a measured stack, a line to the host. All programs print
//! the report of this crate.
//!
//! Only this crate and the start-up lines of the programs have `unsafe`. Each use has its reason.
#![no_std]

mod line;
mod panic;
mod report;
mod stack;

pub use line::{exit, say, say_hex};
pub use report::{report, report_arm, report_e_puck, report_fixed};
pub use stack::{paint, used};
