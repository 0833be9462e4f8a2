//! The e-puck on a RISC-V.
#![no_std]
#![no_main]

use riscv::register::minstret;
use riscv_rt::entry;

#[entry]
fn main() -> ! {
    start::paint();
    start::report_e_puck(minstret::read64)
}
