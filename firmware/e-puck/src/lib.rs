//! An e-puck that finds a small cylinder and stays near it, on a board: eight infrared sensors on a converter, two wheels on
//! pulses, the champion of `e-puck.toml` between them, and a guard.
//!
//! `champion.farsa` and `readings.bin` are made by the test `the_board_of_the_e_puck_has_what_this_program_makes` of
//! `farsa-experiments`, which fails when they are no longer what the experiment gives.
#![no_std]
#![forbid(unsafe_code)]

mod champion;
mod episode;
mod robot;

pub use champion::{CHANNELS, SENSORS, SLOPE, WHEELS, champion};
pub use episode::{Recording, STEPS, Width, reading, run_episode};
pub use robot::{CHANGE, CURVE, EPuck, EPuckError, SAFE};
