//! The depth of the stack: it is painted before a run and inspected after it.

use core::hint::black_box;
use core::ptr;

const PAINT: u32 = 0x5AFE_57AC;

// SAFETY: both are symbols of the linker scripts of cortex-m-rt and riscv-rt, and only their addresses are used.
unsafe extern "C" {
    /// The end of the program's variables, the limit of the stack.
    static __ebss: u32;
    /// The end of the memory, where the stack begins.
    static _stack_start: u32;
}

fn words() -> impl DoubleEndedIterator<Item = *mut u32> {
    let (from, to) = ((&raw const __ebss).addr(), (&raw const _stack_start).addr());
    (from..to).step_by(4).map(|address| ptr::with_exposed_provenance_mut(address))
}

/// Paints the stack below the caller.
#[inline(never)]
pub fn paint() {
    let here = 0_u32;
    // Space for the frame of this function.
    let top = black_box(&raw const here).addr().saturating_sub(256);
    for word in words().take_while(|word| word.addr() < top) {
        // SAFETY: between the variables and the stack there is unused memory, and its words are aligned.
        unsafe { word.write_volatile(PAINT) };
    }
}

/// The largest size of the stack since it was painted [bytes].
#[inline(never)]
pub fn used() -> u32 {
    // SAFETY: the words of `paint`.
    let deepest = words().find(|word| unsafe { word.read_volatile() } != PAINT);
    let top = (&raw const _stack_start).addr();
    deepest.map_or(0, |word| (top - word.addr()) as u32)
}
