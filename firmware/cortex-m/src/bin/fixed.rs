//! The champion in integers on a Cortex-M.
#![no_std]
#![no_main]

use cortex_m_rt::entry;
use firmware_cortex_m::Counter;

#[entry]
fn main() -> ! {
    start::paint();
    let Some(counter) = Counter::start() else { start::exit(false) };
    start::report_fixed(|| counter.instructions())
}
