//! An e-puck on a board, which finds a small cylinder and stays near it. It has eight infrared sensors on a converter, two wheels
//! on pulses, the champion of `e-puck.toml` and a guard.
//!
//! The test `the_board_of_the_e_puck_has_what_this_program_makes` of `farsa-experiments` creates `champion.farsa` and
//! `readings.bin`, and fails if they differ from the result of the experiment.
#![no_std]
#![forbid(unsafe_code)]

mod champion;
mod episode;
mod robot;

pub use champion::{CHANNELS, SENSORS, SLOPE, WHEELS, champion};
pub use episode::{Recording, STEPS, Width, reading, run_episode};
pub use robot::{CHANGE, CURVE, EPuck, EPuckError, SAFE};
