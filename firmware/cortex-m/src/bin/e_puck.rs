//! The e-puck on a Cortex-M, over a recorded episode.
#![no_std]
#![no_main]

use cortex_m_rt::entry;
use firmware_cortex_m::Counter;

#[entry]
fn main() -> ! {
    start::paint();
    let Some(counter) = Counter::start() else { start::exit(false) };
    start::report_e_puck(|| counter.instructions())
}
