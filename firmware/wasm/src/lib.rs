//! The champion as WebAssembly: the same controller, the same hash. `run.mjs` runs it.
#![no_std]

use controller::{FixedRobot, Robot, self_test};

// SAFETY: never called: nothing defines it. A module in which a panic is left imports it, and does not start.
unsafe extern "C" {
    fn farsa_a_panic_is_left() -> !;
}

#[panic_handler]
fn panic(_: &core::panic::PanicInfo<'_>) -> ! {
    // SAFETY: as above.
    unsafe { farsa_a_panic_is_left() }
}

/// The hash of a number of steps, 0 if the champion's bytes are damaged.
// SAFETY: no other function of the module has this name.
#[unsafe(no_mangle)]
pub extern "C" fn hash(steps: u32) -> u64 {
    Robot::new().map_or(0, |mut robot| self_test(&mut robot, steps))
}

/// The hash of the champion in integers.
// SAFETY: as above.
#[unsafe(no_mangle)]
pub extern "C" fn hash_fixed(steps: u32) -> u64 {
    FixedRobot::new().map_or(0, |mut robot| self_test(&mut robot, steps))
}
