//! Scalars with eight or sixteen lanes. They contain the values of several worlds.

use fearless_simd::{Select, Simd, SimdBase, SimdFloat, SimdMask, f32x8, f32x16, mask32x8, mask32x16, u32x8, u32x16};

use crate::scalar::{Mask, Scalar};

macro_rules! lanes {
    ($lanes:ident, $mask:ident, $bits:ident, $count:literal) => {
        impl<S: Simd> Mask for $mask<S> {
            #[inline(always)]
            fn any(self) -> bool {
                self.any_true()
            }
            #[inline(always)]
            fn all(self) -> bool {
                self.all_true()
            }
            #[inline(always)]
            fn lane(self, index: usize) -> bool {
                index < $count && self.test(index)
            }
        }

        impl<S: Simd> Scalar for $lanes<S> {
            type Real = f32;
            type Mask = $mask<S>;
            type Simd = S;
            const LANES: usize = $count;

            #[inline(always)]
            fn splat(simd: S, x: f32) -> Self {
                <Self as SimdBase<S>>::splat(simd, x)
            }
            #[inline(always)]
            fn load(simd: S, from: &[f32]) -> Self {
                SimdBase::from_slice(simd, &from[..$count])
            }
            #[inline(always)]
            fn store(self, to: &mut [f32]) {
                SimdBase::store_slice(&self, &mut to[..$count]);
            }
            #[inline(always)]
            fn simd(self) -> S {
                self.simd
            }
            #[inline(always)]
            fn lane(self, index: usize) -> f32 {
                self[index]
            }
            #[inline(always)]
            fn set_lane(&mut self, index: usize, x: f32) {
                self[index] = x;
            }
            #[inline(always)]
            fn vectorize<T>(simd: S, work: impl FnOnce() -> T) -> T {
                Simd::vectorize(simd, work)
            }
            #[inline(always)]
            fn sqrt(self) -> Self {
                SimdFloat::sqrt(self)
            }
            #[inline(always)]
            fn abs(self) -> Self {
                SimdBase::abs(self)
            }
            #[inline(always)]
            fn lt(self, other: Self) -> $mask<S> {
                SimdBase::simd_lt(self, other)
            }
            #[inline(always)]
            fn le(self, other: Self) -> $mask<S> {
                SimdBase::simd_le(self, other)
            }
            #[inline(always)]
            fn select(mask: $mask<S>, if_true: Self, if_false: Self) -> Self {
                Select::select(mask, if_true, if_false)
            }
            #[inline(always)]
            fn round_small(self) -> Self {
                (self + 12_582_912.0) - 12_582_912.0
            }
            #[inline(always)]
            fn exp2_integer(self) -> Self {
                let bits: $bits<S> = SimdFloat::to_bits(self + (12_582_912.0 + 127.0));
                SimdFloat::from_bits(bits << 23)
            }
        }
    };
}

lanes!(f32x8, mask32x8, u32x8, 8);
lanes!(f32x16, mask32x16, u32x16, 16);
