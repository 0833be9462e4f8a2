//! The instruction sets that are available for lanes.

use core::fmt;

use fearless_simd::Level;

/// An instruction set for vectors.
///
/// The choice only affects the speed of lanes and never their results. If the processor does not support the selected
/// set, the best available one is used.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
#[non_exhaustive]
pub enum Instructions {
    /// No vector instructions. Lanes are computed one after the other.
    Fallback,
    /// SSE2. All x86-64 processors support it.
    Sse2,
    /// SSE4.2, part of x86-64-v2.
    Sse4_2,
    /// AVX2, part of x86-64-v3.
    Avx2,
    /// AVX-512 in the version of Ice Lake.
    Avx512,
    /// Neon on aarch64.
    Neon,
    /// The 128-bit vectors of WebAssembly.
    WasmSimd128,
}

impl Instructions {
    /// All instruction sets, ordered by the width of their vectors.
    pub const ALL: [Self; 7] =
        [Self::Fallback, Self::Sse2, Self::Sse4_2, Self::Avx2, Self::Avx512, Self::Neon, Self::WasmSimd128];

    /// Returns the best instruction set of this processor if the feature `std` is enabled. Otherwise it returns the set
    /// for which the program was compiled.
    ///
    /// ```
    /// use farsa_num::Instructions;
    ///
    /// let best = Instructions::detect();
    /// assert!(Instructions::available().eq(Instructions::available().filter(|set| *set <= best)));
    /// assert_eq!(Instructions::available().last(), Some(best));
    /// ```
    pub fn detect() -> Self {
        Self::widest(best())
    }

    /// Returns the instruction set for which the program was compiled.
    pub fn baseline() -> Self {
        Self::widest(Level::baseline())
    }

    /// Returns all instruction sets up to the result of [`detect`](Self::detect), in the order of their width.
    pub fn available() -> impl Iterator<Item = Self> {
        let best = best();
        Self::ALL.into_iter().filter(move |one| one.within(best).is_some())
    }

    /// Returns the name used in configurations and logs. This is `fallback`, `sse2`, `sse4.2`, `avx2`, `avx512`, `neon`
    /// or `wasm-simd128`.
    pub const fn name(self) -> &'static str {
        match self {
            Self::Fallback => "fallback",
            Self::Sse2 => "sse2",
            Self::Sse4_2 => "sse4.2",
            Self::Avx2 => "avx2",
            Self::Avx512 => "avx512",
            Self::Neon => "neon",
            Self::WasmSimd128 => "wasm-simd128",
        }
    }

    /// Returns the corresponding level of `fearless_simd`, or the best available one.
    ///
    /// It can be passed to `fearless_simd::dispatch!`. Note that this function may change in a minor release.
    #[doc(hidden)]
    pub fn level(self) -> Level {
        let best = best();
        self.within(best).unwrap_or(best)
    }

    /// The widest set of a level.
    fn widest(level: Level) -> Self {
        Self::ALL.into_iter().rev().find(|one| one.within(level).is_some()).unwrap_or(Self::Fallback)
    }

    /// These instructions, if a processor of this level has them.
    fn within(self, best: Level) -> Option<Level> {
        match self {
            Self::Fallback => best.is_fallback().then_some(best),
            #[cfg(any(target_arch = "x86", target_arch = "x86_64"))]
            Self::Sse2 => best.as_sse2().map(fearless_simd::Simd::level),
            #[cfg(any(target_arch = "x86", target_arch = "x86_64"))]
            Self::Sse4_2 => best.as_sse4_2().map(fearless_simd::Simd::level),
            #[cfg(any(target_arch = "x86", target_arch = "x86_64"))]
            Self::Avx2 => best.as_avx2().map(fearless_simd::Simd::level),
            #[cfg(any(target_arch = "x86", target_arch = "x86_64"))]
            Self::Avx512 => best.as_avx512().map(fearless_simd::Simd::level),
            #[cfg(target_arch = "aarch64")]
            Self::Neon => best.as_neon().map(fearless_simd::Simd::level),
            #[cfg(all(target_arch = "wasm32", target_feature = "simd128"))]
            Self::WasmSimd128 => best.as_wasm_simd128().map(fearless_simd::Simd::level),
            _ => None,
        }
    }
}

impl Default for Instructions {
    /// [`Instructions::detect`].
    fn default() -> Self {
        Self::detect()
    }
}

impl fmt::Display for Instructions {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.pad(self.name())
    }
}

/// The best level that runs here.
fn best() -> Level {
    Level::try_detect().unwrap_or(Level::baseline())
}
