//! A counter of instructions for the programs on a Cortex-M.
#![no_std]
#![forbid(unsafe_code)]

use core::cell::Cell;

use cortex_m::Peripherals;
use cortex_m::peripheral::SYST;
use cortex_m::peripheral::syst::SystClkSource;

/// Instructions of two ticks of SysTick in QEMU with `-icount shift=0`, one a nanosecond: the clocks are of 25 MHz and 16 MHz.
const PER_TWO_TICKS: u64 = if cfg!(target_abi = "eabihf") { 80 } else { 125 };
const RELOAD: u32 = 0x00FF_FFFF;

/// Counts instructions, to a tick.
#[derive(Debug)]
pub struct Counter {
    last: Cell<u32>,
    ticks: Cell<u64>,
}

impl Counter {
    /// Starts SysTick. Returns `None` the second time.
    pub fn start() -> Option<Self> {
        let mut peripherals = Peripherals::take()?;
        peripherals.SYST.set_clock_source(SystClkSource::Core);
        peripherals.SYST.set_reload(RELOAD);
        peripherals.SYST.clear_current();
        peripherals.SYST.enable_counter();
        Some(Self { last: Cell::new(SYST::get_current()), ticks: Cell::new(0) })
    }

    /// Instructions since the start. The measured time must be shorter than a round of the 24 bits.
    pub fn instructions(&self) -> u64 {
        let now = SYST::get_current();
        // It counts downwards.
        self.ticks.set(self.ticks.get() + u64::from(self.last.get().wrapping_sub(now) & RELOAD));
        self.last.set(now);
        self.ticks.get() * PER_TWO_TICKS / 2
    }
}
