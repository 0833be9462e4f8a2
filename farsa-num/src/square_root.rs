//! Square roots that are correctly rounded and therefore identical on all machines.

/// The processor's own instruction where libm has it.
#[cfg(not(all(target_arch = "wasm32", feature = "std")))]
pub(crate) use libm::{sqrt, sqrtf};

// libm computes both in software for WebAssembly, which has instructions for them.
#[cfg(all(target_arch = "wasm32", feature = "std"))]
#[inline(always)]
pub(crate) fn sqrt(x: f64) -> f64 {
    x.sqrt()
}

#[cfg(all(target_arch = "wasm32", feature = "std"))]
#[inline(always)]
pub(crate) fn sqrtf(x: f32) -> f32 {
    x.sqrt()
}
