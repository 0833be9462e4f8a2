//! The champion on a RISC-V.
#![no_std]
#![no_main]

use riscv::register::minstret;
use riscv_rt::entry;

#[entry]
fn main() -> ! {
    start::paint();
    start::report(minstret::read64)
}
