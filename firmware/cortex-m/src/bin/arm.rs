//! The torques that hold an arm of seven joints against gravity, on a Cortex-M.
#![no_std]
#![no_main]

use cortex_m_rt::entry;
use firmware_cortex_m::Counter;

#[entry]
fn main() -> ! {
    start::paint();
    let Some(counter) = Counter::start() else { start::exit(false) };
    start::report_arm(|| counter.instructions())
}
