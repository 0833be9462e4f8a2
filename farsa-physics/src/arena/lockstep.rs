//! The compiled steps of batches of planar worlds: one for every number of lanes and instruction set.
#![cfg_attr(
    all(target_arch = "wasm32", not(target_feature = "simd128")),
    allow(dead_code, unused_imports, reason = "there are no vectors")
)]

use alloc::boxed::Box;
use core::marker::PhantomData;

use farsa_num::fearless_simd::{Simd, f32x8, f32x16};
use farsa_num::{Instructions, Scalar};

use crate::arena::infrared::ring;
use crate::arena::model::Model;
use crate::arena::step::step;
use crate::articulated::lockstep::LANES;

/// Steps all worlds of a batch together.
pub(crate) trait Lockstep: Send + Sync {
    /// One control step. See [`step`].
    fn step(&self, model: &Model, words: &mut [f32], work: &mut [f32]);
    /// Readings of a robot's infrared ring. See [`ring`].
    fn infrared(&self, model: &Model, words: &[f32], robot: usize, out: &mut [f32]);
    /// Returns a copy.
    fn boxed_clone(&self) -> Box<dyn Lockstep>;
}

/// Nothing but the proof that the instructions are there.
struct Vectors<S: Scalar> {
    simd: S::Simd,
    scalar: PhantomData<fn() -> S>,
}

impl<S> Lockstep for Vectors<S>
where
    S: Scalar<Real = f32> + 'static,
    S::Simd: Send + Sync,
{
    fn step(&self, model: &Model, words: &mut [f32], work: &mut [f32]) {
        S::vectorize(
            self.simd,
            #[inline(always)]
            || step::<S>(self.simd, model, words, work),
        );
    }

    fn infrared(&self, model: &Model, words: &[f32], robot: usize, out: &mut [f32]) {
        S::vectorize(
            self.simd,
            #[inline(always)]
            || ring::<S>(self.simd, model, words, robot, out),
        );
    }

    fn boxed_clone(&self) -> Box<dyn Lockstep> {
        Box::new(Self { simd: self.simd, scalar: PhantomData })
    }
}

/// Returns the steps of `lanes` lanes, one of [`LANES`], by the widest of these instructions with compiled steps. The
/// result is `None` where lanes are stepped one by one.
#[cfg(any(not(target_arch = "wasm32"), target_feature = "simd128"))]
pub(crate) fn lockstep(lanes: usize, instructions: Instructions) -> Option<Box<dyn Lockstep>> {
    fn boxed<S: Simd>(simd: S, lanes: usize) -> Box<dyn Lockstep> {
        if lanes == LANES[0] {
            Box::new(Vectors::<f32x8<S>> { simd, scalar: PhantomData })
        } else {
            Box::new(Vectors::<f32x16<S>> { simd, scalar: PhantomData })
        }
    }
    let level = instructions.level();
    if instructions == Instructions::Fallback || level.is_fallback() {
        return None;
    }
    #[cfg(any(target_arch = "x86", target_arch = "x86_64"))]
    {
        if let Some(simd) = level.as_avx512() {
            return Some(boxed(simd, lanes));
        }
        if let Some(simd) = level.as_avx2() {
            return Some(boxed(simd, lanes));
        }
        if let Some(simd) = level.as_sse2() {
            return Some(boxed(simd, lanes));
        }
    }
    Some(farsa_num::fearless_simd::dispatch!(level, simd => boxed(simd, lanes)))
}

/// WebAssembly for machines without vectors has none.
#[cfg(all(target_arch = "wasm32", not(target_feature = "simd128")))]
pub(crate) fn lockstep(_: usize, _: Instructions) -> Option<Box<dyn Lockstep>> {
    None
}
