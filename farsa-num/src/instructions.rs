//! Instruction sets of lane code.

use core::fmt;

use fearless_simd::Level;

/// An instruction set with vectors, or none.
///
/// It changes the time of lane code, never its bits. This is a plain name. If the processor lacks the chosen set, lane code
/// uses the best available one.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
#[non_exhaustive]
pub enum Instructions {
    /// No vectors: lanes are computed one after the other.
    Fallback,
    /// SSE2, which every x86-64 processor has.
    Sse2,
    /// SSE4.2 (x86-64-v2).
    Sse4_2,
    /// AVX2 (x86-64-v3).
    Avx2,
    /// AVX-512 as of Ice Lake.
    Avx512,
    /// Neon of aarch64.
    Neon,
    /// The vectors of WebAssembly.
    WasmSimd128,
}

impl Instructions {
    /// Every instruction set, narrower before wider.
    pub const ALL: [Self; 7] =
        [Self::Fallback, Self::Sse2, Self::Sse4_2, Self::Avx2, Self::Avx512, Self::Neon, Self::WasmSimd128];

    /// The best set of this processor with the feature `std`, else the set that the program is compiled for.
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

    /// The set that the program is compiled for.
    pub fn baseline() -> Self {
        Self::widest(Level::baseline())
    }

    /// Every instruction set up to that of [`detect`](Self::detect), narrowest first.
    pub fn available() -> impl Iterator<Item = Self> {
        let best = best();
        Self::ALL.into_iter().filter(move |one| one.within(best).is_some())
    }

    /// The name in configurations and logs: `fallback`, `sse2`, `sse4.2`, `avx2`, `avx512`, `neon` or `wasm-simd128`.
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

    /// The level of `fearless_simd` for these instructions, or the best available one.
    ///
    /// For `fearless_simd::dispatch!`. This function may change in a minor release.
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
