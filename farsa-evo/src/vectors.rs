//! Loops over rows of numbers, compiled for the instructions of the processor.

use farsa_num::Instructions;
use farsa_num::fearless_simd::{Simd, dispatch};

/// Does work that is compiled once for each instruction set, with the best of this processor (feature `std`), else of the program.
///
/// The compiler vectorizes loops in `work` and in functions that are inlined there, which need `#[inline(always)]`. No
/// operation is left out, fused or reordered, so all instruction sets give the same bits.
#[inline(always)]
pub(crate) fn vectorized<T>(work: impl FnOnce() -> T) -> T {
    dispatch!(Instructions::detect().level(), simd => simd.vectorize(work))
}
