//! The panic handler: a proof that there is no panic.

use core::panic::PanicInfo;

// SAFETY: never called: nothing defines it, so that a program in which a panic is left does not link.
unsafe extern "C" {
    fn farsa_a_panic_is_left() -> !;
}

#[panic_handler]
fn panic(_: &PanicInfo<'_>) -> ! {
    // SAFETY: as above.
    unsafe { farsa_a_panic_is_left() }
}
