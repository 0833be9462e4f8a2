//! The champion of the manipulation experiment on a board, in floats and in integers: its bytes, sensors, motors and self-test.
//!
//! This crate is independent of the board. `cortex-m`, `riscv` and `wasm` are programs around it, and its tests run the same
//! functions on a computer.
#![no_std]
#![forbid(unsafe_code)]

mod arm;
mod board;
mod chain;
mod champion;
mod control;
mod fixed_robot;
mod robot;
mod self_test;

pub use arm::ARM;
pub use board::{Analog, Board, Pulse};
pub use chain::{Chain, ChainLink};
pub use champion::{CHANNELS, INPUT_BITS, LAYOUT, LEAK, champion, fixed_champion};
pub use control::Control;
pub use fixed_robot::FixedRobot;
pub use robot::Robot;
pub use self_test::{noise_into, self_test};
